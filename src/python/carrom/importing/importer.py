# SPDX-License-Identifier: BSD-3-Clause
"""From a file of another program to a checkpoint that `discs.from` takes."""

from __future__ import annotations

import dataclasses
import itertools
import math
import os
import re
import shutil
import tempfile
import warnings
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np
import numpy.typing as npt

from carrom.destinations import refuse_owned
from carrom.errors import FileError, InputError
from carrom.importing import gsd, lammps, rows, xyz
from carrom.importing.discs import Box, Discs
from carrom.launching import CarromWarning
from carrom.plain import open_plain
from carrom.running import run
from carrom.scene import toml_value

Reader = Callable[[str, "int | None", "int | None"], Discs]
FORMATS: dict[str, Reader] = {
    "gsd": gsd.read_gsd,
    "lammps-dump": lammps.read_dump,
    "lammps-data": lammps.read_data,
    "xyz": xyz.read_xyz,
    "rows": rows.read_rows,
}
FEW_KINDS = 118  # with at most this many kinds, discs are sorted by kind: one species each
_GSD = b"\xdf\x65\xdf\x65\xdf\x65\xdf\x65"


@dataclasses.dataclass
class Choice:
    """What to take from a file, and what the file does not say.

    Attributes:
        format: one of `FORMATS`; else the begin of the file decides
        frame: from 0 on, negative from the end; the last one if neither frame nor step is given
        step: the frame of this step
        box: the edges, where the file has no box
        origin: the lower left corner of the box, or "centre" if the box is centred on 0
        periodic: "x", "y", "xy" or "none", instead of what the file says
        radius: the radius of discs, by the name of their type; "" is for all types
        mass: likewise
        time_step: the file's time that passes in a step of Carrom
        shrink: the share by which radii become smaller
        keep_origin: places stay as the file has them, and the scene gets `box.origin`
    """

    format: str = ""
    frame: int | None = None
    step: int | None = None
    box: tuple[float, float] | None = None
    origin: tuple[float, float] | str | None = None
    periodic: str | None = None
    radius: Mapping[str, float] = dataclasses.field(default_factory=dict)
    mass: Mapping[str, float] = dataclasses.field(default_factory=dict)
    time_step: float = 1.0
    shrink: float = 0.0
    keep_origin: bool = False


@dataclasses.dataclass
class Imported:
    """The scene's tables [box] and [discs], and what the file did not have."""

    scene: str
    remarks: list[str]


def format_of(path: str) -> str:
    """Recognize the format by the first bytes and lines, because names of files can lie.

    Raises:
        FileError: it is none of `FORMATS`
    """
    with open_plain(path) as file:
        begin: bytes = file.read(1 << 16)
    if begin.startswith(b"\x89HDF\r\n\x1a\n"):
        raise FileError(f"{path}: is an HDF5 file; discs.from takes those of Carrom as they are")
    if begin.startswith(_GSD):
        return "gsd"
    if b"\0" in begin:
        raise FileError(f"{path}: is none of the formats {', '.join(FORMATS)}")
    lines = [line.strip() for line in begin.decode("utf-8", errors="replace").splitlines()]
    filled = [line for line in lines if line]
    if not filled:
        raise FileError(f"{path}: is empty")
    if filled[0].startswith("ITEM:"):
        return "lammps-dump"
    if filled[0].isdigit() and len(filled) > 2:
        if len(filled[1].split()) == 1 and len(filled[2].split()) == 1:
            raise FileError(f"{path}: is a scene of the course, which `carrom run` takes as it is")
        return "xyz"
    if any(re.fullmatch(r"\d+\s+atoms", line.split("#")[0].strip()) for line in filled[:200]):
        return "lammps-data"
    words = rows.words_of(filled[0].lstrip("#\ufeff "))
    if rows.names_in(words) or all(re.fullmatch(r"[-+.\deE]+|nan|inf", word) for word in words):
        return "rows"
    raise FileError(
        f"{path}:1: is none of the formats {', '.join(FORMATS)}; rows are numbers, or have a "
        "first line with names, among them x and y"
    )


def read_discs(path: str | os.PathLike[str], choice: Choice | None = None) -> Discs:
    """Read a frame, and check and complete it: discs are in a box from (0, 0) on, or where the
    file has them with `keep_origin`, and have velocities per step, radii and masses.

    Columns of rows whose names are not known are left out. A `CarromWarning` names them, because
    a name may be misspelled.

    Raises:
        FileError: the file is wrong, or says too little; the message has the line or the frame
    """
    return _read_discs(path, choice)


