# SPDX-License-Identifier: BSD-3-Clause
"""A run: the folder that the program writes, or one file of it, as Python objects."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Union, overload

import h5py
import numpy as np

from carrom import display, h5
from carrom.checking import check as check_file
from carrom.checkpoints import Checkpoint
from carrom.errors import FileError, NoDataError
from carrom.frames import Frames
from carrom.launching import go_on
from carrom.plain import open_plain, read_text
from carrom.scene import SCENE_FILES, flattened, parsed, read_scene
from carrom.tables import Table, Tables

_COLLISIONS = "carrom/collisions"
_IN_REPORTS = {"first_step", "steps", "state_hash"}


class Run:
    """A run, also while it goes on: each access sees what the program has written by then.

    Attributes:
        folder: the run's folder; None for a single file
        log: lines that the program printed, where this process started it
    """

    def __init__(
        self,
        folder: str | os.PathLike[str] | None,
        *,
        trajectory: str | os.PathLike[str] | None = None,
        collisions: str | os.PathLike[str] | None = None,
        checkpoint: str | os.PathLike[str] | None = None,
        check: bool = False,
    ) -> None:
        """Inspect a folder, or one file. `carrom.open` finds out which it is.

        With `check` the checksums of each file are compared when it is first read.
        """
        self.folder = None if folder is None else Path(folder)
        self.log: list[str] = []
        self._files = {"trajectory": trajectory, "collisions": collisions}
        self._checkpoint = checkpoint
        self._frames: tuple[object, Frames] | None = None
        self._checked: set[Path] | None = set() if check else None

    @property
    def name(self) -> str:
        """The folder or file, for messages."""
        files = (self.folder, *self._files.values(), self._checkpoint)
        return str(next(file for file in files if file is not None))

    def _file(self, kind: str) -> Path | None:
        """Return the path of a recording, if it is there."""
        path = self.folder / f"{kind}.h5" if self.folder is not None else self._files[kind]
        if path is None or not Path(path).exists():
            return None
        check_once(Path(path), self._checked)
        return Path(path)

    @property
    def scene(self) -> dict[str, Any]:
        """The scene, with what the command line set. Legacy text has no keys: {}."""
        if self.folder is None:
            return self._scene_of_file()
        for name in SCENE_FILES:
            if (self.folder / name).exists():
                return read_scene(self.folder / name)
        raise NoDataError(f"{self.name}: has no scene.toml")

    def _scene_of_file(self) -> dict[str, Any]:
        if self._checkpoint is not None:
            return self.checkpoints[0].scene
        path = self._file("trajectory") or self._file("collisions")
        with h5.open_file(path or "") as file:
            if "carrom/scene" not in file:
                raise NoDataError(f"{self.name}: holds no scene; open the run's folder")
            words = [h5.text(file, f"carrom/scene/scene_{part}") for part in ("text", "name")]
            overrides = h5.text(file, "carrom/scene/scene_overrides").splitlines()
        return parsed(words[0], words[1], overrides)

    @property
    def report(self) -> dict[str, Any]:
        """The numbers of the summary; docs/reference/report.md lists the keys.

        Raises:
            NoDataError: the run has not come to an end yet, or only a file was opened
        """
        path = None if self.folder is None else self.folder / "report.json"
        if path is None or not path.exists():
            raise NoDataError(
                f"{self.name}: has no report.json: the program writes it at the end of a run"
            )
        try:
            report: Any = json.loads(read_text(path))
        except (OSError, ValueError) as error:
            raise FileError(f"{path}: cannot be read: {error}") from None
        except RecursionError:
            raise FileError(f"{path}: is no report of carrom: it is nested too deeply") from None
        if not isinstance(report, dict) or not report.keys() >= _IN_REPORTS:
            raise FileError(f"{path}: is no report of carrom")
        return report

    @property
    def has_report(self) -> bool:
        """Whether the program has written a report, at its end or when it was told to stop."""
        return self.folder is not None and (self.folder / "report.json").exists()

    @property
    def is_finished(self) -> bool:
        """Whether the run has come to the scene's last step."""
        if not self.has_report:
            return False
        report = self.report
        done = int(report["first_step"]) + int(report["steps"])
        wanted = flattened(self.scene).get("time.steps")
        return wanted is None or done >= int(wanted)

    @property
    def state_hash(self) -> str:
        """The hash over all states at the last step: of the report, else the newest checkpoint."""
        if self.has_report:
            return str(self.report["state_hash"])
        if len(self.checkpoints) == 0:
            raise NoDataError(f"{self.name}: has neither a report nor a checkpoint yet")
        return self.checkpoints[-1].state_hash

    @property
    def tables(self) -> Tables:
        """What `[output.measurements]` asked for, by name. `carrom.Table` has `to_pandas`."""
        return Tables(None if self.folder is None else self.folder / "measurements", self.name)

    @property
    def thermo(self) -> Table:
        """The usual quantities over time, so far: the table of the quantity `"thermo"`."""
        return self.tables["thermo"]

    @property
    def frames(self) -> Frames:
        """The frames of the trajectory so far; without one, none. See `carrom.Frames`."""
        path = self._file("trajectory")
        if path is None:
            return Frames(None, self.name)
        stat = path.stat()
        key = (path, stat.st_ino, stat.st_mtime_ns, stat.st_size)
        if self._frames is None or self._frames[0] != key:
            self._frames = (key, Frames(path, self.name))
        return self._frames[1]

    @property
    def checkpoints(self) -> Checkpoints:
        """The checkpoints that are there, oldest first. The program keeps the newest few."""
        if self._checkpoint is not None:
            return Checkpoints([Path(self._checkpoint)], self.name, self._checked)
        folder = None if self.folder is None else self.folder / "checkpoints"
        paths = [] if folder is None else sorted(folder.glob("checkpoint-*.h5"))
        return Checkpoints(paths, self.name, self._checked)

    @property
    def collisions(self) -> Table:
        """Every collision, in order: columns `step`, `time`, `p`, `q`, `impulse`.

        `step` counts from 1, `time` is in steps from the start. `p` and `q` are ids; q = -1 is a
        wall. `impulse` is its magnitude, mass times length per step.
        """
        return self.collisions_between()

    def collisions_between(self, first: int | None = None, last: int | None = None) -> Table:
        """Return the collisions of the steps from `first` to `last`, both included."""
        path = self._file("collisions")
        if path is None:
            raise NoDataError(f"{self.name}: has no collisions; the scene needs output.collisions")
        with h5.open_file(path) as file:
            if _COLLISIONS not in file:
                raise FileError(f"{path}: is no log of collisions")
            columns = file[_COLLISIONS]
            steps = h5.read(columns["step"])
            begin = 0 if first is None else int(np.searchsorted(steps, first))
            end = len(steps) if last is None else int(np.searchsorted(steps, last, side="right"))
            names = ("step", "time", "p", "q", "impulse")
            read = {name: h5.read(columns[name], slice(begin, max(begin, end))) for name in names}
        return Table.from_columns(read)

    @property
    def lines(self) -> dict[int, np.ndarray[Any, np.dtype[np.float64]]]:
        """Lines of discs, if `output.text` asked for them: {step: (N, 4) of x, y, vx, vy}."""
        path = None if self.folder is None else self.folder / "lines.txt"
        if path is None or not path.exists():
            raise NoDataError(f"{self.name}: has no lines; the scene needs output.text")
        return read_lines(path)

    def resume(self, steps: int | None = None, **options: Any) -> Run:
        """Go on from the newest whole checkpoint. See `carrom.resume`."""
        if self.folder is None:
            raise NoDataError(f"{self.name}: is one file; only a folder can be gone on with")
        return finished(self.folder, go_on(self.folder, steps=steps, **options))

    def close(self) -> None:
        """Close the trajectory. The next access to `frames` opens it again."""
        if self._frames is not None:
            self._frames[1].close()
            self._frames = None

    def __enter__(self) -> Run:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _repr_html_(self) -> str:
        report = self.report if self.has_report else {}
        z = report.get("compressibility") or {}
        facts = {
            "state": "finished" if self.is_finished else "not finished",
            "steps": int(report["first_step"]) + int(report["steps"]) if report else None,
            "discs": report.get("discs"),
            "packing": report.get("packing"),
            "Z = P A / (N kT)": _with_error(z) if z.get("value") is not None else None,
            "state hash": report.get("state_hash"),
            "frames": len(self.frames) or None,
            "checkpoints": len(self.checkpoints) or None,
            "tables": ", ".join(self.tables) or None,
        }
        return display.facts(f"run {self.name}", facts)

    def __repr__(self) -> str:
        state = "finished" if self.is_finished else "not finished"
        return f"<Run {self.name}, {state}>" if self.folder else f"<Run of the file {self.name}>"


