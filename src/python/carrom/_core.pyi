# SPDX-License-Identifier: BSD-3-Clause
"""The library in this process. `carrom.Simulation` is what users call.

"Collective": all ranks of the simulation's communicator make the call.
"""

from collections.abc import Callable, Sequence
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

thread: int
"""The thread that loaded the extension; set by `carrom.core_module`."""

def make_errors_by(maker: Callable[[list[str], int], Exception]) -> None:
    """Take the function (lines, exit code) that makes exceptions."""

def end_session(is_forked: bool) -> None:
    """End MPI with the last simulation; a forked process leaves it to its parent."""

def mpi_library() -> str:
    """Return name and version of the MPI library."""

def new(
    text: str, is_file: bool, settings: Sequence[str], threads: int, communicator: int | None
) -> Core:
    """Begin with a scene, TOML text or the path of a file, and settings KEY=VALUE on top.

    0 threads: the usual number. Collective.
    """

def from_checkpoint(
    path: str, settings: Sequence[str], threads: int, communicator: int | None
) -> Core:
    """Go on from a checkpoint's file or folder. Collective."""

@final
class Core:
    """A simulation. Arrays are new ones, in the order of ids."""

    @property
    def step(self) -> int:
        """Steps since the scene's start."""

    @property
    def rank(self) -> int:
        """This rank's number."""

    @property
    def ranks(self) -> int:
        """The number of ranks."""

    @property
    def facts(self) -> dict[str, Any]:
        """Facts of the scene, by name."""

    @property
    def box(self) -> tuple[float, float]:
        """Sides of the box along x and y, lengths."""

    @property
    def kinds(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.int64]]:
        """Radii (N,), lengths; masses (N,); species (N,), int64."""

    @property
    def ids(self) -> NDArray[np.int64]:
        """Ids of this rank's discs, (n,), int64, ascending."""

    @property
    def positions(self) -> NDArray[np.float64]:
        """(N, 2), lengths; 0 at ids of other ranks' discs."""

    @property
    def velocities(self) -> NDArray[np.float64]:
        """(N, 2), lengths per step; 0 at ids of other ranks' discs."""

    @property
    def spins(self) -> NDArray[np.float64]:
        """(N,), radians per step; 0 at ids of other ranks' discs."""

    @property
    def directions(self) -> NDArray[np.float64]:
        """(N,), radians; 0 at ids of other ranks' discs."""

    @property
    def collisions(self) -> NDArray[np.int64]:
        """(N, 2), int64: with walls, with discs; 0 at ids of other ranks' discs."""

    @property
    def images(self) -> NDArray[np.int32]:
        """(N, 2), int32: box lengths flown through periodic sides; 0 at ids of other ranks' shares.

        Collective.
        """

    @property
    def totals(self) -> dict[str, Any]:
        """Sums over all discs, by name. Collective."""

    @property
    def averages(self) -> dict[str, Any]:
        """Averages and their errors, by name. Collective."""

    @property
    def tables(self) -> list[tuple[str, list[str], NDArray[np.float64], list[str]]]:
        """Measurements so far: (name, columns, rows (n, columns), remarks) of each."""

    def taken_lines(self) -> list[str]:
        """Return the lines printed since the last call."""

    def advance(self, steps: int) -> None:
        """Move forward, without Python's lock. Collective."""

    def restart_averages(self) -> None:
        """Forget what has been averaged. Collective."""

    def agree_on(self, problems: Sequence[str]) -> None:
        """Raise the problems of all ranks on each rank, if any rank has one. Collective."""

    def change(
        self,
        positions: NDArray[np.float64] | None,
        velocities: NDArray[np.float64] | None,
        spins: NDArray[np.float64] | None,
    ) -> None:
        """Give this rank's discs other numbers, taken from arrays of all discs. Collective."""

    def write_checkpoint(self, path: str) -> None:
        """Write the state as a whole file or not at all. Collective."""

    def copy(self) -> Core:
        """Return an independent simulation of the same state. Collective."""
