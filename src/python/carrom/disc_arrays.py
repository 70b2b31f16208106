# SPDX-License-Identifier: BSD-3-Clause
"""The arrays of a frame: where all discs are at one step.

Arrays have one row a disc, in the order of ids 0 to N-1. Lengths are in the scene's unit, times
in steps, velocities in lengths per step, angles in radians. Arrays have the precision of the
file: float32 or float64.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from carrom.errors import NoDataError

Array = npt.NDArray[Any]
_ZEROS = np.zeros(2)
_ZEROS.setflags(write=False)


class DiscArrays(ABC):
    """All discs at one step, as numbers. `Frame` adds what other packages want of them.

    Attributes:
        step: the step, from 0
        radius: (N,) float64, lengths
        mass: (N,) float64, in the scene's unit; 1 unless the scene gives masses
        species: (N,) int64, from 0, in the order of ids
        box: (2,) float64, the box's edges along x and y, lengths
        corner: (2,) float64, the place of its lower left corner: (0, 0), unless the scene has
            `box.origin`
        periodic: whether the sides along x and along y are periodic
    """

    step: int
    box: Array
    corner: Array = _ZEROS
    periodic: tuple[bool, bool]

    @property
    def time(self) -> float:
        """Time in steps."""
        return float(self.step)

    @property
    @abstractmethod
    def n_discs(self) -> int:
        """N, the number of discs."""

    @cached_property
    @abstractmethod
    def x(self) -> Array:
        """Positions (N, 2), lengths; between periodic sides inside the box."""

    @property
    def x_from_corner(self) -> Array:
        """Positions (N, 2) from the lower left corner of the box, lengths."""
        return self.x - self.corner if self.corner.any() else self.x

    @cached_property
    @abstractmethod
    def v(self) -> Array:
        """Velocities (N, 2), lengths per step."""

    @cached_property
    @abstractmethod
    def spin(self) -> Array:
        """Angular velocities (N,) of rough discs, radians per step, counterclockwise."""

    @cached_property
    @abstractmethod
    def direction(self) -> Array:
        """Directions (N,) of active discs, radians from the x axis, counterclockwise."""

    @cached_property
    @abstractmethod
    def wall_collisions(self) -> Array:
        """Collisions with walls and obstacles since the scene's start, (N,) integers."""

    @cached_property
    @abstractmethod
    def pair_collisions(self) -> Array:
        """Collisions with other discs since the scene's start, (N,) integers."""

    @cached_property
    def psi6(self) -> Array:
        """Hexatic order (N,), complex, over Voronoi neighbours of the same weight."""
        raise NoDataError(
            "no psi6; frames of a trajectory have it if output.trajectory.fields "
            "names it; in a simulation of this process name it in "
            "output.measurements.quantities, and read sim.tables['psi6_history']"
        )

    @cached_property
    def neighbours(self) -> Array:
        """Numbers of Voronoi neighbours, (N,) integers."""
        raise NoDataError(
            "no neighbours; frames of a trajectory have them if output.trajectory.fields names them"
        )

    @cached_property
    def image(self) -> Array:
        """Box lengths (N, 2) flown through periodic sides; x + image * box goes on without end."""
        raise NoDataError("no image; trajectories of periodic boxes have it")

    @property
    @abstractmethod
    def radius(self) -> Array:
        """Radii (N,) float64, lengths."""

    @property
    @abstractmethod
    def mass(self) -> Array:
        """Masses (N,) float64."""

    @property
    @abstractmethod
    def species(self) -> Array:
        """Species (N,) int64, from 0."""

    @cached_property
    @abstractmethod
    def present(self) -> Array:
        """Whether each disc is in the box, (N,) bool: False once it has left by an open side."""

    @cached_property
    def speed(self) -> Array:
        """Speeds (N,), lengths per step."""
        return np.asarray(np.hypot(self.v[:, 0], self.v[:, 1]))

    @property
    def kinetic_energy(self) -> float:
        """Sum of m v^2 / 2 over the discs, without spins; in double precision."""
        v = self.v.astype(np.float64)
        return float(0.5 * np.sum(self.mass * np.sum(v * v, axis=1)))

    @property
    def packing(self) -> float:
        """Packing fraction: the area of the discs in the box over that of the box."""
        area = np.pi * np.sum(self.radius[self.present] ** 2)
        return float(area / np.prod(self.box))

    def ideal_pairs(self, edges: npt.ArrayLike) -> Array:
        """Return how many pairs of discs an ideal gas has in this box at distances between edges.

        Counts of pairs, each pair once, over these numbers are g(r), also between walls: there
        centres are drawn evenly from the box less one largest radius at each wall, as the table
        `"radial_distribution"` has it. Source: the covariogram of a rectangle.

        Args:
            edges: distances (n + 1,), from 0 to at most the shorter side (between periodic sides
                half of it)

        Returns:
            (n,) expected numbers of pairs
        """
        r = np.asarray(edges, dtype=np.float64)
        n = np.count_nonzero(self.present)
        is_wall = ~np.asarray(self.periodic)
        a, b = self.box - 2 * np.max(self.radius, initial=0) * is_wall
        if np.any(r < 0) or np.any(r > np.min(np.where(is_wall, (a, b), self.box / 2))):
            raise ValueError("edges reach from 0 to the shorter side, half of it if periodic")
        # The share of places at which both discs are inside falls with the distance.
        rim = b * is_wall[0] + a * is_wall[1]
        corners = float(all(is_wall))
        share = (np.pi * r**2 * a * b - 4 / 3 * rim * r**3 + corners * r**4 / 2) / (a * b) ** 2
        expected: Array = 0.5 * n * (n - 1) * np.diff(share)
        return expected

    def strips(self, ranks: int) -> Array:
        """Return the strip of each disc, (N,) int, when ranks own equally many discs along x."""
        order = np.argsort(self.x[:, 0], kind="stable")
        strip = np.empty(self.n_discs, dtype=int)
        strip[order] = np.arange(self.n_discs) * ranks // max(self.n_discs, 1)
        return strip

    def __len__(self) -> int:
        return self.n_discs

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of step {self.step}: {self.n_discs} discs>"
