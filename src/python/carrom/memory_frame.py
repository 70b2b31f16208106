# SPDX-License-Identifier: BSD-3-Clause
"""A frame of arrays in memory."""

from __future__ import annotations

import contextlib
from functools import cached_property
from typing import NamedTuple, Protocol

import numpy as np

from carrom.disc_arrays import Array
from carrom.errors import SceneError
from carrom.frame import Frame


class _Source(Protocol):
    """What a frame takes of a simulation, whose module stands above this one."""

    corner: Array
    periodic: tuple[bool, bool]
    masses: Array
    species: Array

    @property
    def radii(self) -> Array: ...
    @property
    def box(self) -> Array: ...
    @property
    def step(self) -> int: ...
    @property
    def positions(self) -> Array: ...
    @property
    def velocities(self) -> Array: ...
    @property
    def spins(self) -> Array: ...
    @property
    def directions(self) -> Array: ...
    @property
    def wall_collisions(self) -> Array: ...
    @property
    def pair_collisions(self) -> Array: ...
    @property
    def images(self) -> Array: ...


class LocalDiscs(NamedTuple):
    """The discs of one rank, in ascending order of ids."""

    ids: Array
    """(n,)"""
    positions: Array
    """(n, 2), lengths"""
    velocities: Array
    """(n, 2), lengths per step"""
    spins: Array
    """(n,), radians per step"""


class MemoryFrame(Frame):
    """The discs of a simulation at one step, in float64. Later steps do not change it."""

    def __init__(self, sim: _Source) -> None:
        """Copy all arrays of a simulation. On several ranks all make the call."""
        self.step = sim.step
        self.box, self.corner, self.periodic = sim.box, sim.corner, sim.periodic
        self._radius, self._mass, self._species = sim.radii, sim.masses, sim.species
        self.x, self.v, self.spin = sim.positions, sim.velocities, sim.spins
        self.direction = sim.directions
        self.wall_collisions, self.pair_collisions = sim.wall_collisions, sim.pair_collisions
        with contextlib.suppress(SceneError):  # between sheared sides there are no images
            self.image = sim.images

    @property
    def n_discs(self) -> int:
        return len(self._radius)

    @property
    def radius(self) -> Array:
        return self._radius

    @property
    def mass(self) -> Array:
        return self._mass

    @property
    def species(self) -> Array:
        return self._species

    x: Array
    v: Array
    spin: Array
    direction: Array
    image: Array
    wall_collisions: Array
    pair_collisions: Array

    @cached_property
    def present(self) -> Array:
        """Discs that have left by an open side rest one radius outside of the box."""
        x = self.x_from_corner
        outside = np.any((x < 0) | (x > self.box), axis=1)
        present: Array = ~(outside & ~self.v.any(axis=1))
        return present
