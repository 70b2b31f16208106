# SPDX-License-Identifier: BSD-3-Clause
"""Running the points of a sweep, here or by Slurm."""

from __future__ import annotations

import concurrent.futures
import operator
import os
import threading
from collections.abc import Iterable, Iterator, Mapping, Sequence
from concurrent.futures import Future
from pathlib import Path
from typing import Any

from carrom.errors import CarromError, InputError
from carrom.process import process_watch
from carrom.program import find_launcher, find_program
from carrom.progress import progress_display
from carrom.running import resume, run
from carrom.scene import SceneLike
from carrom.slurm import submit
from carrom.sweeps import Point, Quantity, Sweep, SweepError, grid_points

_TAKEN = "another run is writing there"  # as the program prints it
_SECONDS_BETWEEN_LOOKS = 0.5


def sweep(
    scene: SceneLike,
    grid: Mapping[str, Iterable[Any]],
    workers: int | None = None,
    folder: str | os.PathLike[str] = "sweep",
    *,
    repeats: int = 1,
    ranks: int = 1,
    threads: int = 1,
    slurm: bool | Mapping[str, Any] = False,
    quantities: Mapping[str, Quantity] | None = None,
    progress: bool | None = None,
    program: str | os.PathLike[str] | None = None,
    launcher: str | os.PathLike[str] | None = None,
    **overrides: Any,
) -> Sweep:
    """Run a scene at each point of a grid, and return the sweep when all is done.

    A call goes on where an earlier one ended: finished runs stay, unfinished ones go on from their
    newest checkpoint. A larger grid in the same folder runs what is new.

    Args:
        scene: see `carrom.run`
        grid: values for each key, for example `{"discs.packing": [0.1, 0.2]}`
        workers: runs at a time; as many as the cores allow if None
        folder: has a folder for each run
        repeats: runs at each point, with seeds that follow each other; errors are then over these
        ranks: MPI ranks of a run
        threads: threads of a rank
        slurm: submit an array job for what is missing and return at once. A dictionary has options
            of sbatch, for example `{"time": "02:00:00", "partition": "long"}`
        quantities: more columns of the table: a function of a run that returns a number, or a
            number and its standard error
        progress: True or False; None shows progress on terminals and in notebooks
        program: see `carrom.find_program`
        launcher: the MPI launcher of runs on several ranks
        **overrides: keys of the scene, as for `carrom.run`

    Raises:
        SweepError: some runs failed; the others are done, and `sweep` of the error has them
        FileError: the folder has runs of another scene
        ValueError: a grid without values, with the same value twice, or with a key that is set too
    """
    for name, count in (("ranks", ranks), ("threads", threads), ("workers", workers)):
        if count is not None and operator.index(count) < 1:
            raise ValueError(f"{name} must be at least 1, not {count}")
    place = Path(folder)
    points = list(grid_points(scene, grid, place, repeats, overrides))
    keys = tuple(points[0].values)
    result = Sweep(place, keys, points, quantities or {})
    missing = result.missing
    found = find_program(program)
    found_launcher = find_launcher(launcher) if ranks > 1 else ""
    if isinstance(slurm, Mapping) or slurm:
        options = slurm if isinstance(slurm, Mapping) else {}
        if missing:
            result.job = submit(place, missing, found, found_launcher, ranks, threads, options)
        return result
    cores = len(os.sched_getaffinity(0))
    n_workers = workers or max(1, cores // (ranks * threads))
    jobs = {"ranks": ranks, "threads": threads, "program": found, "launcher": launcher}
    _run_all(result, missing, n_workers, jobs, progress)
    if result.failures:
        raise SweepError(result)
    return result


def _run_all(
    sweep: Sweep, points: Sequence[Point], workers: int, jobs: dict[str, Any], progress: bool | None
) -> None:
    """Run points side by side. Ctrl-C lets all runs store a checkpoint."""
    stop = threading.Event()
    with (
        progress_display(progress) as show,
        concurrent.futures.ThreadPoolExecutor(workers) as pool,
    ):
        futures = {pool.submit(_run_point, point, jobs, stop): point for point in points}
        try:
            for done, future in enumerate(_completed(futures), 1):
                if (error := future.exception()) is not None:
                    if not isinstance(error, CarromError):
                        raise error
                    sweep.failures.append((futures[future], error))
                show(f"{done} of {len(points)} runs done, {len(sweep.failures)} failed")
        except BaseException:
            stop.set()
            pool.shutdown(wait=True, cancel_futures=True)
            raise


def _completed(futures: Iterable[Future[None]]) -> Iterator[Future[None]]:
    """Give futures as they complete. Waits are short, so that interrupts come through."""
    waiting = set(futures)
    while waiting:
        done, waiting = concurrent.futures.wait(
            waiting, timeout=0.2, return_when=concurrent.futures.FIRST_COMPLETED
        )
        yield from done


def _run_point(point: Point, jobs: dict[str, Any], stop: threading.Event) -> None:
    """Run a point, or wait for another sweep that runs it in the same folder."""
    with process_watch(stop):
        while point.run() is None:
            had_begun = point.has_begun
            try:
                _run_once(point, jobs)
            except InputError as error:
                is_taken = _TAKEN in str(error) or point.has_begun != had_begun
                if not is_taken or stop.wait(_SECONDS_BETWEEN_LOOKS):
                    raise
            else:
                return


def _run_once(point: Point, jobs: dict[str, Any]) -> None:
    if isinstance(point.scene, Path):
        options = ["--resume"] if point.has_begun else []
        words = jobs | {"options": options, "progress": False}
        run(point.scene, folder=point.folder, **words, **point.overrides)
    elif point.has_begun:
        resume(point.folder, steps=point.steps, progress=False, **jobs)
    else:
        run(point.scene, folder=point.folder, progress=False, **jobs)