def finished(folder: str | os.PathLike[str], log: list[str]) -> Run:
    """Return the run of a folder, with what the program has printed."""
    run = Run(folder)
    run.log = log
    return run


def _with_error(entry: Mapping[str, Any]) -> str:
    error = entry["error"]
    return f"{entry['value']:.6g}" + ("" if error is None else f" +- {error:.1g}")


class Checkpoints(Sequence[Checkpoint]):
    """The checkpoints of a run, oldest first."""

    def __init__(self, paths: Sequence[Path], owner: str, checked: set[Path] | None = None) -> None:
        """Stand for files, which are opened when asked for, and checked if they are to be."""
        self.paths = list(paths)
        self._owner = owner
        self._checked = checked

    def __len__(self) -> int:
        return len(self.paths)

    @overload
    def __getitem__(self, index: int) -> Checkpoint: ...
    @overload
    def __getitem__(self, index: slice) -> Checkpoints: ...
    # Completion in editors understands Union, but not `A | B`.
    def __getitem__(self, index: int | slice) -> Union[Checkpoint, Checkpoints]:  # noqa: UP007
        """Return a checkpoint, or those of a slice."""
        if isinstance(index, slice):
            return Checkpoints(self.paths[index], self._owner, self._checked)
        if not self.paths:
            raise IndexError(f"{self._owner}: has no checkpoints")
        check_once(self.paths[index], self._checked)
        return Checkpoint(self.paths[index])

    def __iter__(self) -> Iterator[Checkpoint]:
        return (self[place] for place in range(len(self)))

    def _repr_html_(self) -> str:
        steps = {path.name: f"step {Checkpoint(path).step}" for path in self.paths}
        return display.facts(f"checkpoints of {self._owner}", steps)

    def __repr__(self) -> str:
        return f"<{len(self)} checkpoints of {self._owner}>"


