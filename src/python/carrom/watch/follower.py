# SPDX-License-Identifier: BSD-3-Clause
"""One run as the page sees it: its state, its frames, its curves.

A follower opens files when they have changed, to read. Runs take no HDF5 locks, so they never wait
for it. It measures the processor's time that reading takes, and asks the page to ask again so late
that they take less than a hundredth of one core.
"""

from __future__ import annotations

import hashlib
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from carrom.errors import CarromError, FileError, NoDataError
from carrom.frames import Frames
from carrom.plain import read_bytes
from carrom.runs import Checkpoints, Run, open_run
from carrom.scene import SCENE_FILES, flattened
from carrom.watch.colour_scale import ColourScale
from carrom.watch.curves import Curves, steps_of
from carrom.watch.field import NewestField
from carrom.watch.picture import MOST_DISCS, View, picture
from carrom.watch.progress import Rate, is_being_written, legacy_steps
from carrom.watch.walls import walls_at

_SHARE = 0.01  # share of one core
_LEAST_PAUSE = 1.0
_LONGEST_PAUSE = 120.0


class Follower:
    """Reads a run for the page. Threads may call it at once."""

    def __init__(self, path: Path, *, may_wait: bool = False) -> None:
        """Follow a folder, or one file.

        Raises:
            FileError: there is nothing, or nothing of a run; an empty folder is a run to come
        """
        self.path = Path(path)
        self._run: Run | None = None
        self._lock = threading.Lock()
        self._curves = Curves()
        self._field = NewestField()
        self._scale = ColourScale()
        self._rate = Rate()
        self._identity = ""
        self._scene: dict[str, Any] = {}
        self._spent = 0.0
        if not self.path.exists() and not may_wait:
            raise FileError(f"{path}: there is no such folder; --wait waits for it")
        is_empty = self.path.is_dir() and not any(
            child for child in self.path.iterdir() if not child.name.startswith(".")
        )
        if self.path.exists() and not is_empty and not may_wait:
            open_run(self.path, check=False)

    def state(self, n_known: int, last_known: int) -> dict[str, Any]:
        """Say how far the run is, with the steps of frames that the page does not know yet.

        The page knows the first `n_known` frames, of which the last is of step `last_known`.
        """
        with self._measured():
            return self._state(n_known, last_known)

    @contextmanager
    def _measured(self, *, is_counted: bool = True) -> Iterator[None]:
        """Keep other threads out, and measure the processor's time."""
        with self._lock:
            begin = time.thread_time()
            try:
                yield
            finally:
                if is_counted:
                    self._spent += time.thread_time() - begin

    def _state(self, n_known: int, last_known: int) -> dict[str, Any]:
        self._find_run()
        spent, self._spent = self._spent, 0.0
        pause = spent / _SHARE if self._is_running() else _LEAST_PAUSE
        answer: dict[str, Any] = {
            "name": self.path.resolve().name,
            "pause": min(max(_LEAST_PAUSE, pause), _LONGEST_PAUSE),
            "run": self._identity,
        }
        if self._run is None:
            return answer | {
                "status": "waiting",
                "message": "No run has begun here yet. This page will show it.",
                "first": 0,
                "steps": [],
            }
        frames, is_trajectory = self._frames()
        steps = steps_of(frames)
        is_known = 0 < n_known <= len(steps) and steps[n_known - 1] == last_known
        first = n_known if is_known else 0
        answer |= {"first": first, "steps": steps[first:]}
        return answer | self._progress(steps, is_trajectory)

    def _find_run(self) -> None:
        """Open the run once it is there; notice when another has begun in its place."""
        identity = self._identity_now()
        if identity == self._identity and self._run is not None:
            return
        self._identity, self._run, self._rate = identity, None, Rate()
        self._curves.clear()
        self._field.clear()
        self._scale.clear()
        try:
            # The page shows a run at once, and asks again each second.
            self._run = open_run(self.path, check=False)
            self._scene = _scene_of(self._run)
        except FileError:
            if self.path.exists() and not self.path.is_dir():
                raise

    def _begun_run(self) -> Run:
        self._find_run()
        if self._run is None:
            raise NoDataError("no run has begun here yet")
        return self._run

    def _identity_now(self) -> str:
        """Text that changes with the scene. A run that is gone on with may write the same again."""
        for name in SCENE_FILES:
            try:
                return hashlib.sha256(read_bytes(self.path / name)).hexdigest()[:16]
            except OSError:
                continue
        return "file" if self.path.is_file() else ""

    def _frames(self) -> tuple[Frames | Checkpoints, bool]:
        """Return frames of the trajectory; without one, the checkpoints that are kept."""
        assert self._run is not None
        frames = self._run.frames
        if len(frames) or frames.path is not None:
            return frames, True
        return self._run.checkpoints, False

    def _progress(self, steps: list[int], is_trajectory: bool) -> dict[str, Any]:
        run = self._run
        assert run is not None
        wanted = self._wanted_steps()
        step = max([*steps[-1:], *steps_of(run.checkpoints)], default=0)
        is_running = self._is_running()
        status = "running" if is_running else "stopped"
        if run.folder is None:
            status = "file"
        elif not is_running and run.has_report:
            report = run.report
            step = max(step, int(report["first_step"]) + int(report["steps"]))
            if run.is_finished:
                status = "finished"
        self._rate.note(step, time.monotonic())
        rate = self._rate.steps_per_second() if is_running else None
        left = (wanted - step) / rate if rate and wanted else None
        return {
            "status": status,
            "step": step,
            "wanted": wanted,
            "steps_per_second": rate,
            "seconds_left": left,
            "is_trajectory": is_trajectory,
            "message": _message(status, steps, is_trajectory, step, self.path),
        }

    def _is_running(self) -> bool:
        folder = self._run.folder if self._run is not None else None
        return folder is not None and is_being_written(folder)

    def _wanted_steps(self) -> int | None:
        run = self._run
        assert run is not None
        try:
            steps = flattened(run.scene).get("time.steps")
        except CarromError:
            return None
        if steps is None and run.folder is not None:
            return legacy_steps(run.folder / "scene.in")
        return None if steps is None else int(steps)

    def curves(self) -> dict[str, Any]:
        """Return the curves as far as they have been read; see `Curves`."""
        with self._measured():
            run = self._begun_run()
            frames, _ = self._frames()
            n_discs = frames[-1].n_discs if len(frames) else 0
            seconds = 0.05 if self._is_running() else 0.5
            return self._curves.read(run, frames, n_discs, seconds)

    def field(self, name: str) -> dict[str, Any]:
        """Return a field of the newest block of profiles; see `NewestField`."""
        with self._measured():
            return self._field.read(self._begun_run(), name)

    def frame(
        self, step: int, colour: str, view: View | None, follows: bool
    ) -> tuple[dict[str, Any], bytes]:
        """Return the picture of a step. What a reader plays back is not counted as following."""
        with self._measured(is_counted=follows):
            self._begun_run()
            frames, _ = self._frames()
            steps = steps_of(frames)
            if step not in steps:
                raise NoDataError(f"there is no frame of step {step} (any more)")
            frame = frames[steps.index(step)]
            walls = walls_at(self._scene, frame.box, step, frame.corner)
            about, numbers = picture(frame, colour, view, MOST_DISCS, walls)
            if about["colour"] == "speed":
                about["top"] = self._scale.top(frames)
            return about, numbers


def _scene_of(run: Run) -> dict[str, Any]:
    """Return the scene; {} where a file holds none, or one that cannot be read."""
    try:
        return run.scene
    except CarromError:
        return {}


def _message(status: str, steps: list[int], is_trajectory: bool, step: int, path: Path) -> str:
    """Say what the reader should know or do."""
    if status == "stopped":
        return (
            f"No process is writing this run. It stands at step {step}. "
            f"Go on with: carrom run -o {path} --resume"
        )
    if not steps:
        return "There are no frames yet. The first comes when the trajectory is first read."
    if not is_trajectory:
        return (
            "There is no trajectory: these are the newest checkpoints. "
            "output.trajectory.every_steps of a scene asks for frames."
        )
    return ""
