# SPDX-License-Identifier: BSD-3-Clause
"""GSD, the format of HOOMD-blue. Its boxes are periodic and centred on the origin."""

from __future__ import annotations

from typing import Any

import numpy as np

from carrom.adapters import package
from carrom.errors import FileError
from carrom.importing.discs import Box, Discs, check_count
from carrom.importing.lines import chosen
from carrom.plain import open_plain


def read_gsd(path: str, frame: int | None, step: int | None) -> Discs:
    """Read a frame of GSD. Numbers have 24 bits there."""
    hoomd = package("gsd.hoomd", "importing GSD", "gsd")
    open_plain(path).close()
    try:
        with hoomd.open(path, mode="r") as file:
            steps = [int(one.configuration.step) for one in file] if step is not None else []
            number = chosen(path, len(file), frame, step, list(steps))
            moment = file[number]
    except (RuntimeError, OSError, KeyError, ValueError, IndexError, MemoryError) as error:
        raise FileError(f"{path}: cannot be read as GSD: {error}") from None
    return _discs_of(f"{path}: frame {number}", moment)


def _discs_of(place: str, moment: Any) -> Discs:
    edges = [float(edge) for edge in moment.configuration.box]
    if any(edge != 0 for edge in edges[3:]):
        raise FileError(f"{place}: the box is tilted; Carrom's boxes are rectangles")
    particles = moment.particles
    check_count(place, particles.N, 1 << 62)
    columns: dict[str, np.ndarray] = {}
    for name, source in (("", particles.position), ("v", particles.velocity)):
        if source is None:
            continue
        for k, axis in enumerate("xyz"):
            columns[name + axis] = np.asarray(source, dtype=np.float64)[:, k]
    if particles.mass is not None:
        columns["mass"] = np.asarray(particles.mass, dtype=np.float64)
    if particles.diameter is not None:
        columns["radius"] = np.asarray(particles.diameter, dtype=np.float64) / 2
    kinds = None
    if particles.typeid is not None and particles.types:
        if np.any(np.asarray(particles.typeid) >= len(particles.types)):
            raise FileError(f"{place}: a particle has a type that has no name")
        kinds = [particles.types[k] for k in particles.typeid]
    box = Box((edges[0], edges[1]), (-edges[0] / 2, -edges[1] / 2))
    return Discs(columns, kinds, box, None, place)
