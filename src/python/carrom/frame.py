# SPDX-License-Identifier: BSD-3-Clause
"""A frame: the arrays of all discs at one step, and what other packages and notebooks get of them.

The arrays stand in `DiscArrays`, so that adapters and pictures need not import this module.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from carrom import adapters, display, labelled
from carrom.disc_arrays import DiscArrays
from carrom.errors import NoDataError

if TYPE_CHECKING:
    import ase
    import freud
    import pandas
    import xarray
    from MDAnalysis import Universe
    from ovito.data import DataCollection


class Frame(DiscArrays):
    """All discs at one step. See `DiscArrays` for its attributes."""

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

    def to_freud(
        self, *, walls: str | None = None
    ) -> tuple[freud.box.Box, npt.NDArray[np.float32]]:
        """Return (box, points) for freud's `compute`. Its boxes are centred on the origin.

        Points (n, 3) are those of discs in the box. freud finds neighbours in periodic boxes alone.

        Args:
            walls: "apart" makes the box twice as long between walls, so that no disc has
                neighbours across one. What freud divides by the area of the box is then wrong:
                divide its counts of pairs by `ideal_pairs` for g(r).

        Raises:
            ValueError: the box has walls, and `walls` is None
        """
        result: tuple[freud.box.Box, npt.NDArray[np.float32]] = adapters.to_freud(self, walls)
        return result

    def to_mdanalysis(self, *, walls: str | None = None) -> Universe:
        """Return an MDAnalysis Universe of one frame. See `Frames.to_mdanalysis`."""
        universe: Universe = adapters.to_mdanalysis([self], walls=walls)
        return universe

    def to_ase(self) -> ase.Atoms:
        """Return ASE Atoms in a cell of height 1. Numbers stay in the scene's units.

        Symbols are X. `arrays` has `radius` and `species`, `info` has `step` and `time`.
        `get_velocities` has velocities in lengths per step, so `get_kinetic_energy` is that of the
        frame. `get_temperature` counts three directions and takes eV, so it is of no use here.
        """
        atoms: ase.Atoms = adapters.to_ase(self)
        return atoms

    def to_ovito(self) -> DataCollection:
        """Return an OVITO DataCollection: a 2D cell, discs to scale, species as types."""
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


def _has(frame: DiscArrays, name: str) -> bool:
    try:
        getattr(frame, name)
    except NoDataError:
        return False
    return True
