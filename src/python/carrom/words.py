# SPDX-License-Identifier: BSD-3-Clause
"""Messages of the program in Python's words: arguments and functions instead of options."""

from __future__ import annotations

import re

_REPLACEMENTS = (
    (re.compile(r"carrom run -o (.+?) --resume"), r'carrom.resume("\1")'),
    (re.compile(r"--resume\b"), "carrom.resume(folder)"),
    (re.compile(r"--overwrite\b"), "overwrite=True"),
    (re.compile(r"--set (?=[A-Za-z_])"), ""),
    (re.compile(r"--(threads|steps|accuracy|check)\b"), r"\1"),
)


def in_python(line: str) -> str:
    """Return a line of the program as a user of this package would write it."""
    for pattern, replacement in _REPLACEMENTS:
        line = pattern.sub(replacement, line)
    return line
