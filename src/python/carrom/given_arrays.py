# SPDX-License-Identifier: BSD-3-Clause
"""Arrays that users give to a simulation, and arrays that it gives them."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from carrom.disc_arrays import Array

_MARKS_OF_UNITS = ("to_value", "magnitude", "in_units")  # astropy, pint, unyt


def locked(array: Array) -> Array:
    """Return the array, which cannot be written to any more."""
    array.flags.writeable = False
    return array


def checked(name: str, unit: str, values: Any, shape: tuple[int, ...]) -> Array | None:
    """Return numbers as the extension takes them: float64 in rows.

    Raises:
        ValueError: another shape, masked elements, or a unit that nobody would convert
        TypeError: no real numbers
    """
    if values is None:
        return None
    if any(hasattr(values, mark) for mark in _MARKS_OF_UNITS):
        raise ValueError(f"{name} are plain numbers in {unit}; take the unit off first")
    if np.ma.is_masked(values):
        raise ValueError(f"{name} have masked elements; every disc needs a number")
    array: npt.NDArray[Any] = np.asarray(values)
    if array.dtype.kind not in "biuf":
        raise TypeError(f"{name} are real numbers, not {array.dtype}")
    if array.shape != shape:
        raise ValueError(f"{name} have the shape {shape}, not {array.shape}")
    return np.ascontiguousarray(array, dtype=np.float64)
