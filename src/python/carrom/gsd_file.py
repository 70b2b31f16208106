# SPDX-License-Identifier: BSD-3-Clause
"""Frames as GSD, the file format of HOOMD-blue."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from carrom.adapters import (
    in_three_dimensions,
    package,
    periodic_box,
    positions_of,
    velocities_of,
)
from carrom.destinations import refuse_owned
from carrom.errors import NoDataError
from carrom.frame import Frame
from carrom.runs import Run


def to_gsd(
    source: Run | Sequence[Frame], path: str | os.PathLike[str], *, walls: str | None = None
) -> Path:
    """Write frames as GSD and return the path. Needs the package gsd.

    GSD boxes are centred on the origin, so positions count from the middle of the box. Numbers are
    float32. Departed discs stay in, at rest beyond their open side. The log of each frame has
    `carrom/time`, `carrom/kinetic_energy` where frames have velocities, and all of the table
    `thermo` where the run has a row of that step.

    Args:
        source: a run, its frames or some of them
        path: the file, which is replaced
        walls: "apart" makes the box twice as long between walls, because all boxes of GSD are
            periodic: no disc has neighbours across a wall, but densities are too small

    Raises:
        NoDataError: there are no frames, or they have no positions
        ValueError: the box has walls, and `walls` is None
    """
    hoomd = package("gsd.hoomd", "to_gsd", "gsd")
    frames: Sequence[Frame] = source.frames if isinstance(source, Run) else source
    if len(frames) == 0:
        raise NoDataError("to_gsd needs at least one frame")
    rows = _thermo_rows(source) if isinstance(source, Run) else {}
    path = Path(path)
    refuse_owned(path)
    part = path.with_name(path.name + ".part")
    with hoomd.open(part, mode="w") as file:
        for frame in frames:
            file.append(_moment(hoomd, frame, walls, rows.get(frame.step, {})))
    part.replace(path)
    return path


def _thermo_rows(run: Run) -> dict[int, dict[str, float]]:
    """Return what the table `thermo` has of each step; nothing without the table."""
    if "thermo" not in run.tables:
        return {}
    table = run.thermo
    return {int(row["step"]): {name: row[name] for name in table.columns} for row in table}


def _moment(hoomd: Any, frame: Frame, walls: str | None, thermo: Mapping[str, float]) -> Any:
    moment = hoomd.Frame()
    moment.configuration.step = frame.step
    moment.configuration.dimensions = 2
    moment.configuration.box = [*periodic_box(frame, walls, "to_gsd"), 0, 0, 0, 0]
    discs = moment.particles
    discs.N = frame.n_discs
    middle = frame.corner + frame.box / 2
    discs.position = in_three_dimensions(positions_of(frame, "to_gsd") - middle, np.float32)
    log: dict[str, float] = {"time": frame.time}
    velocities = velocities_of(frame)
    if velocities is not None:
        discs.velocity = in_three_dimensions(velocities, np.float32)
        log["kinetic_energy"] = frame.kinetic_energy
    log |= thermo
    moment.log = {f"carrom/{name}": np.array([value]) for name, value in log.items()}
    discs.mass = frame.mass.astype(np.float32)
    discs.diameter = (2 * frame.radius).astype(np.float32)
    discs.typeid = frame.species.astype(np.uint32)
    discs.types = [
        f"species {number + 1}" for number in range(int(frame.species.max(initial=0)) + 1)
    ]
    return moment
