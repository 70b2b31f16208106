# SPDX-License-Identifier: BSD-3-Clause
"""Energy, pressure and collision rate along a run, from what it has written so far.

Where a run has no table of pressures, or counts no collisions, its trajectory has other numbers:
temperature, mean speed, and how many discs are in the box. They take the place.
"""

from __future__ import annotations

import contextlib
import re
import time
from typing import Any

import numpy as np

from carrom import h5
from carrom.errors import CarromError, FileError
from carrom.frame import Frame
from carrom.frames import Frames
from carrom.runs import Checkpoints, Run

_POINTS = 300
_ROWS_AT_A_TIME = 1 << 20

_STEP = re.compile(r"checkpoint-([0-9]+)\.h5")

Curve = dict[str, Any]


_ENERGY = "Kinetic energy, mass length²/step²"
_PRESSURE = "Pressure, mass/step²"
_RATE = "Collisions per disc and step"
_TEMPERATURE = "Temperature kT, mass length²/step²"
_SPEED = "Mean speed, length/step"
_INSIDE = "Discs in the box"


def _curve(steps: Any, values: Any, source: str, title: str) -> Curve:
    return {
        "steps": [float(step) for step in steps],
        "values": [float(value) for value in values],
        "source": source,
        "title": title,
    }


def steps_of(frames: Frames | Checkpoints) -> list[int]:
    """Return the steps of frames, without opening checkpoints that say it in their names."""
    if isinstance(frames, Frames):
        return [int(step) for step in frames.steps]
    found = [_STEP.fullmatch(path.name) for path in frames.paths]
    return [int(match[1]) if match else frames[i].step for i, match in enumerate(found)]


def _coarse_first(places: range, newest: int) -> list[int]:
    """Put the newest first, then places far apart, so that few of them already span the run."""
    found = dict.fromkeys([newest] if places else [])
    every = 1 << len(places).bit_length()
    while every:
        found.update(dict.fromkeys(places[::every]))
        every //= 2
    return list(found)


