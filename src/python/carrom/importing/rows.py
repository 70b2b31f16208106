# SPDX-License-Identifier: BSD-3-Clause
"""Rows of numbers: CSV with named columns, plain rows `x y vx vy r m` of teaching programs, and the
lines `step id x y vx vy` of Carrom and of the course.
"""

from __future__ import annotations

import re

from carrom.errors import FileError
from carrom.importing.discs import MEANING, Discs, parse_rows
from carrom.importing.lines import Lines, chosen

MOST_BYTES = 2 << 30  # rows of all frames are in memory at once
_TEACHING = ["x", "y", "vx", "vy", "r", "m"]
_PLAIN = {count: _TEACHING[:count] for count in (2, 3, 4, 5, 6)} | {3: ["x", "y", "r"]}
_COURSE = ["step", "id", "x", "y", "vx", "vy"]
# Columns of `carrom convert --to csv` that no scene takes, because its counts begin at 0.
_COUNTS = {"pair_collisions", "wall_collisions", "image_x", "image_y"}

Row = tuple[int, list[str]]


def words_of(line: str) -> list[str]:
    """Split a row at commas, semicolons and blanks; `#` begins a comment."""
    return re.split(r"\s*[,;]\s*|\s+", line.split("#")[0].strip(" \t\r\n,;"))


def names_in(words: list[str]) -> bool:
    """Whether the words name columns, among them x and y."""
    return {"x", "y"} <= {MEANING.get(word.lower(), "") for word in words}


def _all_rows(path: str) -> tuple[int, list[str] | None, list[Row]]:
    """Return the line and the names of the columns, if the file has them, and the rows."""
    line_of_names = 0
    names: list[str] | None = None
    rows: list[Row] = []
    with Lines(path) as lines:
        if lines.size > MOST_BYTES:
            raise FileError(
                f"{path}: has {lines.size / 1e9:.3g} GB; rows are read up to "
                f"{MOST_BYTES / 1e9:.3g} GB; try: a file with one frame"
            )
        while (line := lines.next()) is not None:
            line = line.lstrip("\ufeff")
            if not rows and names is None and names_in(words_of(line.lstrip("# "))):
                names = words_of(line.lstrip("# "))
                line_of_names = lines.number
                continue
            words = words_of(line)
            if words != [""]:
                rows.append((lines.number, words))
    if not rows:
        raise FileError(f"{path}: has no rows of discs")
    return line_of_names, names, rows


def _remarks(path: str, line: int, names: list[str] | None) -> list[str]:
    """Name the columns that are left out because their names are not known."""
    unknown = [
        name for name in names or [] if name.lower() not in MEANING and name.lower() not in _COUNTS
    ]
    if not unknown:
        return []
    which = "column" if len(unknown) == 1 else "columns"
    return [
        f"{path}:{line}: {which} {', '.join(map(repr, unknown))} left out, because only these "
        f"names are known: {', '.join(MEANING)}"
    ]


def _are_of_course(rows: list[Row]) -> bool:
    """Whether rows begin with a step and ids from 0 on."""
    first = rows[: min(3, len(rows))]
    same = first[0][1][0]
    return len(first[0][1]) in (6, 8) and all(
        words[0] == same and words[0].isdigit() and words[1:2] == [str(k)]
        for k, (_, words) in enumerate(first)
    )


def _frames(path: str, rows: list[Row], place: int) -> list[tuple[int, list[Row]]]:
    """Group rows by the word at `place`, the step."""
    frames: dict[int, list[Row]] = {}
    for line, words in rows:
        try:
            step = int(words[place])
        except (ValueError, IndexError):
            raise FileError(f"{path}:{line}: has no whole number as the step") from None
        frames.setdefault(step, []).append((line, words))
    return list(frames.items())


def read_rows(path: str, frame: int | None, step: int | None) -> Discs:
    """Read a frame of rows. A column `step` makes frames."""
    line, names, rows = _all_rows(path)
    remarks = _remarks(path, line, names)
    is_of_course = names is None and _are_of_course(rows)
    if is_of_course:
        names = _COURSE
        rows = [(line, words[:6] if len(words) == 8 else words) for line, words in rows]
    if names is None:
        names = _PLAIN.get(len(rows[0][1]))
        if names is None:
            raise FileError(
                f"{path}:{rows[0][0]}: {len(rows[0][1])} numbers without names; rows are "
                "`x y vx vy r m`, or begin from the left with fewer; try: a first line with names"
            )
    places = [k for k, name in enumerate(names) if MEANING.get(name.lower()) == "step"]
    if places:
        frames = _frames(path, rows, places[0])
        steps: list[int | None] = [number for number, _ in frames]
        rows = frames[chosen(path, len(frames), frame, step, steps)][1]
    else:
        chosen(path, 1, frame, step, [None])
    columns, kinds, lines = parse_rows(path, rows, names)
    columns.pop("step", None)
    return Discs(columns, kinds, None, lines, path, remarks)
