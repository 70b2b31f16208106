# SPDX-License-Identifier: BSD-3-Clause
"""Errors of the package. Each exit code of the program has a class of its own."""

from __future__ import annotations

from collections.abc import Callable, Sequence


class CarromError(Exception):
    """Any error of this package."""


class ProgramNotFoundError(CarromError):
    """The program `carrom` (or the MPI launcher) is not on this machine."""


class MissingPackageError(CarromError, ImportError):
    """A Python package that a function needs is not installed."""


class FileError(CarromError):
    """A file or folder is not what it should be: absent, damaged, of another kind, or not whole."""


class NoDataError(CarromError, LookupError):
    """A run has not written what is asked for, or has not written it yet."""


class ProgramError(CarromError):
    """The program ended with an exit code other than 0.

    Attributes:
        returncode: the exit code; negative for a signal, as in `subprocess`
        lines: what the program printed to standard error, line by line, in Python's words
        command: the words of the command line
    """

    def __init__(self, lines: Sequence[str], returncode: int, command: Sequence[str] = ()) -> None:
        """Keep the program's words. `str()` of the error is all of its lines."""
        self.lines = list(lines)
        self.returncode = returncode
        self.command = list(command)
        super().__init__(self._text())

    def _text(self) -> str:
        return "\n".join(self.lines) or f"carrom ended with exit code {self.returncode}"

    def put_in_words(self, words_of: Callable[[str], str]) -> None:
        """Replace each line by what `words_of` makes of it."""
        self.lines = [words_of(line) for line in self.lines]
        self.args = (self._text(),)

    def __reduce__(self) -> tuple[object, ...]:
        """Let the error cross process boundaries."""
        return type(self), (self.lines, self.returncode, self.command)


class InputError(ProgramError, ValueError):
    """Exit code 2: the scene, a file or an option is wrong. Nothing was computed or written."""


class SceneError(InputError):
    """A scene, an array or an argument of `carrom.Simulation` is wrong. Nothing was changed."""


class CollectiveError(ProgramError):
    """Exit code 3: an operation of all ranks failed, or memory ran out."""


class OutputError(ProgramError):
    """Exit code 4: output could not be written, for example on a full disk."""


class InvariantError(ProgramError):
    """Exit code 70: a check found a broken invariant, or the program is wrong."""


class StoppedError(ProgramError):
    """Exit code 75: the run was told to stop. Its checkpoint lets `carrom.resume` go on."""


ERROR_OF_CODE: dict[int, type[ProgramError]] = {
    2: InputError,
    3: CollectiveError,
    4: OutputError,
    70: InvariantError,
    75: StoppedError,
}
