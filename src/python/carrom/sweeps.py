# SPDX-License-Identifier: BSD-3-Clause
"""Sweeps: one scene at each point of a grid of keys, in one table."""

from __future__ import annotations

import itertools
import math
import os
import re
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn, Union

import numpy as np

from carrom import display, labelled
from carrom.errors import CarromError, FileError, NoDataError
from carrom.physics import average, compressibility
from carrom.plain import read_text
from carrom.runs import Run
from carrom.scene import (
    SCENE_FILES,
    SceneLike,
    flattened,
    is_text,
    merged,
    read_scene,
    toml_value,
    with_absolute_files,
)
from carrom.tables import Table

if TYPE_CHECKING:
    import pandas
    import xarray

Quantity = Callable[[Run], Union[float, tuple[float, float]]]

AVERAGES = (
    "collision_frequency",
    "mean_free_time",
    "wall_pressure",
    "virial_pressure",
    "mean_speed",
    "speed_kurtosis",
)
_PLAIN = re.compile(r"[A-Za-z0-9_.+-]{1,40}")
_LONGEST_NAME = 180  # file systems take 255 bytes
_DEFAULT_SEED = 3210
_NOT_COMPARED = ("output.folder", "time.steps")


class SweepError(CarromError):
    """Some points of a sweep failed; the others are done.

    Attributes:
        sweep: the sweep
    """

    def __init__(self, sweep: Sweep) -> None:
        """List what failed."""
        self.sweep = sweep
        reasons = [f"{point.name}: {error}" for point, error in sweep.failures]
        n = len(reasons)
        text = f"{n} of {len(sweep.points)} runs failed:\n" + "\n".join(reasons)
        super().__init__(text)

    def __reduce__(self) -> tuple[object, ...]:
        """Let the error cross process boundaries."""
        return type(self), (self.sweep,)


@dataclass(frozen=True)
class Point:
    """A run of a sweep.

    Attributes:
        values: what the grid's keys are here
        seed: `discs.seed` of a repeat; None where there are no repeats
        scene: the whole scene, or the path of legacy text
        overrides: what legacy text has set
        folder: the run's folder
    """

    values: dict[str, Any]
    seed: int | None
    scene: dict[str, Any] | Path
    overrides: dict[str, Any]
    folder: Path

    @property
    def name(self) -> str:
        """The last part of the folder's name."""
        return self.folder.name

    def run(self) -> Run | None:
        """Return the run if it is finished.

        Raises:
            FileError: the folder has a run of another scene, or a longer one
        """
        if not self.has_begun:
            return None
        run = Run(self.folder)
        self._check(run)
        if not run.has_report:
            return None
        if self.steps is None:
            return run if run.is_finished else None
        done = int(run.report["first_step"]) + int(run.report["steps"])
        if done > self.steps:
            self._refuse(f"of {done} steps")
        return run if done == self.steps else None

    @property
    def steps(self) -> int | None:
        """The last step; None where legacy text says it."""
        known = self.scene if isinstance(self.scene, dict) else merged({}, self.overrides)
        steps = flattened(known).get("time.steps")
        return None if steps is None else int(steps)

    @property
    def has_begun(self) -> bool:
        """Whether the folder has a run."""
        return any((self.folder / name).exists() for name in SCENE_FILES)

    def _check(self, run: Run) -> None:
        wanted = self.scene if isinstance(self.scene, dict) else merged({}, self.overrides)
        here, there = (_comparable(scene) for scene in (wanted, run.scene))
        different = sorted(key for key in here | there if here.get(key) != there.get(key))
        if isinstance(self.scene, Path) and not different:
            texts = [_without_remarks(path) for path in (self.scene, self.folder / "scene.in")]
            different = [str(self.scene)] if texts[0] != texts[1] else []
        if different:
            self._refuse(f"of another scene ({', '.join(different)})")

    def _refuse(self, what: str) -> NoReturn:
        raise FileError(f"{self.folder}: holds a run {what}; name another folder for the sweep")


def _comparable(scene: Mapping[str, Any]) -> dict[str, str]:
    flat = {key: toml_value(value) for key, value in flattened(scene).items()}
    return {key: value for key, value in flat.items() if key not in _NOT_COMPARED}


