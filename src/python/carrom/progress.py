# SPDX-License-Identifier: BSD-3-Clause
"""Progress of a run on a terminal or in a notebook."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

_STEP = re.compile(r"step (\d+) of (\d+) ")

Show = Callable[[str], None]


def is_progress(line: str) -> bool:
    """Whether a line of the program says how far the run is."""
    return _STEP.match(line) is not None


def is_interactive() -> bool:
    """Whether somebody sees standard error: on a terminal or in a notebook."""
    return sys.stderr.isatty() or "ipykernel" in sys.modules


@contextmanager
def progress_display(wanted: bool | Callable[[int, int], None] | None) -> Iterator[Show]:
    """Give a function that shows a line of progress. The line is wiped at the end."""
    if callable(wanted):
        yield _caller(wanted)
        return
    if wanted is None:
        wanted = is_interactive()
    if not wanted:
        yield lambda line: None
        return
    longest = 0

    def show(line: str) -> None:
        nonlocal longest
        longest = max(longest, len(line))
        print("\r" + line.ljust(longest), end="", file=sys.stderr, flush=True)

    try:
        yield show
    finally:
        if longest:
            print("\r" + " " * longest + "\r", end="", file=sys.stderr, flush=True)


def _caller(function: Callable[[int, int], None]) -> Show:
    def show(line: str) -> None:
        if match := _STEP.match(line):
            function(int(match[1]), int(match[2]))

    return show
