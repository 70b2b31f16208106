# SPDX-License-Identifier: BSD-3-Clause
"""Frames for freud, MDAnalysis, ASE and OVITO. Each package is needed for its own function."""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from carrom.disc_arrays import Array, DiscArrays
from carrom.errors import MissingPackageError, NoDataError

# Packages of libraries that OVITO 3's wheel needs and a minimal Debian lacks, as ldd shows.
_OVITO_PACKAGES = "libegl1 libgl1 libopengl0 libxkbcommon0 libfontconfig1 libdbus-1-3 libglib2.0-0"


def package(name: str, wanted_by: str, project: str = "") -> Any:
    """Import a package, or say how to install it."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        if ".so" in str(error):
            raise MissingPackageError(_of_the_system(wanted_by, name, str(error))) from None
        raise MissingPackageError(
            f"{wanted_by} needs {name} ({error}): pip install {project or name}"
        ) from None


def _of_the_system(wanted_by: str, name: str, error: str) -> str:
    """Say what a package that is installed lacks. OVITO needs libraries for graphics."""
    text = f"{wanted_by}: {name} is installed, but lacks a library of the system ({error})"
    if name.startswith("ovito"):
        text += f"; on Debian try: apt-get install {_OVITO_PACKAGES}"
    return text


def positions_of(frame: DiscArrays, wanted_by: str) -> Array:
    """Return positions (N, 2), or say which field of the scene is missing."""
    try:
        return frame.x
    except NoDataError as error:
        raise NoDataError(f"{wanted_by} needs the field position: {error}") from None


def in_three_dimensions(vectors: Array, dtype: npt.DTypeLike = np.float64) -> Array:
    """Return (N, 3) for (N, 2), with zeros along z."""
    result = np.zeros((len(vectors), 3), dtype=dtype)
    result[:, :2] = vectors
    return result


def velocities_of(frame: DiscArrays) -> Array | None:
    """Return velocities (N, 2), or None where frames have none."""
    try:
        return frame.v
    except NoDataError:
        return None


def periodic_box(frame: DiscArrays, walls: str | None, wanted_by: str) -> Array:
    """Return the edges (2,) of a periodic box for a package that knows no other.

    `walls="apart"` doubles it between walls, so that no disc has neighbours across one.

    Raises:
        ValueError: the box has walls, and `walls` does not say what is to become of them
    """
    if walls not in (None, "apart"):
        raise ValueError(f'{wanted_by}: walls is None or "apart", not {walls!r}')
    if walls is None and not all(frame.periodic):
        raise ValueError(
            f"{wanted_by}: the box has walls, but the package repeats its boxes, so that g(r) and "
            'densities would be wrong; Carrom has g(r) in run.tables["radial_distribution"]. '
            'try: walls="apart", a box twice as long in which neighbours are right, and '
            "frame.ideal_pairs(edges) to divide counts of pairs by"
        )
    return np.where(frame.periodic, 1.0, 2.0) * frame.box


def to_freud(frame: DiscArrays, walls: str | None = None) -> Any:
    """See `Frame.to_freud`."""
    freud = package("freud", "to_freud", "freud-analysis")
    centres = positions_of(frame, "to_freud")
    room = periodic_box(frame, walls, "to_freud")
    box = freud.box.Box(Lx=room[0], Ly=room[1], is2D=True)
    middle = frame.corner + frame.box / 2
    points = in_three_dimensions(centres[frame.present] - middle, np.float32)
    return box, points


def to_mdanalysis(
    frames: Sequence[DiscArrays], unwrapped: bool = True, walls: str | None = None
) -> Any:
    """See `Frames.to_mdanalysis`."""
    mda = package("MDAnalysis", "to_mdanalysis")
    memory = package("MDAnalysis.coordinates.memory", "to_mdanalysis", "MDAnalysis")
    if len(frames) == 0:
        raise NoDataError("to_mdanalysis needs at least one frame")
    first = frames[0]
    universe = mda.Universe.empty(first.n_discs, trajectory=False, velocities=True)
    universe.add_TopologyAttr("masses", first.mass)
    universe.add_TopologyAttr("radii", first.radius)
    universe.add_TopologyAttr("types", [str(number + 1) for number in first.species])
    is_unwrapped = unwrapped and len(frames) > 1
    centres = [_centres(frame, is_unwrapped) for frame in frames]
    moving = [velocities_of(frame) for frame in frames]
    velocities = None
    if all(v is not None for v in moving):
        velocities = np.stack([in_three_dimensions(v, np.float32) for v in moving if v is not None])
    rooms = [periodic_box(frame, walls, "to_mdanalysis") for frame in frames]
    dimensions = np.array([[*room, room.max(), 90, 90, 90] for room in rooms], dtype=np.float32)
    universe.load_new(
        np.stack([in_three_dimensions(x, np.float32) for x in centres]),
        format=memory.MemoryReader,
        order="fac",
        dimensions=dimensions,
        velocities=velocities,
        dt=_interval(frames),
        time_offset=first.time,
    )
    universe.trajectory.filename = None
    return universe


def _centres(frame: DiscArrays, unwrapped: bool) -> Array:
    """Return positions (N, 2): in the box, or as far as discs have flown through its sides."""
    inside = positions_of(frame, "to_mdanalysis")
    if not unwrapped or not any(frame.periodic):
        return inside
    try:
        flown = frame.image
    except NoDataError as error:
        raise NoDataError(
            "to_mdanalysis needs the field image, because a mean squared displacement of wrapped "
            f"positions is wrong: {error}; try: unwrapped=False"
        ) from None
    unwrapped_centres: Array = inside + flown * np.asarray(frame.box)
    return unwrapped_centres


def _interval(frames: Sequence[DiscArrays]) -> float:
    """Return steps from frame to frame.

    Raises:
        ValueError: they are not equal; MDAnalysis knows one `dt`
    """
    gaps = np.diff([frame.step for frame in frames])
    if len(gaps) == 0:
        return 1.0
    if np.any(gaps != gaps[0]):
        raise ValueError(
            "frames are not equally far apart, but MDAnalysis knows one dt; take a slice"
        )
    return float(gaps[0])


def to_ase(frame: DiscArrays) -> Any:
    """See `Frame.to_ase`."""
    ase = package("ase", "to_ase")
    atoms = ase.Atoms(
        numbers=np.zeros(frame.n_discs, dtype=int),
        positions=in_three_dimensions(positions_of(frame, "to_ase")),
        masses=frame.mass,
        cell=[*frame.box, 1.0],
        celldisp=[*frame.corner, 0.0],
        pbc=[*frame.periodic, False],
        info={"step": frame.step, "time": frame.time},
    )
    atoms.set_array("radius", np.array(frame.radius))
    atoms.set_array("species", np.array(frame.species))
    velocities = velocities_of(frame)
    if velocities is not None:
        atoms.set_velocities(in_three_dimensions(velocities))
    return atoms


def to_ovito(frame: DiscArrays) -> Any:
    """See `Frame.to_ovito`."""
    data = package("ovito.data", "to_ovito", "ovito").DataCollection()
    fill_ovito(data, frame)
    return data


def fill_ovito(data: Any, frame: DiscArrays) -> None:
    """Put a frame into an empty DataCollection."""
    cell = np.zeros((3, 4))
    cell[:, :3] = np.diag([*frame.box, 1.0])
    cell[:2, 3] = frame.corner
    data.create_cell(cell, pbc=(*frame.periodic, False)).is2D = True
    data.attributes["Timestep"] = frame.step
    data.attributes["Time"] = frame.time
    particles = data.create_particles(count=frame.n_discs)
    particles.create_property("Position", data=in_three_dimensions(positions_of(frame, "to_ovito")))
    particles.create_property("Particle Identifier", data=np.arange(frame.n_discs))
    particles.create_property("Radius", data=frame.radius)
    particles.create_property("Mass", data=frame.mass)
    types = particles.create_property("Particle Type", data=frame.species + 1)
    for number in np.unique(frame.species):
        kind = types.add_type_id(int(number) + 1, particles, name=f"species {number + 1}")
        kind.radius = float(frame.radius[frame.species == number][0])
    velocities = velocities_of(frame)
    if velocities is not None:
        particles.create_property("Velocity", data=in_three_dimensions(velocities))


def to_ovito_pipeline(frames: Sequence[DiscArrays]) -> Any:
    """See `Frames.to_ovito`."""
    module = package("ovito.pipeline", "to_ovito", "ovito")

    base: Any = module.PipelineSourceInterface

    class Source(base):  # type: ignore[misc]
        """Gives OVITO the frame that it shows."""

        def compute_trajectory_length(self, **_: Any) -> int:
            return len(frames)

        def create(self, data: Any, *, frame: int, **_: Any) -> None:
            fill_ovito(data, frames[frame])

    return module.Pipeline(source=module.PythonSource(delegate=Source()))