def _read_discs(path: str | os.PathLike[str], choice: Choice | None) -> Discs:
    """Do what `read_discs` does. Warnings name the line that called the caller."""
    choice = choice or Choice()
    name = os.fspath(path)
    try:
        reader = FORMATS[choice.format or format_of(name)]
        discs = reader(name, choice.frame, choice.step)
    except OSError as error:
        raise FileError(f"{name}: {error.strerror or error}") from None
    _check_numbers(discs)
    _complete(discs, choice)
    _put_into_box(discs, choice)
    for remark in discs.remarks:
        warnings.warn(remark, CarromWarning, stacklevel=3)
    return _in_order(discs)


def _check_numbers(discs: Discs) -> None:
    for name, column in discs.columns.items():
        discs.first(~np.isfinite(column), f"{name} is not finite")
    for name in ("z", "vz"):
        column = discs.columns.pop(name, np.zeros(discs.count))
        # A dump of two dimensions may have all z at one small value.
        discs.first(column != column[0], f"{name} differs; Carrom has two dimensions")


def _of_kind(given: Mapping[str, float], discs: Discs, what: str) -> npt.NDArray[np.float64] | None:
    if not given:
        return None
    if "" in given:
        return np.full(discs.count, given[""])
    kinds = discs.kinds or [""] * discs.count
    for k, kind in enumerate(kinds):
        if kind not in given:
            discs.refuse(k, f"type {kind!r} has no {what}; try: --{what} {kind or 'TYPE'}=NUMBER")
    return np.array([given[kind] for kind in kinds])


def _complete(discs: Discs, choice: Choice) -> None:
    columns = discs.columns
    for what, given in (("radius", choice.radius), ("mass", choice.mass)):
        values = _of_kind(given, discs, what)
        if values is not None:
            columns[what] = values
    if "radius" not in columns:
        raise FileError(f"{discs.place}: has no radii; try: --radius NUMBER")
    columns.setdefault("mass", np.ones(discs.count))
    for what in ("radius", "mass"):
        discs.first(~(columns[what] > 0), f"the {what} must be greater than 0")
    columns["radius"] = columns["radius"] * (1 - choice.shrink)
    for axis in ("vx", "vy"):
        columns[axis] = columns.get(axis, np.zeros(discs.count)) * choice.time_step


def _box(discs: Discs, choice: Choice) -> Box:
    box = discs.box
    if choice.box is not None:
        box = Box(choice.box, (0.0, 0.0), (False, False) if box is None else box.periodic)
    if box is None:
        raise FileError(f"{discs.place}: has no box; try: --box LX LY")
    if not all(math.isfinite(edge) and edge > 0 for edge in box.size):
        raise FileError(f"{discs.place}: the box has edges {box.size[0]:g} and {box.size[1]:g}")
    if choice.origin == "centre":
        box.origin = (-box.size[0] / 2, -box.size[1] / 2)
    elif isinstance(choice.origin, tuple):
        box.origin = choice.origin
    if choice.periodic is not None:
        box.periodic = ("x" in choice.periodic, "y" in choice.periodic)
    return box


def _put_into_box(discs: Discs, choice: Choice) -> None:
    discs.box = box = _box(discs, choice)
    radius = discs.columns["radius"]
    for k, axis in enumerate("xy"):
        edge = box.size[k]
        given = discs.columns[axis]
        places = given - box.origin[k]
        if box.periodic[k]:
            outside = (places < 0) | (places >= edge)
            places = np.where(outside, np.mod(places, edge), places)
            places[places >= edge] = 0.0  # np.mod may round up to `edge`
            given = np.where(outside, places + box.origin[k], given)
        else:
            low, high = places < radius, places > edge - radius
            text = f"the disc is not inside the walls along {axis}, from {box.origin[k]:g} to "
            discs.first(
                low | high,
                f"{text}{box.origin[k] + edge:g}; try: --box, --origin, --periodic or --shrink",
            )
        discs.columns[axis] = given if choice.keep_origin else places
    if not choice.keep_origin:
        box.origin = (0.0, 0.0)


def _in_order(discs: Discs) -> Discs:
    """Discs by id, then by kind if there are few kinds. The first disc of a kind orders kinds."""
    if "id" in discs.columns:
        ids = discs.columns["id"]
        order = np.argsort(ids, kind="stable")
        repeated = np.flatnonzero(np.diff(ids[order]) == 0)
        if len(repeated) > 0:
            discs.refuse(int(order[repeated[0] + 1]), "another disc has the same id")
        discs = discs.taken(order)
    kinds = _kinds(discs)
    numbers: dict[object, int] = {}
    place = np.array([numbers.setdefault(kind, len(numbers)) for kind in kinds], dtype=np.int64)
    if len(numbers) > FEW_KINDS:
        return discs
    return discs.taken(np.argsort(place, kind="stable"))


