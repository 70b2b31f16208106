# SPDX-License-Identifier: BSD-3-Clause
"""`Frames`: the frames of a trajectory, as a sequence."""

from __future__ import annotations

import operator
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Union, overload

import numpy as np
import numpy.typing as npt

from carrom import adapters, display, h5, labelled
from carrom.disc_arrays import Array
from carrom.errors import FileError, NoDataError
from carrom.frame import Frame
from carrom.trajectory_frame import System, TrajectoryFrame

if TYPE_CHECKING:
    import ase
    import freud
    import pandas
    import xarray
    from MDAnalysis import Universe
    from ovito.pipeline import Pipeline


class Frames(Sequence[Frame]):
    """The frames of a trajectory, as they were when it was opened.

    `frames[i]`, `frames[-1]`, slices, loops and `frames.at(step)` give frames. A frame reads its
    arrays from the file when they are first asked for.

    Attributes:
        path: the file; None for a run that has no trajectory yet
    """

    def __init__(self, path: str | os.PathLike[str] | None, owner: str = "") -> None:
        """Open a trajectory; `owner` is whose frames these are, for messages."""
        self.path = None if path is None else Path(path)
        self._owner = owner or str(path)
        self._open()
        self._places = np.arange(len(self.all_steps))

    def _open(self) -> None:
        self.all_steps = np.empty(0, dtype=np.int64)
        self.all_boxes = np.empty((0, 3))
        self._file: Any = None
        if self.path is None:
            return
        self._file = h5.open_file(self.path)
        try:
            edges = self._file["particles/discs/box/edges"]
            self.all_steps = h5.read(edges["step"]).astype(np.int64)
            self.all_boxes = h5.read(edges["value"])
            self.system = System(self._file)
        except (LookupError, TypeError, ValueError, AttributeError) as error:
            raise FileError(f"{self.path}: is no trajectory of carrom ({error})") from None

    @property
    def steps(self) -> npt.NDArray[np.int64]:
        """Steps of the frames, (F,)."""
        return self.all_steps[self._places]

    @property
    def n_discs(self) -> int:
        """N, the number of discs."""
        return self.system.n_discs if self._file is not None else 0

    @property
    def x(self) -> Array:
        """Positions of all frames (F, N, 2), lengths. All in memory at once."""
        return self._all("x")

    @property
    def v(self) -> Array:
        """Velocities of all frames (F, N, 2), lengths per step. All in memory at once."""
        return self._all("v")

    def _all(self, name: str) -> Array:
        if len(self) == 0:
            return np.empty((0, self.n_discs, 2))
        return np.stack([getattr(frame, name) for frame in self])

    def at(self, step: int) -> Frame:
        """Return the frame of a step.

        Raises:
            NoDataError: there is none; the message says which there are
        """
        found = np.flatnonzero(self.steps == step)
        if len(found):
            return self[int(found[0])]
        if len(self) == 0:
            raise NoDataError(self._nothing())
        few = f"there are {len(self)}, of steps {self.steps[0]} to {self.steps[-1]}"
        raise NoDataError(f"{self._owner}: no frame of step {step}; {few}")

    def has(self, name: str) -> bool:
        """Whether frames have a field of H5MD, for example "velocity"."""
        return self._file is not None and f"particles/discs/{name}" in self._file

    @property
    def fields(self) -> list[str]:
        """Names of the fields that frames have, as H5MD has them."""
        discs: Any = {} if self._file is None else self._file["particles/discs"]
        # Data sets are left out, because `name in data_set` would compare all of its values.
        groups = (name for name in discs if name != "box" and hasattr(discs[name], "keys"))
        return [name for name in groups if "value" in discs[name]]

    def close(self) -> None:
        """Close the file. What frames have read stays; more cannot be read."""
        if self._file is not None:
            self._file.close()

    def _is_closed(self) -> bool:
        return self._file is not None and not self._file

    def __enter__(self) -> Frames:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def field(self, name: str, index: int) -> Array:
        """Return a field of the file's frame `index`, as it is stored."""
        if self._is_closed():
            raise ValueError(f"{self._owner}: the trajectory is closed")
        if not self.has(name):
            known = ", ".join(self.fields) or "no field"
            raise NoDataError(
                f"{self._owner}: frames have no {name}, only {known}; output.trajectory.fields of "
                "the scene says what frames have"
            )
        values: Array = h5.read(self._file[f"particles/discs/{name}/value"], index)
        return values

    def to_pandas(self) -> pandas.DataFrame:
        """Return one pandas DataFrame, its index being `step` and `disc`. See `Frame.to_pandas`."""
        return labelled.frames_to_pandas(self)

    def to_xarray(self) -> xarray.Dataset:
        """Return one xarray Dataset with the dimension `step` too. See `Frame.to_xarray`."""
        return labelled.frames_to_xarray(self)

    def to_freud(
        self, *, walls: str | None = None
    ) -> list[tuple[freud.box.Box, npt.NDArray[np.float32]]]:
        """Return (box, points) of each frame. See `Frame.to_freud`."""
        return [frame.to_freud(walls=walls) for frame in self]

    def to_mdanalysis(self, *, unwrapped: bool = True, walls: str | None = None) -> Universe:
        """Return an MDAnalysis Universe of all frames, in memory, with the right `dt`.

        Atoms have `radii`, `masses`, `types` (the species) and, where frames have them,
        velocities. Numbers stay in the scene's units; MDAnalysis calls them Angstrom and ps.
        Departed discs stay in, at rest beyond their open side.

        The box is as high as it is long, so that MDAnalysis has room to search for neighbours. Its
        RDF counts shells of a sphere; times 2 r / (height of the box) it is that of discs.

        Args:
            unwrapped: positions go on through periodic sides without end, as `EinsteinMSD` needs
                them; distances that MDAnalysis takes with its box are the same. False leaves them
                in the box. A single frame is left in the box.
            walls: "apart" makes the box twice as long between walls, because MDAnalysis repeats
                its boxes in all directions: no disc has neighbours across a wall. Its RDF is then
                wrong: divide its counts of pairs by `Frame.ideal_pairs`.

        Raises:
            NoDataError: there are no frames, or they have no positions or images
            ValueError: frames are not equally far apart: MDAnalysis knows one `dt`; or the box
                has walls, and `walls` is None
        """
        universe: Universe = adapters.to_mdanalysis(self, unwrapped, walls)
        return universe

    def to_ase(self) -> list[ase.Atoms]:
        """Return ASE Atoms for each frame. See `Frame.to_ase`."""
        return [frame.to_ase() for frame in self]

    def to_ovito(self) -> Pipeline:
        """Return an OVITO Pipeline, which reads frames as OVITO shows them."""
        pipeline: Pipeline = adapters.to_ovito_pipeline(self)
        return pipeline

    def __len__(self) -> int:
        return len(self._places)

    @overload
    def __getitem__(self, index: int) -> Frame: ...
    @overload
    def __getitem__(self, index: slice) -> Frames: ...
    # Completion in editors understands Union, but not `Frame | Frames`.
    def __getitem__(self, index: int | slice) -> Union[Frame, Frames]:  # noqa: UP007
        """Return a frame, or the frames of a slice."""
        if isinstance(index, slice):
            part = object.__new__(Frames)
            part.__dict__ |= self.__dict__
            part._places = self._places[index]
            return part
        place = operator.index(index)
        if len(self) == 0:
            raise IndexError(self._nothing())
        if not -len(self) <= place < len(self):
            raise IndexError(f"{self._owner}: no frame {place}; there are {len(self)}")
        return TrajectoryFrame(self, int(self._places[place]))

    def __iter__(self) -> Iterator[Frame]:
        return (TrajectoryFrame(self, int(place)) for place in self._places)

    def _nothing(self) -> str:
        if self.path is not None:
            return f"{self._owner}: no frames yet"
        return f"{self._owner}: no frames; output.trajectory.every_steps of the scene asks for them"

    def __repr__(self) -> str:
        if len(self) == 0:
            return f"<no frames of {self._owner}>"
        return f"<{len(self)} frames of {self._owner}, steps {self.steps[0]} to {self.steps[-1]}>"

    def _repr_html_(self) -> str:
        if len(self) == 0:
            return display.facts(repr(self).strip("<>"), {})
        facts = {
            "frames": len(self),
            "steps": f"{self.steps[0]} to {self.steps[-1]}",
            "discs": self.n_discs,
            "fields": ", ".join(self.fields),
        }
        return display.facts(f"frames of {self._owner}", facts) + display.picture(self[-1])

    def __getstate__(self) -> dict[str, Any]:
        """Let other processes open the file for themselves."""
        return {"path": self.path, "_owner": self._owner, "_places": self._places}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._open()