def _without_remarks(path: Path) -> list[str]:
    """Return lines of legacy text. A run's copy has remarks on top."""
    try:
        lines = read_text(path, errors="replace").splitlines()
    except OSError as error:
        raise FileError(f"{path}: cannot be read: {error}") from None
    return [line for line in lines if not line.startswith("#")]


@dataclass
class Sweep:
    """A grid of runs.

    Attributes:
        folder: it has a folder for each run
        keys: the grid's keys
        points: all runs, also those that are not there yet
        quantities: more columns of the table: functions of a run
        failures: points that failed in this call, with their errors
        job: the number of the Slurm job that was submitted; else None
    """

    folder: Path
    keys: tuple[str, ...]
    points: list[Point]
    quantities: Mapping[str, Quantity] = field(default_factory=dict)
    failures: list[tuple[Point, Exception]] = field(default_factory=list)
    job: str | None = None

    @property
    def runs(self) -> list[Run]:
        """The finished runs, in the order of the grid."""
        return [run for point in self.points if (run := point.run()) is not None]

    @property
    def missing(self) -> list[Point]:
        """The points whose runs are not finished."""
        return [point for point in self.points if point.run() is None]

    @property
    def table(self) -> Table:
        """One row for each point of the grid that has finished runs.

        Columns are the keys, `runs` (how many), then `NAME` and `NAME_error` for the averages of
        the report, `compressibility` (also as `Z`), `packing`, `wall_seconds`, and the quantities.
        An error is one standard error: over the repeats where there are several, else that of the
        report. A number that a scene does not have is nan.
        """
        rows: list[dict[str, Any]] = []
        for values, points in itertools.groupby(self.points, key=lambda point: point.values):
            runs = [run for point in points if (run := point.run()) is not None]
            if runs:
                rows.append(values | {"runs": len(runs)} | self._averages(runs))
        names = [*self.keys, "runs", *self._columns()]
        columns = {name: _column([row[name] for row in rows]) for name in names}
        return Table.from_columns(columns)

    def to_pandas(self) -> pandas.DataFrame:
        """Return the table as a pandas DataFrame."""
        return self.table.to_pandas()

    def to_xarray(self) -> xarray.Dataset:
        """Return the table as an xarray Dataset whose dimensions are the grid's keys.

        Points without a finished run are nan.
        """
        values = {key: list(dict.fromkeys(p.values[key] for p in self.points)) for key in self.keys}
        return labelled.grid_to_xarray(self.table, values)

    def _repr_html_(self) -> str:
        title = repr(self).strip("<>")
        shown = [
            *self.keys,
            "runs",
            "collision_frequency",
            "compressibility",
            "compressibility_error",
        ]
        return display.rows(title, shown, self.table[shown].tolist())

    def _functions(self) -> dict[str, Quantity]:
        functions: dict[str, Quantity] = {name: _averager(name) for name in AVERAGES}
        functions |= {"Z": compressibility, "compressibility": compressibility}
        functions |= {"packing": _reporter("packing")}
        functions |= {"wall_seconds": _reporter("wall_seconds")}
        return functions | dict(self.quantities)

    def _columns(self) -> list[str]:
        return [name for key in self._functions() for name in (key, f"{key}_error")]

    def _averages(self, runs: Sequence[Run]) -> dict[str, float]:
        row = {}
        for name, function in self._functions().items():
            row[name], row[f"{name}_error"] = _average([_evaluated(function, run) for run in runs])
        return row

    def __repr__(self) -> str:
        n = len(self.points)
        done = f"{n - len(self.missing)} of {n} done"
        return f"<Sweep of {', '.join(self.keys)} in {self.folder}: {done}>"


def _averager(name: str) -> Quantity:
    return lambda run: average(run, name)


def _reporter(name: str) -> Quantity:
    return lambda run: float(run.report[name])


def _evaluated(function: Quantity, run: Run) -> tuple[float, float]:
    try:
        result = function(run)
    except NoDataError:
        return math.nan, math.nan
    return result if isinstance(result, tuple) else (float(result), math.nan)


