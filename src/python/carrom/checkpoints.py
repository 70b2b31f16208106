# SPDX-License-Identifier: BSD-3-Clause
"""Checkpoints: a frame in full precision, with what a run needs to go on."""

from __future__ import annotations

import os
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from carrom import h5
from carrom.disc_arrays import Array
from carrom.errors import FileError, NoDataError
from carrom.frame import Frame
from carrom.scene import parsed

_DEPARTED = -1.0  # the own time of a disc that has left through an open side


class Checkpoint(Frame):
    """The state of a run at one step. Arrays are float64, bit for bit the program's numbers.

    Attributes:
        path: the file
        method: "event-driven" or "time-stepped"
        micro_steps: micro-steps of a step
        state_hash: 32 hexadecimal digits over the state of all discs
        program_version: of the program that wrote it
        scene_text: the scene, as it was given
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        """Read what a checkpoint says of its run. Its arrays are read when asked for."""
        self.path = Path(path)
        with h5.open_file(self.path) as file:
            if "carrom/run" not in file:
                raise FileError(f"{path}: is no checkpoint of carrom")
            try:
                self._read_header(file)
            except (LookupError, TypeError, ValueError, AttributeError) as error:
                raise FileError(f"{path}: is no checkpoint of carrom ({error})") from None

    def _read_header(self, file: Any) -> None:
        run = file["carrom/run"]
        self.step = int(run["step"][()])
        self.micro_steps = int(run["micro_steps"][()])
        self._n_discs = int(run["n_discs"][()])
        self._largest_radius = float(run["radius"][()])
        for name in ("method", "state_hash", "program_version", "scene_name", "scene_text"):
            setattr(self, name, h5.text(file, f"carrom/run/{name}"))
        self._overrides = h5.text(file, "carrom/run/scene_overrides")
        discs = file["particles/discs"]
        self.box = np.asarray(discs["box/edges/value"][0, :2], dtype=np.float64)
        if "parameters/origin" in file:
            self.corner = 0 - np.asarray(file["parameters/origin"][()], dtype=np.float64)
        boundary = [bytes(word) for word in discs["box"].attrs["boundary"]]
        self.periodic = (boundary[0] == b"periodic", boundary[1] == b"periodic")
        names = ("x", "y", "vx", "vy", "slowing", "clock")
        self._frame = {
            name: float(run[f"frame_{name}"][()]) for name in names if f"frame_{name}" in run
        }
        periods = ("period_x", "period_y")
        self._periods = [float(run[name][()]) if name in run else 0.0 for name in periods]
        done, sync = int(run["micro_steps_done"][()]), int(run["sync_every"][()])
        self._clock = self._frame.get("clock", float(done % sync))

    method: str
    state_hash: str
    program_version: str
    scene_name: str
    scene_text: str

    @property
    def n_discs(self) -> int:
        return self._n_discs

    @property
    def scene(self) -> dict[str, Any]:
        """The scene with what the command line set; of legacy text only the latter."""
        return parsed(self.scene_text, self.scene_name, self._overrides.splitlines())

    def column(self, name: str) -> Array:
        """Return a column of /carrom/discs as it is stored; see docs/reference/formats.md."""
        with h5.open_file(self.path) as file:
            if f"carrom/discs/{name}" not in file:
                raise NoDataError(f"{self.path}: discs have no {name}")
            values: Array = h5.read(file[f"carrom/discs/{name}"])
            return values

    @cached_property
    def _flight(self) -> Array:
        """Micro-steps from each disc's own time to the checkpoint's."""
        return np.asarray(self._clock - self.column("tau"))

    @cached_property
    def present(self) -> Array:
        return np.asarray(self.column("tau") != _DEPARTED)

    @cached_property
    def x(self) -> Array:
        places = [self._place(axis, period) for axis, period in zip("xy", self._periods)]
        return np.stack(places, axis=1) + self.corner

    def _place(self, axis: str, period: float) -> Array:
        stored = self.column(axis)
        place = stored + self.column(f"v{axis}") * self._flight
        if self._frame:
            place = wrapped(place + self._frame[axis], period)
        return np.where(self.present, place, stored) + 0.0

    @cached_property
    def v(self) -> Array:
        return np.stack([self._velocity("x"), self._velocity("y")], axis=1)

    def _velocity(self, axis: str) -> Array:
        velocity = self.column(f"v{axis}")
        if self._frame:
            moving = velocity * self._frame["slowing"] + self._frame[f"v{axis}"]
            velocity = np.where(self.present, moving, velocity)
        return np.asarray(velocity * float(self.micro_steps) + 0.0)

    @cached_property
    def spin(self) -> Array:
        return np.asarray(self.column("spin") * float(self.micro_steps) + 0.0)

    @cached_property
    def direction(self) -> Array:
        return self.column("direction")

    @cached_property
    def wall_collisions(self) -> Array:
        return self.column("wall_collisions")

    @cached_property
    def pair_collisions(self) -> Array:
        return self.column("pair_collisions")

    @cached_property
    def radius(self) -> Array:
        try:  # radii that discs have exchanged
            return self.column("swapped_radius")
        except NoDataError:
            return self._species_columns[0]

    @property
    def mass(self) -> Array:
        return self._species_columns[1]

    @property
    def species(self) -> Array:
        return self._species_columns[2]

    @cached_property
    def _species_columns(self) -> tuple[Array, Array, Array]:
        """Radius, mass and species of each disc: of the file, else of the scene it holds."""
        n = self.n_discs
        rows = self._stored_species() or self._scene_species()
        if not rows and (columns := self._tabled_species()):
            return columns
        if not rows:
            return np.full(n, self._largest_radius), np.ones(n), np.zeros(n, dtype=np.int64)
        counts, radii, masses = (np.array(column) for column in zip(*rows))
        return (
            np.repeat(radii.astype(float), counts),
            np.repeat(masses.astype(float), counts),
            np.repeat(_numbered(rows), counts),
        )

    def _stored_species(self) -> list[tuple[int, float, float]]:
        with h5.open_file(self.path) as file:
            if "carrom/species" not in file:
                return []
            columns = [file[f"carrom/species/{name}"][()] for name in ("count", "radius", "mass")]
        return [(int(n), float(r), float(m)) for n, r, m in zip(*columns)]

    def _tabled_species(self) -> tuple[Array, Array, Array] | None:
        """Columns of discs whose radii follow a distribution, whose species are not in order."""
        with h5.open_file(self.path) as file:
            if "particles/discs/species" not in file or "parameters/species" not in file:
                return None
            species = file["particles/discs/species"][()].astype(np.int64)
            radii, masses = (file[f"parameters/species/{name}"][()] for name in ("radius", "mass"))
        return radii[species], masses[species], species

    def _scene_species(self) -> list[tuple[int, float, float]]:
        discs = self.scene.get("discs", {})
        if species := discs.get("species", discs.get("classes")):
            return [(int(s["count"]), float(s["radius"]), float(s.get("mass", 1))) for s in species]
        rows = discs.get("list", [])
        return [(1, float(row[4]), float(row[5])) for row in rows] if rows and rows[0][5:] else []


def _numbered(rows: list[tuple[int, float, float]]) -> Array:
    """Number species in the order of ids; neighbours that are alike are one."""
    numbers = [0]
    for before, now in zip(rows, rows[1:]):
        numbers.append(numbers[-1] + (before[1:] != now[1:]))
    return np.array(numbers, dtype=np.int64)


def wrapped(place: Array, period: float) -> Array:
    """Bring places into [0, period), with the program's roundings; unchanged without a period."""
    if period == 0:
        return place
    images = np.floor(place / period)
    inside = place - images * period
    for i in np.flatnonzero(np.abs(images) > 1):  # rounds once, as the program does
        inside[i] = float(Fraction(place[i]) - Fraction(images[i]) * Fraction(period))
    inside = np.where(inside < 0, inside + period, inside)
    inside = np.where(inside < period, inside, inside - period)
    return np.where((place >= 0) & (place < period), place, inside)
