# SPDX-License-Identifier: BSD-3-Clause
"""Messages of the program in Python's words: arguments and functions instead of options."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

_REPLACEMENTS = (
    (re.compile(r"carrom run -o (.+?) --resume"), r'carrom.resume("\1")'),
    (re.compile(r"--resume\b"), "carrom.resume(folder)"),
    (re.compile(r"--overwrite\b"), "overwrite=True"),
    (re.compile(r"--set (?=[A-Za-z_])"), ""),
    (re.compile(r"--(threads|steps|accuracy|check)\b"), r"\1"),
    (re.compile(r"^read_(\w+): "), r"\1: "),  # functions of the library
    (re.compile(r"^change_discs: "), "change: "),
    (re.compile(r"^(?:Simulation::change_discs|Session::agree_on): "), "change: "),
    (re.compile(r"^Simulation::advance_to: "), "run: "),
    (re.compile(r"^Simulation::write_checkpoint: "), "checkpoint: "),
    (re.compile(r"^Simulation::(\w+): "), r"\1: "),
)


def in_python(line: str) -> str:
    """Return a line of the program as a user of this package would write it."""
    for pattern, replacement in _REPLACEMENTS:
        line = pattern.sub(replacement, line)
    return line


_UNKNOWN_KEY = re.compile(r"no such key '([^']+)'; did you mean '([^']+)'\?")
_NO_TABLE = re.compile(r"^(?:.*: )?no such key '([^'.]+)'; keys stand in the tables .*")


def with_arguments(line: str, overrides: Mapping[str, Any], arguments: Iterable[str] = ()) -> str:
    """Return a line that names a key which does not exist as the argument that the caller meant.

    `overrides` are the caller's arguments by their keys, with dots; `arguments` are the other
    arguments of the function that was called.
    """

    def meant(match: re.Match[str]) -> str:
        if match[1] not in overrides:
            return match[0]
        argument = f"{match[2].replace('.', '__')}={overrides[match[1]]!r}"
        return f"no such key '{match[1]}'; did you mean {argument}?"

    def meant_argument(match: re.Match[str]) -> str:
        near = difflib.get_close_matches(match[1], list(arguments), 1)
        if match[1] not in overrides or not near:
            return match[0]
        return f"no argument {match[1]}; did you mean {near[0]}={overrides[match[1]]!r}?"

    return _NO_TABLE.sub(meant_argument, _UNKNOWN_KEY.sub(meant, line))


_PLACE = re.compile(r"scene\.toml(?::(\d+))?: (.*)", re.DOTALL)


def with_keys(line: str, keys: Sequence[str]) -> str:
    """Return a line about a scene that was a dictionary, with a key instead of a line of its text.

    `keys` are those of the lines of the text.
    """
    match = _PLACE.fullmatch(line)
    if match is None:
        return line
    number = int(match[1] or 0)
    key = keys[number - 1] if 0 < number <= len(keys) else ""
    return match[2] if not key or f"'{key}" in match[2] else f"{key}: {match[2]}"


def with_lines(line: str) -> str:
    """Return a line about a scene that was a text, of which no file exists."""
    match = _PLACE.fullmatch(line)
    if match is None:
        return line
    return f"line {match[1]} of the scene: {match[2]}" if match[1] else f"the scene: {match[2]}"
