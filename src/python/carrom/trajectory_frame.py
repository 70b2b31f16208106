# SPDX-License-Identifier: BSD-3-Clause
"""One frame of a trajectory, and what all of its frames share."""

from __future__ import annotations

from functools import cached_property
from typing import Any, Protocol

import numpy as np

from carrom.disc_arrays import Array
from carrom.errors import FileError
from carrom.frame import Frame


class System:
    """What a trajectory says of its discs once and for all."""

    def __init__(self, file: Any) -> None:
        """Read it from an open file."""
        discs = file["particles/discs"]
        self.n_discs = _number_of_discs(discs, file)
        boundary = [
            word.decode() if isinstance(word, bytes) else str(word)
            for word in discs["box"].attrs["boundary"]
        ]
        self.periodic = (boundary[0] == "periodic", boundary[1] == "periodic")
        sides = file["parameters/open_sides"][()] if "parameters/open_sides" in file else [0] * 4
        self.origin = file["parameters/origin"][()] if "parameters/origin" in file else np.zeros(2)
        self.corner = 0 - self.origin
        self.open_sides = tuple(bool(side) for side in sides)
        shape = (self.n_discs,)
        radius = discs["radius"][()] if "radius" in discs else file["parameters/radius"][()]
        self.radius = np.broadcast_to(np.asarray(radius, dtype=np.float64), shape)
        mass = discs["mass"][()] if "mass" in discs else 1.0
        self.mass = np.broadcast_to(np.asarray(mass, dtype=np.float64), shape)
        species = discs["species"][()] if "species" in discs else 0
        self.species = np.broadcast_to(np.asarray(species, dtype=np.int64), shape)


def _number_of_discs(discs: Any, file: Any) -> int:
    names = ("position", "velocity", "image", "collisions", "angular_velocity", "psi6")
    for name in (*names, "neighbours", "direction"):
        if name in discs:
            return int(discs[name]["value"].shape[1])
    raise FileError(f"{file.filename}: its frames have no fields")


class Trajectory(Protocol):
    """What a frame needs of the trajectory that it belongs to; `Frames` has it."""

    all_steps: Array
    all_boxes: Array
    system: System

    def has(self, name: str) -> bool: ...
    def field(self, name: str, index: int) -> Array: ...


class TrajectoryFrame(Frame):
    """A frame of a trajectory. Arrays are read when they are first asked for."""

    def __init__(self, frames: Trajectory, index: int) -> None:
        """Stand for the frame at a place in the file."""
        self._frames = frames
        self._index = index
        self.step = int(frames.all_steps[index])
        self.box = np.asarray(frames.all_boxes[index, :2], dtype=np.float64)
        self.corner = frames.system.corner
        self.periodic = frames.system.periodic

    @property
    def n_discs(self) -> int:
        return self._frames.system.n_discs

    @cached_property
    def radius(self) -> Array:
        if self._frames.has("swapped_radius"):
            return self._frames.field("swapped_radius", self._index)
        return self._frames.system.radius

    @property
    def mass(self) -> Array:
        return self._frames.system.mass

    @property
    def species(self) -> Array:
        return self._frames.system.species

    @cached_property
    def x(self) -> Array:
        stored = self._frames.field("position", self._index)[:, :2]
        origin = self._frames.system.origin
        return (stored - origin).astype(stored.dtype) if origin.any() else stored

    @cached_property
    def v(self) -> Array:
        return self._frames.field("velocity", self._index)[:, :2]

    @cached_property
    def spin(self) -> Array:
        return self._frames.field("angular_velocity", self._index)

    @cached_property
    def direction(self) -> Array:
        return self._frames.field("direction", self._index)

    @cached_property
    def image(self) -> Array:
        return self._frames.field("image", self._index)[:, :2]

    @cached_property
    def wall_collisions(self) -> Array:
        return self._frames.field("collisions", self._index)[:, 0]

    @cached_property
    def pair_collisions(self) -> Array:
        return self._frames.field("collisions", self._index)[:, 1]

    @cached_property
    def psi6(self) -> Array:
        values = self._frames.field("psi6", self._index)
        order: Array = values[:, 0] + 1j * values[:, 1]
        return order

    @cached_property
    def neighbours(self) -> Array:
        return self._frames.field("neighbours", self._index)

    @cached_property
    def present(self) -> Array:
        """Discs rest where they left: a radius beyond the line. One still leaving moves."""
        left, right, bottom, top = self._frames.system.open_sides
        outside = np.zeros(self.n_discs, dtype=bool)
        x = self.x_from_corner
        for axis, low, high in ((0, left, right), (1, bottom, top)):
            if low:
                outside |= x[:, axis] < 0
            if high:
                outside |= x[:, axis] > self.box[axis]
        if outside.any() and self._frames.has("velocity"):
            outside &= ~self.v.any(axis=1)
        return ~outside
