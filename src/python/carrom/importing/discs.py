# SPDX-License-Identifier: BSD-3-Clause
"""What a frame of another program's file has, and how its faults are named."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any, NoReturn

import numpy as np
import numpy.typing as npt

from carrom.errors import FileError

Array = npt.NDArray[np.float64]
MOST_DISCS = 2**32 - 2


@dataclasses.dataclass
class Box:
    """A rectangle: its edges, its lower left corner, and which pairs of sides are periodic."""

    size: tuple[float, float]
    origin: tuple[float, float] = (0.0, 0.0)
    periodic: tuple[bool, bool] = (True, True)


@dataclasses.dataclass
class Discs:
    """The discs of a frame, in the order of the file."""

    columns: dict[str, Array]  # x, y, z, vx, vy, vz, radius, mass, id
    kinds: list[str] | None = None  # the name of each disc's species
    box: Box | None = None
    lines: npt.NDArray[np.int64] | None = None  # where each disc stands
    place: str = ""  # the file, and also the frame if `lines` is None
    remarks: list[str] = dataclasses.field(default_factory=list)  # what was left out, as warnings

    @property
    def count(self) -> int:
        """The number of discs."""
        return len(self.columns["x"])

    def where(self, k: int) -> str:
        """Where disc `k` of the file stands, as `file:line`."""
        if self.lines is None:
            return f"{self.place}: disc {k}"
        return f"{self.place}:{self.lines[k]}"

    def refuse(self, k: int, text: str) -> NoReturn:
        """Raise an error about disc `k` of the file."""
        raise FileError(f"{self.where(k)}: {text}")

    def first(self, are_wrong: npt.ArrayLike, text: str) -> None:
        """Raise an error about the first disc for which `are_wrong` is true."""
        places = np.flatnonzero(are_wrong)
        if len(places) > 0:
            self.refuse(int(places[0]), text)

    def taken(self, order: npt.NDArray[np.int64]) -> Discs:
        """The discs in another order."""
        return dataclasses.replace(
            self,
            columns={name: column[order] for name, column in self.columns.items()},
            kinds=None if self.kinds is None else [self.kinds[k] for k in order],
            lines=None if self.lines is None else self.lines[order],
        )


# Names of columns in other programs, in lower case.
MEANING = {
    "x": "x", "y": "y", "z": "z", "xu": "x", "yu": "y", "zu": "z",
    "vx": "vx", "vy": "vy", "vz": "vz",
    "r": "radius", "radius": "radius", "radii": "radius", "c_radius": "radius",
    "d": "diameter", "diameter": "diameter", "sigma": "diameter",
    "m": "mass", "mass": "mass", "masses": "mass",
    "id": "id", "type": "kind", "species": "kind", "element": "kind", "step": "step",
}  # fmt: skip


def parse_rows(
    place: str, rows: Sequence[tuple[int, list[str]]], names: Sequence[str]
) -> tuple[dict[str, Array], list[str] | None, npt.NDArray[np.int64]]:
    """Read the columns that mean something from (line number, words) of each disc.

    Raises:
        FileError: a line has too few or too many words, or a word is no number
    """
    wanted = {MEANING.get(name.lower(), ""): k for k, name in enumerate(names)}
    wanted.pop("", None)
    kind = wanted.pop("kind", None)
    lines = np.array([line for line, _ in rows], dtype=np.int64)
    for line, words in rows:
        if len(words) != len(names):
            raise FileError(
                f"{place}:{line}: {len(words)} words, but a line has {len(names)}: "
                + " ".join(names)
            )
    columns: dict[str, Array] = {}
    for name, k in wanted.items():
        column = np.empty(len(rows))
        for i, (line, words) in enumerate(rows):
            try:
                column[i] = float(words[k])
            except ValueError:
                raise FileError(f"{place}:{line}: {words[k][:40]!r} is no number") from None
        columns[name] = column
    if "diameter" in columns:
        columns.setdefault("radius", columns.pop("diameter") / 2)
    return columns, None if kind is None else [words[kind] for _, words in rows], lines


def check_count(place: str, n: Any, n_bytes: int) -> int:
    """Return the number of discs that a header announces.

    Raises:
        FileError: it is none, or the file is too short for so many
    """
    try:
        count = int(n)
    except ValueError:
        raise FileError(f"{place}: {str(n)[:40]!r} is no number of discs") from None
    if not 0 < count <= MOST_DISCS:
        raise FileError(f"{place}: {count} discs; Carrom has 1 to {MOST_DISCS}")
    if 4 * count > n_bytes:  # `1 2\n` at least
        raise FileError(f"{place}: announces {count} discs, but the file has {n_bytes} bytes")
    return count
