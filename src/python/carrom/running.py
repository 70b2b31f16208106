# SPDX-License-Identifier: BSD-3-Clause
"""Starting the program: `run` and `resume`."""

from __future__ import annotations

import inspect
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from carrom.errors import InputError
from carrom.launching import (
    ProgressLike,
    common_options,
    execute,
    go_on,
    place_of,
    prepared,
    set_options,
)
from carrom.progress import show_end
from carrom.runs import Run, finished
from carrom.scene import SceneLike, flattened, scene_file
from carrom.words import with_arguments


def run(
    scene: SceneLike,
    ranks: int = 1,
    threads: int | None = None,
    folder: str | os.PathLike[str] | None = None,
    *,
    steps: int | None = None,
    overwrite: bool = False,
    check: bool = False,
    gpu: bool = False,
    accuracy: float | None = None,
    progress: ProgressLike = None,
    program: str | os.PathLike[str] | None = None,
    launcher: str | os.PathLike[str] | None = None,
    options: Sequence[str] = (),
    **overrides: Any,
) -> Run:
    """Run a scene and return it when it is done.

    Args:
        scene: a dictionary, the path of a file, or TOML text (a string with a line break)
        ranks: MPI ranks; more than 1 start through the MPI launcher
        threads: threads of each rank; the program's choice if None
        folder: where all that the run writes goes. None: `output.folder` of the scene, else a
            new folder in the system's place for temporary files, which is kept
        steps: steps to run, instead of the scene's
        overwrite: remove a run that is in the folder; without it such a run is an error
        check: check all invariants after each step
        gpu: step the discs on a GPU; the bits are the same
        accuracy: choose the fastest method with at most this relative error
        progress: True or False; None shows progress on terminals and in notebooks. Or a
            function that is called about five times a second and at the end, with the step and
            the last step; if it takes a third argument, with the line of the program, too, which
            has the speed and the time that is left
        program: the program; see `carrom.find_program`
        launcher: the MPI launcher; else CARROM_MPIEXEC, mpiexec or mpirun
        options: more words for `carrom run`, for example `["--rebalance-every", "4"]`
        **overrides: keys of the scene: `time={"steps": 5}`, `time__steps=5` or
            `**{"time.steps": 5}`

    Raises:
        InputError: the scene or an option is wrong; the message has the program's lines
        StoppedError: the run was told to stop and has stored a checkpoint
        CollectiveError, OutputError, InvariantError, ProgramError: as their names say
        ProgramNotFoundError: the program or the launcher is not there, or cannot be started
        TypeError: a scene or an argument is of the wrong kind, or TOML has no such value (None)
        ValueError: ranks is below 1
    """
    place, is_new = place_of(folder, scene, overrides)
    with (
        prepared(place, is_new, overwrite) as lines,
        scene_file(scene, overrides, place) as file,
    ):
        words = [str(file.path), *set_options(file.overrides)]
        words += ["--overwrite"] if overwrite else []
        words += ["--gpu"] if gpu else []
        words += ["--accuracy", repr(float(accuracy))] if accuracy is not None else []
        words += common_options(threads, steps, check, options)
        try:
            log = execute(place, words, lines, ranks, program, launcher, progress)
        except InputError as error:
            names = inspect.signature(run).parameters
            error.put_in_words(lambda line: with_arguments(line, flattened(overrides), names))
            if file.text is not None and sys.version_info >= (3, 11):
                numbered = enumerate(file.text.splitlines(), 1)
                text = "\n".join(f"{n:4} {line}" for n, line in numbered)
                error.add_note(f"{file.path}:\n{text}")
            raise
    return _ended(place, log, progress)


def resume(
    folder: str | os.PathLike[str],
    ranks: int = 1,
    threads: int | None = None,
    *,
    steps: int | None = None,
    check: bool = False,
    progress: ProgressLike = None,
    program: str | os.PathLike[str] | None = None,
    launcher: str | os.PathLike[str] | None = None,
    options: Sequence[str] = (),
    **overrides: Any,
) -> Run:
    """Go on with the run of a folder, from its newest whole checkpoint, to its last step.

    `steps` names another last step. The bits are those of a run that was never stopped, on any
    number of ranks and threads. Arguments and errors are those of `carrom.run`.
    """
    log = go_on(
        folder,
        ranks,
        threads,
        steps=steps,
        check=check,
        progress=progress,
        program=program,
        launcher=launcher,
        options=options,
        **overrides,
    )
    return _ended(Path(folder), log, progress)


def _ended(folder: Path, log: list[str], progress: ProgressLike) -> Run:
    result = finished(folder, log)
    if callable(progress) and result.has_report:
        show_end(progress, int(result.report["first_step"]) + int(result.report["steps"]))
    return result
