# SPDX-License-Identifier: BSD-3-Clause
"""Messages of the program in Python's words: arguments and functions instead of options."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

_REPLACEMENTS = (
    (re.compile(r"carrom run -o (.+?) --resume"), r'carrom.resume("\1")'),
    (re.compile(r"--resume\b"), "carrom.resume(folder)"),
    (re.compile(r"--overwrite\b"), "overwrite=True"),
    (re.compile(r"--set (?=[A-Za-z_])"), ""),
    (re.compile(r"--(threads|steps|accuracy|check)\b"), r"\1"),
    (re.compile(r"^read_(\w+): "), r"\1: "),  # functions of the library
    (re.compile(r"^change_discs: "), "change: "),
)


def in_python(line: str) -> str:
    """Return a line of the program as a user of this package would write it."""
    for pattern, replacement in _REPLACEMENTS:
        line = pattern.sub(replacement, line)
    return line


_UNKNOWN_KEY = re.compile(r"no such key '([^']+)'; did you mean '([^']+)'\?")


def with_arguments(line: str, overrides: Mapping[str, Any]) -> str:
    """Return a line that names a key which does not exist as the argument that the caller meant.

    `overrides` are the caller's arguments by their keys, with dots.
    """

    def meant(match: re.Match[str]) -> str:
        if match[1] not in overrides:
            return match[0]
        argument = f"{match[2].replace('.', '__')}={overrides[match[1]]!r}"
        return f"no such key '{match[1]}'; did you mean {argument}?"

    return _UNKNOWN_KEY.sub(meant, line)
