# SPDX-License-Identifier: BSD-3-Clause
"""Parts that the functions of `carrom.melting` share."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any, Union

import numpy as np

from carrom.adapters import positions_of
from carrom.disc_arrays import Array, DiscArrays
from carrom.errors import NoDataError

Given = Union[DiscArrays, Iterable[DiscArrays]]

GROUPS = 8


def lattice_constant(frame: DiscArrays) -> float:
    """Return the distance of neighbours in a triangular lattice of as many discs a unit of area."""
    density = np.count_nonzero(frame.present) / float(np.prod(frame.box))
    return math.sqrt(2 / (math.sqrt(3) * density))


def listed(frames: Given, wanted_by: str) -> list[DiscArrays]:
    """Return frames as a list, or say why `wanted_by` cannot use them."""
    given = [frames] if isinstance(frames, DiscArrays) else list(frames)
    if not given:
        raise NoDataError(f"{wanted_by} needs at least one frame")
    if not all(all(frame.periodic) for frame in given):
        raise ValueError(f"{wanted_by}: the box must be periodic all round")
    positions_of(given[0], wanted_by)
    return given


def present(frame: DiscArrays) -> Array:
    """Return positions (n, 2) in the box, its upper edges excluded, as scipy wants them."""
    return np.mod(frame.x_from_corner[frame.present].astype(np.float64), frame.box)


def with_images(x: Array, box: Array, margin: float) -> Array:
    """Return discs in the box, and behind them their images up to `margin` beyond its sides."""
    shifts = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)]
    images = np.concatenate([x + np.array(shift) * box for shift in shifts])
    near = np.all((images >= -margin) & (images <= box + margin), axis=1)
    return np.concatenate([x, images[near]])


def jackknife(samples: Array, number: Callable[[Array], Any]) -> tuple[Any, Any]:
    """Return `number` of the mean over frames, and its error from leaving groups out in turn."""
    value = number(samples.mean(axis=0))
    if len(samples) < GROUPS:
        return value, np.full_like(value, np.nan)
    group = np.arange(len(samples)) * GROUPS // len(samples)
    others = np.array([number(samples[group != k].mean(axis=0)) for k in range(GROUPS)])
    error = np.sqrt((GROUPS - 1) * np.mean((others - others.mean(axis=0)) ** 2, axis=0))
    return value, error
