# SPDX-License-Identifier: BSD-3-Clause
"""A frame: where all discs are at one step.

Arrays have one row a disc, in the order of ids 0 to N-1. Lengths are in the scene's unit, times
in steps, velocities in lengths per step, angles in radians. Arrays have the precision of the
file: float32 or float64.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from carrom import display, labelled
from carrom.errors import NoDataError

if TYPE_CHECKING:
    import ase
    import freud
    import pandas
    import xarray
    from MDAnalysis import Universe
    from ovito.data import DataCollection

Array = npt.NDArray[Any]


class Frame(ABC):
    """All discs at one step.

    Attributes:
        step: the step, from 0
        radius: (N,) float64, lengths
        mass: (N,) float64, in the scene's unit; 1 unless the scene gives masses
        species: (N,) int64, from 0, in the order of ids
        box: (2,) float64, the box's edges along x and y, lengths; its corner is the origin
        periodic: whether the sides along x and along y are periodic
    """

    step: int
    box: Array
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
    def wall_collisions(self) -> Array:
        """Collisions with walls and obstacles since the scene's start, (N,) integers."""

    @cached_property
    @abstractmethod
    def pair_collisions(self) -> Array:
        """Collisions with other discs since the scene's start, (N,) integers."""

    @cached_property
    def psi6(self) -> Array:
        """Hexatic order (N,), complex, over Voronoi neighbours of the same weight."""
        raise NoDataError("no psi6; output.trajectory.fields of the scene asks for it")

    @cached_property
    def neighbours(self) -> Array:
        """Numbers of Voronoi neighbours, (N,) integers."""
        raise NoDataError("no neighbours; output.trajectory.fields of the scene asks for them")

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

    def strips(self, ranks: int) -> Array:
        """Return the strip of each disc, (N,) int, when ranks own equally many discs along x."""
        order = np.argsort(self.x[:, 0], kind="stable")
        strip = np.empty(self.n_discs, dtype=int)
        strip[order] = np.arange(self.n_discs) * ranks // max(self.n_discs, 1)
        return strip

    def to_pandas(self) -> pandas.DataFrame:
        """Return a pandas DataFrame with a row for each disc: `x`, `y`, `vx`, `vy`, `radius` ...

        It has what the frame has; `attrs` has `step` and `box`.
        """
        return labelled.frame_to_pandas(self)

    def to_xarray(self) -> xarray.Dataset:
        """Return an xarray Dataset with the dimensions `disc` and `axis`.

        Variables are `position`, `velocity`, `radius`, `mass` and what else the frame has.
        """
        return labelled.frame_to_xarray(self)

    def to_freud(self) -> tuple[freud.box.Box, npt.NDArray[np.float32]]:
        """Return (box, points) for freud's `compute`. Its boxes are centred on the origin.

        Points (n, 3) are those of discs in the box. freud finds neighbours in periodic boxes alone.
        So between walls its box is twice as long: no disc has neighbours across a wall. Numbers
        that freud divides by the area of the box are then too small by that.
        """
        from carrom import adapters

        result: tuple[freud.box.Box, npt.NDArray[np.float32]] = adapters.to_freud(self)
        return result

    def to_mdanalysis(self) -> Universe:
        """Return an MDAnalysis Universe of one frame. See `Frames.to_mdanalysis`."""
        from carrom import adapters

        universe: Universe = adapters.to_mdanalysis([self])
        return universe

    def to_ase(self) -> ase.Atoms:
        """Return ASE Atoms in a cell of height 1. Numbers stay in the scene's units.

        Symbols are X. `arrays` has `radius` and `species`, `info` has `step` and `time`.
        `get_velocities` has velocities in lengths per step, so `get_kinetic_energy` is that of the
        frame. `get_temperature` counts three directions and takes eV, so it is of no use here.
        """
        from carrom import adapters

        atoms: ase.Atoms = adapters.to_ase(self)
        return atoms

    def to_ovito(self) -> DataCollection:
        """Return an OVITO DataCollection: a 2D cell, discs to scale, species as types."""
        from carrom import adapters

        data: DataCollection = adapters.to_ovito(self)
        return data

    def _repr_html_(self) -> str:
        facts = {
            "discs": self.n_discs,
            "box": " x ".join(f"{edge:.9g}" for edge in self.box.tolist()),
            "packing": f"{self.packing:.6g}" if _has(self, "x") else None,
            "kinetic energy": f"{self.kinetic_energy:.9g}" if _has(self, "v") else None,
        }
        return display.facts(f"frame of step {self.step}", facts) + display.picture(self)

    def __len__(self) -> int:
        return self.n_discs

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of step {self.step}: {self.n_discs} discs>"


def _has(frame: Frame, name: str) -> bool:
    try:
        getattr(frame, name)
    except NoDataError:
        return False
    return True
