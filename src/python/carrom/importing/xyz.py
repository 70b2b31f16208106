# SPDX-License-Identifier: BSD-3-Clause
"""Extended XYZ, as `carrom convert`, OVITO and ASE write it, and plain XYZ."""

from __future__ import annotations

import dataclasses
import re

import numpy as np

from carrom.errors import FileError
from carrom.importing.discs import Box, Discs, check_count, parse_rows
from carrom.importing.lines import Lines, TextFrames

_SETTING = re.compile(r"""([A-Za-z_]\w*)\s*=\s*("[^"]*"|'[^']*'|\{[^}]*\}|\S+)""")
_VECTORS = {
    "pos": ["x", "y", "z"],
    "velo": ["vx", "vy", "vz"],
    "vel": ["vx", "vy", "vz"],
    "velocities": ["vx", "vy", "vz"],
    "momenta": ["px", "py", "pz"],
}
_PLAIN = ["species", "x", "y", "z"]


@dataclasses.dataclass
class _Head:
    step: int | None
    count: int
    settings: dict[str, str]
    line: int


def _head(lines: Lines) -> _Head | None:
    text = lines.next()
    while text is not None and not text.strip():
        text = lines.next()
    if text is None:
        return None
    count = check_count(f"{lines.name}:{lines.number}", text, lines.size)
    comment = lines.need("the comment of a frame")
    settings = {name.lower(): value.strip("\"'{}") for name, value in _SETTING.findall(comment)}
    step = next((settings[name] for name in ("step", "timestep", "time") if name in settings), None)
    try:
        whole = None if step is None else int(float(step))
    except (ValueError, OverflowError):
        lines.refuse(f"{step!r} is no step")
    return _Head(whole, count, settings, lines.number)


def _names_of(path: str, head: _Head, n_words: int) -> list[str]:
    if "properties" not in head.settings:
        return _PLAIN if n_words == len(_PLAIN) else [*_PLAIN, "vx", "vy", "vz"]
    parts = head.settings["properties"].split(":")
    names: list[str] = []
    for name, count in zip(parts[::3], parts[2::3]):
        if not count.isdigit() or not 0 < int(count) < 1000:
            raise FileError(f"{path}:{head.line}: Properties has {count!r} for a number of columns")
        own = _VECTORS.get(name, [name])
        names += own if len(own) == int(count) else [f"{name}_{k}" for k in range(int(count))]
    return names


def _box_of(path: str, head: _Head) -> Box | None:
    if "lattice" not in head.settings:
        return None
    try:
        cell = np.array([float(word) for word in head.settings["lattice"].split()]).reshape(3, 3)
        origin = [float(word) for word in head.settings.get("origin", "0 0 0").split()]
        x0, y0 = origin[:2]
    except ValueError:
        raise FileError(f"{path}:{head.line}: Lattice has nine numbers, Origin three") from None
    if np.any(cell[~np.eye(3, dtype=bool)] != 0) or not np.all(np.isfinite(cell)):
        raise FileError(f"{path}:{head.line}: the box is tilted; Carrom's boxes are rectangles")
    sides = head.settings.get("pbc", "T T T").replace(",", " ").split()
    periodic = [side.lower() in ("t", "true", "1") for side in sides]
    if len(periodic) != 3:
        raise FileError(f"{path}:{head.line}: pbc has three words, T or F")
    return Box((cell[0, 0], cell[1, 1]), (x0, y0), (periodic[0], periodic[1]))


def read_xyz(path: str, frame: int | None, step: int | None) -> Discs:
    """Read a frame of XYZ."""
    with Lines(path) as lines:
        number, head = TextFrames(lines, _head).find(frame, step)
        rows = lines.take_rows(head.count, number)
    columns, kinds, places = parse_rows(path, rows, _names_of(path, head, len(rows[0][1])))
    if "x" not in columns or "y" not in columns:
        raise FileError(f"{path}:{head.line}: Properties has no pos:R:3")
    if "vx" not in columns and "mass" in columns:
        _add_velocities(path, columns, rows, _names_of(path, head, 0))
    return Discs(columns, kinds, _box_of(path, head), places, path)


def _add_velocities(
    path: str, columns: dict[str, np.ndarray], rows: list[tuple[int, list[str]]], names: list[str]
) -> None:
    """ASE stores momenta, and no velocities."""
    if "px" not in names:
        return
    for momentum, velocity in (("px", "vx"), ("py", "vy"), ("pz", "vz")):
        k = names.index(momentum)
        renamed = [velocity if i == k else "-" for i in range(len(names))]
        columns[velocity] = parse_rows(path, rows, renamed)[0][velocity] / columns["mass"]