def read_lines(
    path: str | os.PathLike[str],
) -> dict[int, np.ndarray[Any, np.dtype[np.float64]]]:
    """Read lines `step id x y vx vy`: {step: (N, 4) of x, y, vx, vy}, to the bit."""
    frames: dict[int, list[list[float]]] = {}
    try:
        with open_plain(path, "r", encoding="ascii") as lines:
            for line in lines:
                words = line.split()
                step, disc = int(words[0]), int(words[1])
                if disc == 0:  # after a restart a step may be listed again
                    frames[step] = []
                frames[step].append([float(word) for word in words[2:6]])
        return {step: np.array(rows).reshape(-1, 4) for step, rows in frames.items()}
    except (OSError, ValueError, LookupError) as error:
        raise FileError(f"{path}: are no lines of discs: {error}") from None


_SIGNS_OF_A_RUN = (*SCENE_FILES, "report.json", "checkpoints", "trajectory.h5")


def check_once(path: Path, checked: set[Path] | None) -> None:
    """Compare the checksums of a file unless that has been done, or is not wanted (None)."""
    if checked is None or path in checked:
        return
    check_file(path)
    checked.add(path)


def open_run(path: str | os.PathLike[str], *, check: bool = True) -> Run:
    """Open a run's folder, a trajectory, a checkpoint or a log of collisions; also of a run
    that goes on.

    Args:
        path: the folder or the file
        check: compare the checksums of each file when it is first read, by `carrom verify`. That
            reads the whole file once. A recording that grows is not checked again.

    Raises:
        FileError: it is not there, or nothing that the program writes
    """
    path = Path(path)
    if path.is_dir():
        if not any((path / name).exists() for name in _SIGNS_OF_A_RUN):
            raise FileError(
                f"{path}: is no run of carrom: has none of {', '.join(_SIGNS_OF_A_RUN)}"
            )
        return Run(path, check=check)
    checked: set[Path] | None = set() if check else None
    check_once(path, checked)
    with h5.open_file(path) as file:
        kind = _kind(file)
    if kind is None:
        raise FileError(f"{path}: holds nothing that carrom writes")
    files: dict[str, Any] = {kind: path}
    run = Run(None, **files)
    run._checked = checked
    if kind == "trajectory":
        run.frames.steps  # noqa: B018 - says now whether it can be read
    return run


def _kind(file: h5py.File) -> str | None:
    if "carrom/run" in file:
        return "checkpoint"
    if _COLLISIONS in file:
        return "collisions"
    return "trajectory" if "particles/discs/box/edges" in file else None