class Curves:
    """Keeps what has been read, and reads on a little each time."""

    def __init__(self) -> None:
        """Know nothing yet."""
        self.clear()

    def clear(self) -> None:
        """Forget a run: another one has begun in its place."""
        self._of_frames: dict[int, dict[str, float]] = {}
        self._log_path: Any = None
        self._log_rows = 0
        self._log_counts: dict[int, int] = {}

    def read(
        self, run: Run, frames: Frames | Checkpoints, n_discs: int, seconds: float
    ) -> dict[str, Curve]:
        """Return the curves as far as they are known, after so much more reading."""
        begin = time.monotonic()
        self._read_log(run, begin + seconds / 2)
        self._read_frames(frames, begin + seconds)
        return {
            "energy": self._energy(),
            "pressure": self._pressure(run),
            "rate": self._rate(run, n_discs),
        }

    def _read_frames(self, frames: Frames | Checkpoints, until: float) -> None:
        """Energy and counters of some frames: the newest, then others, ever more closely spaced."""
        steps = steps_of(frames)
        if isinstance(frames, Frames):  # older checkpoints are removed, but their values stay
            last = steps[-1] if steps else -1
            self._of_frames = {s: v for s, v in self._of_frames.items() if s <= last}
        every = max(1, -(-len(steps) // _POINTS))
        for index in _coarse_first(range(0, len(steps), every), len(steps) - 1):
            if steps[index] in self._of_frames:
                continue
            self._of_frames[steps[index]] = _sums(frames[index])
            if index != len(steps) - 1 and time.monotonic() > until:
                return  # at least one, else a slow reader would only have the newest

    def _energy(self) -> Curve:
        return self._column("energy", _ENERGY) or _curve(
            (), (), "no frames with velocities yet", _ENERGY
        )

    def _column(self, name: str, title: str) -> Curve | None:
        """Return one number of all frames that have it."""
        known = sorted((step, sums[name]) for step, sums in self._of_frames.items() if name in sums)
        if not known:
            return None
        steps, values = zip(*known)
        return _curve(steps, values, "from frames", title)

    def _read_log(self, run: Run, until: float) -> None:
        """Counts of pairs by step, from where the last reading ended."""
        path = None if run.folder is None else run.folder / "collisions.h5"
        if path is None or not path.exists():
            return
        with h5.open_file(path) as file:
            if "carrom/collisions" not in file:
                raise FileError(f"{path}: is no log of collisions")
            columns = file["carrom/collisions"]
            rows = len(columns["step"])
            if rows < self._log_rows or path != self._log_path:  # cut back by a restart
                self._log_rows, self._log_counts, self._log_path = 0, {}, path
            while self._log_rows < rows and time.monotonic() < until:
                part = slice(self._log_rows, min(rows, self._log_rows + _ROWS_AT_A_TIME))
                is_pair = h5.read(columns["q"], part) >= 0
                steps, places = np.unique(h5.read(columns["step"], part), return_inverse=True)
                pairs = np.bincount(places, weights=is_pair)
                for step, count in zip(steps, pairs):
                    known = self._log_counts.get(int(step), 0)
                    self._log_counts[int(step)] = known + int(count)
                self._log_rows = part.stop

    def _rate(self, run: Run, n_discs: int) -> Curve:
        """Collisions with others per disc and step."""
        if self._log_counts and n_discs:
            last = max(self._log_counts)
            counts = np.zeros(last)
            for step, count in self._log_counts.items():
                counts[step - 1] = count
            width = max(1, 2 * last // _POINTS)
            whole = last // width * width
            rates = counts[:whole].reshape(-1, width).mean(axis=1) * 2 / n_discs
            middles = (np.arange(len(rates)) + 0.5) * width
            return _curve(middles, rates, "the log of collisions", _RATE)
        counted = self._column("collisions", _RATE)
        if counted is not None and len(counted["steps"]) > 1:
            steps, means = np.array(counted["steps"]), np.array(counted["values"])
            rates = np.diff(means) / np.diff(steps)
            middles = (steps[1:] + steps[:-1]) / 2
            return _curve(middles, rates, "counters of frames or checkpoints", _RATE)
        return (
            _of_report(run, "collision_frequency", _RATE)
            or self._column("speed", _SPEED)
            or self._column("inside", _INSIDE)
            or _curve(
                (),
                (),
                "needs output.collisions, or frames or checkpoints with counters of collisions",
                _RATE,
            )
        )

    def _pressure(self, run: Run) -> Curve:
        try:
            table = run.tables["wall_pressure_history"]
        except CarromError:
            table = None
        if table is not None and len(table):
            sides = np.stack([table[side] for side in ("left", "right", "bottom", "top")])
            is_wall = ~np.isnan(sides).all(axis=1)
            steps = (table["from_step"] + table["to_step"]) / 2
            return _curve(steps, sides[is_wall].mean(axis=0), "mean over the walls", _PRESSURE)
        return (
            _of_report(run, "virial_pressure", _PRESSURE)
            or self._column("temperature", _TEMPERATURE)
            or self._column("inside", _INSIDE)
            or _curve(
                (), (), 'needs "wall_pressure" among output.measurements.quantities', _PRESSURE
            )
        )


def _of_report(run: Run, name: str, title: str) -> Curve | None:
    """The report's average as a level line, once the run has ended."""
    averages = run.report.get("averages", {}) if run.has_report else {}
    value = (averages.get(name) or {}).get("value")
    if value is None:
        return None
    begin = averages["from_step"]
    span = (begin, begin + averages["over_steps"])
    return _curve(span, (value, value), "the report's average", title)


def _sums(frame: Frame) -> dict[str, float]:
    """Return the sums and means of a frame that its fields allow."""
    inside = frame.present
    sums = {"inside": float(np.count_nonzero(inside))}
    try:
        v, mass = frame.v[inside].astype(np.float64), frame.mass[inside]
    except CarromError:
        v = mass = np.empty(0)
    if len(v):
        sums["energy"] = frame.kinetic_energy
        sums["speed"] = float(np.mean(np.hypot(v[:, 0], v[:, 1])))
        drift = np.average(v, axis=0, weights=mass)
        squares = np.sum((v - drift) ** 2, axis=1)
        sums["temperature"] = float(np.sum(mass * squares) / (2 * len(v)))
    with contextlib.suppress(CarromError):
        sums["collisions"] = float(np.mean(frame.pair_collisions))
    return sums