def _kinds(discs: Discs) -> list[tuple[str, float, float]]:
    names = discs.kinds or [""] * discs.count
    return list(zip(names, discs.columns["radius"].tolist(), discs.columns["mass"].tolist()))


def _scene(discs: Discs, source: str) -> str:
    """The tables [box] and [discs] of a scene; `source` says where the discs are."""
    assert discs.box is not None
    size = discs.box.size
    text = f"[box]\nsize = [{float(size[0])!r}, {float(size[1])!r}]\n"
    x, y = (0.0 - float(corner) for corner in discs.box.origin)
    if (x, y) == (size[0] / 2, size[1] / 2):
        text += 'origin = "centre"\n'
    elif x != 0 or y != 0:
        text += f"origin = [{x!r}, {y!r}]\n"
    for is_periodic, sides in zip(discs.box.periodic, (("left", "right"), ("bottom", "top"))):
        if is_periodic:
            text += "".join(f'{side}.kind = "periodic"\n' for side in sides)
    text += f"\n[discs]\n{source}\nspecies = [\n"
    for (name, radius, mass), same in itertools.groupby(_kinds(discs)):
        text += f"    {{count = {len(list(same))}, radius = {radius!r}, mass = {mass!r}}},"
        text += f" # {name}\n" if re.fullmatch(r"[\w .+-]+", name) else "\n"
    return text + "]\n"


def import_discs(
    path: str | os.PathLike[str],
    output: str | os.PathLike[str],
    choice: Choice | None = None,
    *,
    program: str | os.PathLike[str] | None = None,
) -> Imported:
    """Write the discs of a frame as a checkpoint at step 0, which is replaced.

    Returns the tables [box] and [discs] of a scene that begins from it, with remarks. `discs.from`
    there is `output` as it was given. So the scene finds a relative path if the scene's file lies
    in the working folder of this call, or if its text is passed to `carrom.run` or
    `carrom.Simulation` from this folder. For a scene that will lie elsewhere give an absolute path.

    The program itself checks the discs and writes the file, so pairs that overlap are an error.
    Columns of rows whose names are not known are left out, with a `CarromWarning`.

    Raises:
        FileError: the file is wrong, or says too little
        InputError: the program refuses the discs
    """
    output = Path(output)
    refuse_owned(output, begins=(b"\x89HDF",))
    if output.exists() and Path(path).exists() and output.samefile(path):
        raise FileError(f"{output}: is the file to import; name another output")
    discs = _read_discs(path, choice)
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "scene.toml"
        columns = [discs.columns[name].tolist() for name in ("x", "y", "vx", "vy")]
        with open(Path(folder) / "discs.txt", "w", encoding="ascii") as file:
            for k, numbers in enumerate(zip(*columns)):
                file.write(f"{k} " + " ".join(map(repr, numbers)) + "\n")
        text = _scene(discs, 'file = "discs.txt"')
        scene.write_text(
            f'{text}\n[time]\nsteps = 0\nmethod = "event-driven"\n\n[output]\ntext = "none"\n',
            encoding="utf-8",
        )
        try:
            run(str(scene), folder=Path(folder) / "run", program=program, progress=False)
        except InputError as error:
            error.put_in_words(lambda line: _with_places(line, discs, folder))
            raise
        made = sorted((Path(folder) / "run" / "checkpoints").glob("checkpoint-*.h5"))
        part = output.with_name(output.name + ".part")
        shutil.copyfile(made[-1], part)
        part.replace(output)
    source = f"from = {toml_value(output)}"
    return Imported(_scene(discs, source), _remarks(discs))


def _remarks(discs: Discs) -> list[str]:
    if not np.any(discs.columns["vx"]) and not np.any(discs.columns["vy"]):
        return [f"{discs.place}: all velocities are 0, so nothing moves"]
    return []


def _with_places(line: str, discs: Discs, folder: str) -> str:
    """A message of the program, with lines of the file instead of numbers of discs."""
    line = re.sub(r"^\S*?(scene\.toml|discs\.txt)(:\d+)?", discs.place, line)

    def name(match: re.Match[str]) -> str:
        return " and ".join(_short(discs, int(number)) for number in match.groups())

    line = re.sub(r"\b(\d+) and (\d+)(?= \(by)", name, line)
    return line.replace(
        'method = "event-driven" needs discs that do not',
        "try: --shrink SHARE, which makes radii smaller, if roundings are the reason",
    )


def _short(discs: Discs, k: int) -> str:
    return f"disc {k}" if discs.lines is None else f"line {discs.lines[k]}"


__all__ = ["FORMATS", "Choice", "Imported", "import_discs", "read_discs"]
