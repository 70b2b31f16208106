# SPDX-License-Identifier: BSD-3-Clause
"""Lines of a text file in bounded memory, and frames of text that follow each other."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import IO, Any, NoReturn

from carrom.errors import FileError
from carrom.plain import open_plain

LONGEST_LINE = 1 << 16


class Lines:
    """The lines of a file, with their numbers. `name` stands in messages."""

    def __init__(self, path: str) -> None:
        self.name = path
        self.file: IO[Any] = open_plain(path)
        self.size = os.fstat(self.file.fileno()).st_size
        self.number = 0

    def __enter__(self) -> Lines:
        return self

    def __exit__(self, *_: object) -> None:
        self.file.close()

    def next(self) -> str | None:
        """The next line without its end, or None at the end of the file."""
        line = self.file.readline(LONGEST_LINE)
        if not line:
            return None
        self.number += 1
        if len(line) == LONGEST_LINE:
            self.refuse(f"a line of more than {LONGEST_LINE - 1} characters")
        text: str = line.decode("utf-8", errors="replace")
        return text.rstrip("\r\n")

    def need(self, what: str) -> str:
        """The next line, which must exist."""
        line = self.next()
        if line is None:
            self.refuse(f"the file ends before {what}")
        return line

    def refuse(self, text: str) -> NoReturn:
        """Raise an error about the last line."""
        raise FileError(f"{self.name}:{max(self.number, 1)}: {text}")

    def mark(self) -> tuple[int, int]:
        """The place, for `go_back`."""
        return self.file.tell(), self.number

    def go_back(self, mark: tuple[int, int]) -> None:
        """Go to a place."""
        self.file.seek(mark[0])
        self.number = mark[1]

    def take_rows(self, count: int, frame: int) -> list[tuple[int, list[str]]]:
        """The words of the next lines of discs."""
        rows = []
        for k in range(count):
            rows.append((0, self.need_disc(k, count, frame).split()))
            rows[-1] = (self.number, rows[-1][1])
        return rows

    def need_disc(self, k: int, count: int, frame: int) -> str:
        """The line of disc `k`."""
        line = self.next()
        if line is None:
            self.refuse(f"frame {frame} ends after {k} of {count} discs")
        return line


class TextFrames:
    """Frames that follow each other. `head` reads the begin of one up to its discs, and returns
    None at the end of the file; `body` reads its discs.
    """

    def __init__(self, lines: Lines, head: Callable[[Lines], Any]) -> None:
        self.lines, self.head = lines, head

    def find(self, frame: int | None, step: int | None) -> tuple[int, Any]:
        """Return the number of the frame, and its head; the lines stand at its discs.

        Without `frame` and `step` it is the last one. Negative frames count from the end.
        """
        marks: list[tuple[int, int]] = []
        steps: list[int | None] = []
        while True:
            mark = self.lines.mark()
            head = self.head(self.lines)
            if head is None:
                break
            number = len(marks)
            if number == frame or (step is not None and head.step == step):
                return number, head
            marks.append(mark)
            steps.append(head.step)
            for k in range(head.count):
                self.lines.need_disc(k, head.count, number)
        number = chosen(self.lines.name, len(marks), frame, step, steps)
        self.lines.go_back(marks[number])
        return number, self.head(self.lines)


def chosen(
    name: str, n_frames: int, frame: int | None, step: int | None, steps: list[int | None]
) -> int:
    """Return the number of the wanted frame.

    Raises:
        FileError: there is none
    """
    if n_frames == 0:
        raise FileError(f"{name}: has no frame")
    if step is not None:
        if step in steps:
            return steps.index(step)
        known = [str(one) for one in steps if one is not None]
        text = f"its steps are {', '.join(known[:5])}" if known else "its frames have no steps"
        raise FileError(f"{name}: has no frame of step {step}; {text}")
    number = -1 if frame is None else frame
    if not -n_frames <= number < n_frames:
        raise FileError(f"{name}: has no frame {frame}; frames are 0 to {n_frames - 1}")
    return number % n_frames
