# SPDX-License-Identifier: BSD-3-Clause
"""Frames as GSD, the file format of HOOMD-blue."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from carrom.adapters import in_three_dimensions, package, positions_of, velocities_of
from carrom.errors import NoDataError
from carrom.frame import Frame
from carrom.runs import Run


def to_gsd(source: Run | Sequence[Frame], path: str | os.PathLike[str]) -> Path:
    """Write frames as GSD and return the path. Needs the package gsd.

    GSD boxes are centred on the origin, so half the box is taken off positions. Numbers are
    float32. All of its boxes are periodic: where a side is a wall, GSD does not know. Departed
    discs stay in, at rest beyond their open side.
    """
    hoomd = package("gsd.hoomd", "to_gsd", "gsd")
    frames: Sequence[Frame] = source.frames if isinstance(source, Run) else source
    if len(frames) == 0:
        raise NoDataError("to_gsd needs at least one frame")
    path = Path(path)
    part = path.with_name(path.name + ".part")
    with hoomd.open(part, mode="w") as file:
        for frame in frames:
            file.append(_moment(hoomd, frame))
    part.replace(path)
    return path


def _moment(hoomd: Any, frame: Frame) -> Any:
    moment = hoomd.Frame()
    moment.configuration.step = frame.step
    moment.configuration.dimensions = 2
    moment.configuration.box = [*frame.box, 0, 0, 0, 0]
    discs = moment.particles
    discs.N = frame.n_discs
    discs.position = in_three_dimensions(positions_of(frame, "to_gsd") - frame.box / 2, np.float32)
    velocities = velocities_of(frame)
    if velocities is not None:
        discs.velocity = in_three_dimensions(velocities, np.float32)
    discs.mass = frame.mass.astype(np.float32)
    discs.diameter = (2 * frame.radius).astype(np.float32)
    discs.typeid = frame.species.astype(np.uint32)
    discs.types = [
        f"species {number + 1}" for number in range(int(frame.species.max(initial=0)) + 1)
    ]
    return moment
