# SPDX-License-Identifier: BSD-3-Clause
"""Arrays that users give to a simulation, and arrays that it gives them."""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from carrom.disc_arrays import Array
from carrom.errors import CarromError, FileError, SceneError

if TYPE_CHECKING:
    from carrom import _core

_MARKS_OF_UNITS = ("to_value", "magnitude", "in_units")  # astropy, pint, unyt


def locked(array: Array) -> Array:
    """Return the array, which cannot be written to any more."""
    array.flags.writeable = False
    return array


def whole(what: str, value: Any) -> int:
    """Return a whole number; `what` begins the message for another one.

    Raises:
        TypeError: it is none
    """
    try:
        return operator.index(value)
    except TypeError:
        is_whole = isinstance(value, (float, np.floating)) and float(value).is_integer()
        advice = f"; try: {int(value)}" if is_whole else ""
        raise TypeError(f"{what}, not {value!r}{advice}") from None


def checked(name: str, unit: str, values: Any, shape: tuple[int, ...]) -> Array:
    """Return numbers as the extension takes them: float64 in rows.

    Raises:
        ValueError: another shape, masked elements, or a unit that nobody would convert
        TypeError: no real numbers
    """
    if values is None:
        raise TypeError(f"{name} are real numbers, not None")
    if any(hasattr(values, mark) for mark in _MARKS_OF_UNITS):
        raise ValueError(f"{name} are plain numbers in {unit}; take the unit off first")
    if np.ma.is_masked(values):
        raise ValueError(f"{name} have masked elements; every disc needs a number")
    try:
        array: npt.NDArray[Any] = np.asarray(values)
    except ValueError:
        raise ValueError(f"{name} have the shape {shape}, and rows of one length") from None
    if array.dtype.kind not in "biuf":
        raise TypeError(f"{name} are real numbers, not {array.dtype}")
    if array.shape != shape:
        raise ValueError(f"{name} have the shape {shape}, not {array.shape}")
    return np.ascontiguousarray(array, dtype=np.float64)


_KINDS: dict[str, Callable[[str], Exception]] = {
    "TypeError": TypeError,
    "ValueError": ValueError,
    "FileError": FileError,
    "SceneError": lambda text: SceneError([text], 2),
}
_OF_A_RANK = re.compile(rf"rank (\d+): ({'|'.join(_KINDS)}): (.*)", re.DOTALL)


@contextmanager
def agreed(core: _core.Core) -> Iterator[None]:
    """Check arguments of a call that all ranks make. Collective.

    If the checks of a rank fail, all ranks raise the error of the first such rank. Otherwise ranks
    without an error would wait in the next call for the one that has left it.

    Raises:
        TypeError, ValueError, FileError, SceneError: as on that rank
        SceneError: ranks make different calls
    """
    error: Exception | None = None
    try:
        yield
    except (TypeError, ValueError, FileError) as found:  # SceneError is a ValueError
        if core.ranks == 1:
            raise
        error = found
    if core.ranks == 1:
        return
    try:
        core.agree_on([] if error is None else [f"{type(error).__name__}: {error}"])
    except SceneError as found:
        match = _OF_A_RANK.fullmatch(found.lines[0])
        if match is None:
            raise
        raise of_rank(int(match[1]), match[2], match[3]) from error


def of_rank(rank: int, kind: str, text: str) -> Exception:
    """Return an error of another rank, of the same kind if that is an error of arguments."""
    return _KINDS.get(kind, CarromError)(f"{text} (on rank {rank})")
