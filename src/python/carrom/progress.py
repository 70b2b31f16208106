# SPDX-License-Identifier: BSD-3-Clause
"""Progress of a run on a terminal or in a notebook."""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from html import escape
from typing import Any

_STEP = re.compile(r"step (\d+) of (\d+) ")
_SHARE = re.compile(r"(\d+) of (\d+)")

Show = Callable[[str], None]


def is_progress(line: str) -> bool:
    """Whether a line of the program says how far the run is."""
    return _STEP.match(line) is not None


def is_interactive() -> bool:
    """Whether somebody sees standard error: on a terminal or in a notebook."""
    return sys.stderr.isatty() or is_notebook()


def is_notebook() -> bool:
    """Whether this process is the kernel of a notebook."""
    return "ipykernel" in sys.modules


@contextmanager
def progress_display(wanted: bool | Callable[..., None] | None) -> Iterator[Show]:
    """Give a function that shows how far a run is, in a line like "step 3 of 10".

    A notebook shows a bar, a terminal a line. Both are wiped at the end.
    """
    if callable(wanted):
        yield _caller(wanted)
        return
    if wanted is None:
        wanted = is_interactive()
    if not wanted:
        yield lambda line: None
        return
    show, wipe = _bar() if is_notebook() else _line()
    try:
        yield show
    finally:
        wipe()


def _line() -> tuple[Show, Callable[[], None]]:
    """Show progress in one line of a terminal."""
    longest = 0

    def show(line: str) -> None:
        nonlocal longest
        longest = max(longest, len(line))
        print("\r" + line.ljust(longest), end="", file=sys.stderr, flush=True)

    def wipe() -> None:
        if longest:
            print("\r" + " " * longest + "\r", end="", file=sys.stderr, flush=True)

    return show, wipe


def _bar() -> tuple[Show, Callable[[], None]]:
    """Show progress as a bar below the cell of a notebook.

    It is made when there is something to show, because a loop of short runs would otherwise fill
    the notebook with empty outputs.
    """
    from IPython.display import HTML, display

    handles: list[Any] = []

    def show(line: str) -> None:
        if not handles:
            handles.append(display(HTML(""), display_id=True))
        handles[0].update(HTML(bar_html(line)))

    def wipe() -> None:
        for handle in handles:
            handle.update(HTML(""))

    return show, wipe


def bar_html(line: str) -> str:
    """Return a bar, as far as the line says, and the line beside it."""
    match = _SHARE.search(line)
    done, whole = (match[1], match[2]) if match else ("0", "1")
    return f'<progress value="{done}" max="{whole}"></progress> {escape(line)}'


def _caller(function: Callable[..., None]) -> Show:
    """Call a function with the step and the last step, and with the line if it takes three."""
    takes_line = _takes_three(function)

    def show(line: str) -> None:
        if match := _STEP.match(line):
            numbers = int(match[1]), int(match[2])
            function(*numbers, *([line] if takes_line else []))

    return show


def _takes_three(function: Callable[..., None]) -> bool:
    """Whether a function names a third argument; `*arguments` get two, as they always did."""
    try:
        parameters = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):
        return False
    kinds = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
    return sum(parameter.kind in kinds for parameter in parameters) >= 3


def show_end(wanted: object, steps: int) -> None:
    """Call a function that was given as `progress` once more, at the end of the last step."""
    if callable(wanted):
        _caller(wanted)(f"step {steps} of {steps} (100 %)")
