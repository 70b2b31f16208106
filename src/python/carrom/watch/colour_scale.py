# SPDX-License-Identifier: BSD-3-Clause
"""The speed at the end of the scale of colours, the same in every window and for every step.

Colours of two steps can only be compared by eye if one speed has one colour throughout. So the
first frame of the run decides, whatever a window shows first.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from carrom.disc_arrays import Array
from carrom.errors import NoDataError
from carrom.frame import Frame

_FASTEST = 0.995  # share of discs that are slower than the end of the scale


class ColourScale:
    """Keeps the end of the scale once a frame has given it."""

    def __init__(self) -> None:
        """Know nothing yet."""
        self.clear()

    def clear(self) -> None:
        """Forget a run: another one has begun in its place."""
        self._top = 0.0
        self._n_at_rest = 0

    def top(self, frames: Sequence[Frame]) -> float:
        """Return the end of the scale: of the first frame in which discs move; 0 without one.

        Each frame is read at most once.
        """
        self._n_at_rest = min(self._n_at_rest, len(frames))
        while not self._top and self._n_at_rest < len(frames):
            self._top = _top_of(frames[self._n_at_rest])
            self._n_at_rest += 1
        return self._top


def speeds(velocities: Array) -> Array:
    """Return the speeds (n,) of velocities (n, 2) in the precision that the page draws."""
    wide = velocities.astype(np.float64)
    found: Array = np.sqrt(np.einsum("ij,ij->i", wide, wide)).astype(np.float32)
    return found


def _top_of(frame: Frame) -> float:
    try:
        found = speeds(frame.v[frame.present])
    except NoDataError:
        return 0.0
    if not len(found):
        return 0.0
    rank = min(len(found) - 1, int(_FASTEST * len(found)))
    return float(np.partition(found, rank)[rank]) or float(found.max())
