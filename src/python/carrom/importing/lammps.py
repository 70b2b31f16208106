# SPDX-License-Identifier: BSD-3-Clause
"""LAMMPS: dump files as text, and data files. Two dimensions, boxes without tilt."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence

import numpy as np

from carrom.errors import FileError
from carrom.importing.discs import Box, Discs, check_count, parse_rows
from carrom.importing.lines import Lines, TextFrames


@dataclasses.dataclass
class _Head:
    step: int
    count: int
    box: Box
    names: list[str]


def _edge(lines: Lines, words: Sequence[str]) -> tuple[float, float]:
    try:
        low, high = float(words[0]), float(words[1])
    except (ValueError, IndexError):
        lines.refuse("expected the lower and the upper end of the box")
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        lines.refuse("expected the lower and the upper end of the box, which are finite")
    return low, high


def _periodic(lines: Lines, word: str) -> bool:
    if word not in ("pp", "ff"):
        lines.refuse(f"a boundary {word!r}; Carrom takes pp (periodic) and ff (walls)")
    return word == "pp"


def _no_tilt(lines: Lines, words: Sequence[str]) -> None:
    for word in words:
        try:
            is_tilted = float(word) != 0
        except ValueError:
            lines.refuse(f"{word[:40]!r} is no tilt of the box")
        if is_tilted:
            lines.refuse("the box is tilted; Carrom's boxes are rectangles")


def _dump_head(lines: Lines) -> _Head | None:
    step, count, box = 0, 0, None
    while True:
        line = lines.next()
        if line is None or not line.startswith("ITEM:"):
            if line is None and box is None and count == 0:
                return None
            if line is not None and not line.strip():
                continue
            lines.refuse(
                "expected a line ITEM: of LAMMPS"
                if line is not None
                else "the file ends in the head of a frame"
            )
        words = line.split()[1:]
        if words[:1] == ["TIMESTEP"]:
            try:
                step = int(lines.need("a step"))
            except ValueError:
                lines.refuse("expected a step")
        elif words[:3] == ["NUMBER", "OF", "ATOMS"]:
            text = lines.need("the number of atoms")
            count = check_count(f"{lines.name}:{lines.number}", text, lines.size)
        elif words[:2] == ["BOX", "BOUNDS"]:
            box = _dump_box(lines, words[2:])
        elif words[:1] == ["ATOMS"]:
            if box is None or count == 0:
                lines.refuse("ATOMS before NUMBER OF ATOMS or BOX BOUNDS")
            return _Head(step, count, box, words[1:])
        elif words[:1] in (["UNITS"], ["TIME"]):
            lines.need("a value")
        else:
            lines.refuse("an ITEM that LAMMPS has not in dumps of atoms")


def _dump_box(lines: Lines, words: list[str]) -> Box:
    has_tilt = words[:3] == ["xy", "xz", "yz"]
    if words[:1] == ["abc"]:
        lines.refuse("the box is a general triclinic one; Carrom's boxes are rectangles")
    sides = words[3:] if has_tilt else words
    periodic = (True, True)
    if len(sides) == 3:
        periodic = (_periodic(lines, sides[0]), _periodic(lines, sides[1]))
    ends = []
    for _ in range(3):
        numbers = lines.need("the ends of the box").split()
        ends.append(_edge(lines, numbers))
        _no_tilt(lines, numbers[2:])
    (x0, x1), (y0, y1) = ends[:2]
    return Box((x1 - x0, y1 - y0), (x0, y0), periodic)


def read_dump(path: str, frame: int | None, step: int | None) -> Discs:
    """Read a frame of `dump custom` or `dump atom` as text. Scaled places are taken, too."""
    with Lines(path) as lines:
        number, head = TextFrames(lines, _dump_head).find(frame, step)
        rows = lines.take_rows(head.count, number)
    scaled = {"xs": "x", "ys": "y", "xsu": "x", "ysu": "y"}
    names = [scaled.get(name, name) for name in head.names]
    columns, kinds, places = parse_rows(path, rows, names)
    if "x" not in columns or "y" not in columns:
        raise FileError(f"{path}:{places[0] - 1}: has no columns x and y")
    for k, axis in enumerate("xy"):
        if axis not in head.names and f"{axis}u" not in head.names:
            columns[axis] = head.box.origin[k] + columns[axis] * head.box.size[k]
    return Discs(columns, kinds, head.box, places, path)


# The columns of a line of Atoms, for each style that Carrom can read.
_STYLES = {
    "atomic": ["id", "type", "x", "y", "z"],
    "charge": ["id", "type", "q", "x", "y", "z"],
    "sphere": ["id", "type", "diameter", "density", "x", "y", "z"],
    "disc": ["id", "type", "diameter", "density", "x", "y", "z"],
}


@dataclasses.dataclass
class _Data:
    """What has been read of a data file."""

    count: int = 0
    edges: dict[str, tuple[float, float]] = dataclasses.field(default_factory=dict)
    masses: dict[str, float] = dataclasses.field(default_factory=dict)
    style: str = ""
    atoms: list[tuple[int, list[str]]] = dataclasses.field(default_factory=list)
    speeds: list[tuple[int, list[str]]] = dataclasses.field(default_factory=list)


def read_data(path: str, frame: int | None, step: int | None, style: str = "") -> Discs:
    """Read a data file (`read_data`) with atoms of style atomic, charge, sphere or disc."""
    if frame not in (None, 0, -1) or step is not None:
        raise FileError(f"{path}: a data file has one frame, 0, without a step")
    data = _Data(style=style)
    with Lines(path) as lines:
        lines.next()  # the first line is a title
        section = ""
        while (line := lines.next()) is not None:
            words = line.split("#")[0].split()
            if words and words[0][0].isalpha():
                section = words[0]
                if section == "Atoms":
                    _take_style(lines, data, line)
            elif words:
                _take(lines, data, section, words)
    return _discs_of(path, data)


def _take_style(lines: Lines, data: _Data, line: str) -> None:
    named = line.partition("#")[2].strip()
    data.style = named or data.style or "atomic"
    if data.style not in _STYLES:
        lines.refuse(f"atoms of style {data.style!r}; taken are {', '.join(_STYLES)}")


def _take(lines: Lines, data: _Data, section: str, words: list[str]) -> None:
    if section == "":
        _take_head(lines, data, words)
    elif section == "Masses":
        try:
            data.masses[words[0]] = float(words[1])
        except (ValueError, IndexError):
            lines.refuse("expected a type and its mass")
    elif section == "Atoms":
        data.atoms.append((lines.number, words))
    elif section == "Velocities":
        data.speeds.append((lines.number, words[:4]))


def _take_head(lines: Lines, data: _Data, words: list[str]) -> None:
    if words[1:] == ["atoms"]:
        data.count = check_count(f"{lines.name}:{lines.number}", words[0], lines.size)
    for axis in "xyz":
        if words[2:] == [f"{axis}lo", f"{axis}hi"]:
            data.edges[axis] = _edge(lines, words)
    if words[3:] == ["xy", "xz", "yz"]:
        _no_tilt(lines, words[:3])
    if words[-1:] == ["avec"]:
        lines.refuse("the box is a general triclinic one; Carrom's boxes are rectangles")


def _discs_of(path: str, data: _Data) -> Discs:
    if data.count == 0 or not {"x", "y"} <= data.edges.keys():
        raise FileError(f"{path}: has no line 'N atoms', or none 'xlo xhi' and 'ylo yhi'")
    if len(data.atoms) != data.count:
        raise FileError(f"{path}: announces {data.count} atoms, but has {len(data.atoms)} in Atoms")
    names = _STYLES[data.style]
    rows = [
        (line, words[: len(names)] if len(words) == len(names) + 3 else words)
        for line, words in data.atoms
    ]  # three counts of images may follow
    columns, kinds, places = parse_rows(path, rows, names)
    _add_masses(path, columns, kinds or [], data, rows)
    if data.speeds:
        _add_speeds(path, columns, data)
    (x0, x1), (y0, y1) = data.edges["x"], data.edges["y"]
    return Discs(columns, kinds, Box((x1 - x0, y1 - y0), (x0, y0)), places, path)


def _add_masses(
    path: str,
    columns: dict[str, np.ndarray],
    kinds: list[str],
    data: _Data,
    rows: list[tuple[int, list[str]]],
) -> None:
    if data.style in ("sphere", "disc"):
        density = parse_rows(path, rows, ["-", "-", "-", "mass", "-", "-", "-"])[0]["mass"]
        radius = columns["radius"]
        area = math.pi * radius**2
        columns["mass"] = density * (area if data.style == "disc" else area * radius * 4 / 3)
    elif data.masses:
        missing = sorted(set(kinds) - data.masses.keys())
        if missing:
            raise FileError(f"{path}: type {missing[0]} has no mass in Masses")
        columns["mass"] = np.array([data.masses[kind] for kind in kinds])


def _add_speeds(path: str, columns: dict[str, np.ndarray], data: _Data) -> None:
    speeds, _, places = parse_rows(path, data.speeds, ["id", "vx", "vy", "vz"])
    row_of = {number: k for k, number in enumerate(columns["id"])}
    for name in ("vx", "vy", "vz"):
        columns[name] = np.zeros(data.count)
    if len(places) != data.count:
        raise FileError(f"{path}: {len(places)} Velocities for {data.count} atoms")
    for k, number in enumerate(speeds["id"]):
        if number not in row_of:
            raise FileError(f"{path}:{places[k]}: there is no atom {number:.0f}")
        for name in ("vx", "vy", "vz"):
            columns[name][row_of[number]] = speeds[name][k]
