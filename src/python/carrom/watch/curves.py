# SPDX-License-Identifier: BSD-3-Clause
"""Energy, pressure and collision rate along a run, from what it has written so far."""

from __future__ import annotations

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


def _curve(steps: Any, values: Any, source: str) -> Curve:
    return {
        "steps": [float(step) for step in steps],
        "values": [float(value) for value in values],
        "source": source,
    }


def steps_of(frames: Frames | Checkpoints) -> list[int]:
    """Return the steps of frames, without opening checkpoints that say it in their names."""
    if isinstance(frames, Frames):
        return [int(step) for step in frames.steps]
    found = [_STEP.fullmatch(path.name) for path in frames.paths]
    return [int(match[1]) if match else frames[i].step for i, match in enumerate(found)]


class Curves:
    """Keeps what has been read, and reads on a little at each look."""

    def __init__(self) -> None:
        """Know nothing yet."""
        self.clear()

    def clear(self) -> None:
        """Forget a run: another one has begun in its place."""
        self._of_frames: dict[int, tuple[float, float | None]] = {}
        self._log_path: Any = None
        self._log_rows = 0
        self._log_counts: dict[int, int] = {}

    def look(
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
        """Energy and counters of some frames, evenly spaced, the newest among them."""
        steps = steps_of(frames)
        if isinstance(frames, Frames):  # older checkpoints are removed, but what they said stays
            last = steps[-1] if steps else -1
            self._of_frames = {s: v for s, v in self._of_frames.items() if s <= last}
        every = max(1, -(-len(steps) // _POINTS))
        for index in {*range(0, len(steps), every), len(steps) - 1} if steps else set():
            if steps[index] in self._of_frames:
                continue
            self._of_frames[steps[index]] = _sums(frames[index])
            if time.monotonic() > until:
                return

    def _energy(self) -> Curve:
        known = sorted((step, e) for step, (e, _) in self._of_frames.items() if e == e)
        if not known:
            return _curve((), (), "no frames with velocities yet")
        steps, energies = zip(*known)
        return _curve(steps, energies, "kinetic energy of frames")

    def _read_log(self, run: Run, until: float) -> None:
        """Counts of pairs by step, from where the last look ended."""
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
            return _curve(middles, rates, "the log of collisions")
        known = sorted((s, n) for s, (_, n) in self._of_frames.items() if n is not None)
        if len(known) < 2:
            return _of_report(run, "collision_frequency") or _curve(
                (),
                (),
                "needs output.collisions, or frames or checkpoints with counters of collisions",
            )
        steps, means = (np.array(column) for column in zip(*known))
        rates = np.diff(means) / np.diff(steps)
        return _curve((steps[1:] + steps[:-1]) / 2, rates, "counters of frames or checkpoints")

    def _pressure(self, run: Run) -> Curve:
        try:
            table = run.tables["wall_pressure_history"]
        except CarromError:
            table = None
        if table is not None and len(table):
            sides = np.stack([table[side] for side in ("left", "right", "bottom", "top")])
            is_wall = ~np.isnan(sides).all(axis=1)
            steps = (table["from_step"] + table["to_step"]) / 2
            return _curve(steps, sides[is_wall].mean(axis=0), "mean over the walls")
        return _of_report(run, "virial_pressure") or _curve(
            (), (), 'needs "wall_pressure" among output.measurements.quantities'
        )


def _of_report(run: Run, name: str) -> Curve | None:
    """The report's average as a level line, once the run has ended."""
    averages = run.report.get("averages", {}) if run.has_report else {}
    value = (averages.get(name) or {}).get("value")
    if value is None:
        return None
    begin = averages["from_step"]
    return _curve((begin, begin + averages["over_steps"]), (value, value), "the report's average")


def _sums(frame: Frame) -> tuple[float, float | None]:
    """Return the kinetic energy (nan without velocities), and collisions a disc."""
    try:
        energy = frame.kinetic_energy
    except CarromError:
        energy = float("nan")
    try:
        return energy, float(np.mean(frame.pair_collisions))
    except CarromError:
        return energy, None