def _average(pairs: Sequence[tuple[float, float]]) -> tuple[float, float]:
    if len(pairs) == 1:
        return pairs[0]
    values = np.array([value for value, _ in pairs])
    return float(values.mean()), float(values.std(ddof=1) / math.sqrt(len(values)))


def _column(values: list[Any]) -> Any:
    if all(isinstance(value, (bool, int, float, np.generic)) for value in values):
        return np.array(values)
    words = [value if isinstance(value, str) else toml_value(value) for value in values]
    return np.array(words, dtype=np.str_)


def grid_points(
    scene: SceneLike,
    grid: Mapping[str, Iterable[Any]],
    folder: Path,
    repeats: int,
    overrides: Mapping[str, Any],
) -> Iterator[Point]:
    """Give all points of a grid, repeats of a point after each other."""
    keys = _grid_values(grid, overrides)
    if repeats < 1:
        raise ValueError(f"repeats must be at least 1, not {repeats}")
    if repeats > 1 and "discs.seed" in keys:
        raise ValueError("repeats choose seeds: discs.seed cannot be in the grid too")
    is_legacy = _is_legacy(scene)
    beside = Path() if isinstance(scene, Mapping) or is_text(scene) else Path(scene).parent
    base = {} if is_legacy else with_absolute_files(read_scene(scene), beside)
    for combination in itertools.product(*keys.values()):
        values = dict(zip(keys, combination))
        all_set = flattened(overrides) | values
        known = flattened(base) | all_set
        first = int(known.get("discs.seed", _DEFAULT_SEED)) if repeats > 1 else 0
        for number in range(repeats):
            seed = first + number if repeats > 1 else None
            chosen = all_set if seed is None else all_set | {"discs.seed": seed}
            name = ",".join(f"{key}={_word(value)}" for key, value in values.items())
            if len(name) > _LONGEST_NAME:
                name = f"{name[:_LONGEST_NAME]}-{zlib.crc32(name.encode()):08x}"
            name += "" if seed is None else f",seed={seed}"
            if isinstance(scene, Mapping) or not is_legacy:
                yield Point(values, seed, merged(base, chosen), {}, folder / name)
            else:
                yield Point(values, seed, Path(scene), dict(chosen), folder / name)


def _grid_values(
    grid: Mapping[str, Iterable[Any]], overrides: Mapping[str, Any]
) -> dict[str, list[Any]]:
    """Return the grid by the program's keys, with numbers of Python.

    Raises:
        TypeError: a key has one value instead of several
        ValueError: a key has no values, or the same twice, or is set elsewhere too
    """
    keys: dict[str, list[Any]] = {}
    if "output.folder" in flattened(overrides) or "output.folder" in flattened(grid):
        raise ValueError(
            "a sweep cannot set output.folder: each of its runs has a folder of its own in `folder`"
        )
    for name, values in grid.items():
        key = str(name).replace("__", ".")
        if isinstance(values, (str, Mapping)) or not isinstance(values, Iterable):
            raise TypeError(f"a sweep needs several values of {key}: [{values!r}], not {values!r}")
        if key in keys or key in flattened(overrides):
            raise ValueError(f"{key} is given twice: once in the grid is enough")
        keys[key] = [_plain(key, value) for value in values]
        twice = [value for i, value in enumerate(keys[key]) if value in keys[key][:i]]
        if twice:
            raise ValueError(f"{key} has the value {twice[0]!r} twice; repeats=2 runs two seeds")
    empty = [key for key, values in keys.items() if not values]
    if not keys or empty:
        raise ValueError(f"a sweep needs values for each key: {', '.join(empty) or 'no key'}")
    return keys


def _plain(key: str, value: Any) -> Any:
    try:
        toml_value(value)
    except TypeError as error:
        raise TypeError(f"{key}: {error}") from None
    return value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value


def _is_legacy(scene: SceneLike) -> bool:
    """Whether a scene is the path of legacy text."""
    if isinstance(scene, Mapping) or is_text(scene):
        return False
    return not os.fspath(scene).endswith(".toml")


def _word(value: Any) -> str:
    """Write a value for the name of a folder."""
    text = value if isinstance(value, str) else toml_value(value)
    return text if _PLAIN.fullmatch(text) else f"{zlib.crc32(text.encode()):08x}"
