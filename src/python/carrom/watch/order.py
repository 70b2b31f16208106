# SPDX-License-Identifier: BSD-3-Clause
"""The hexatic order parameter psi6, with numpy alone."""

from __future__ import annotations

import numpy as np

from carrom.disc_arrays import Array

NEIGHBOURS = 6
_AT_A_TIME = 8192


def hexatic_order(x: Array, periods: Array) -> Array:
    """Return psi6 of each disc, complex (N,): the mean of exp(6 i angle) over six neighbours.

    The neighbours are the six nearest centres. `x` is (N, 2); `periods` is (2,), lengths, 0 for
    sides that are not periodic. Fewer than seven discs have psi6 = 0.

    Centres are sorted into square cells of some two discs. A disc searches rings of cells until
    its sixth neighbour is nearer than any cell beyond. Costs some 5 us a disc.
    """
    n = len(x)
    result = np.zeros(n, dtype=complex)
    if n <= NEIGHBOURS:
        return result
    cells = _Cells(x, periods)
    todo, rings = np.arange(n), 1
    while len(todo):
        left = []
        for begin in range(0, len(todo), _AT_A_TIME):
            some = todo[begin : begin + _AT_A_TIME]
            result[some], is_sure = cells.order_of(some, rings)
            left.append(some[~is_sure])
        todo, rings = np.concatenate(left), rings + 1
    return result


class _Cells:
    """Centres by cells; a table with a row for each cell, filled with -1."""

    def __init__(self, x: Array, periods: Array) -> None:
        self.x = x
        self.periods = periods
        low = np.where(periods > 0, 0.0, x.min(axis=0))
        span = np.where(periods > 0, periods, np.ptp(x, axis=0))
        span = np.maximum(span, 1e-9 * max(span.max(), 1e-300))
        width = float(np.sqrt(span[0] * span[1] * 2 / len(x)))
        self.shape = np.maximum((span / max(width, span.max() / 2000)).astype(int), 1)
        self.width = span / self.shape
        place = ((x - low) / self.width).astype(int)
        self.place = np.clip(place, 0, self.shape - 1)
        number = self.place[:, 0] * self.shape[1] + self.place[:, 1]
        order = np.argsort(number, kind="stable")
        counts = np.bincount(number, minlength=int(self.shape.prod()))
        first = np.cumsum(counts) - counts
        self.table = np.full((len(counts) + 1, int(counts.max())), -1)  # the last row means no cell
        self.table[number[order], np.arange(len(x)) - first[number[order]]] = order

    def order_of(self, some: Array, rings: int) -> tuple[Array, Array]:
        """Return psi6 of some discs from so many rings, and whether no nearer disc is beyond."""
        others = self._candidates(some, rings)
        apart = self.x[others] - self.x[some][:, None]
        for axis in (0, 1):
            if self.periods[axis] > 0:
                period = self.periods[axis]
                apart[:, :, axis] -= period * np.round(apart[:, :, axis] / period)
        squares = np.einsum("ijk,ijk->ij", apart, apart)
        squares[(others < 0) | (others == some[:, None])] = np.inf
        nearest = np.argpartition(squares, NEIGHBOURS - 1, axis=1)[:, :NEIGHBOURS]
        found = np.take_along_axis(squares, nearest, axis=1)
        is_whole = bool(np.all(2 * rings + 1 >= self.shape))
        is_sure = is_whole | (found.max(axis=1) <= (rings * self.width.min()) ** 2)
        vectors = np.take_along_axis(apart, nearest[:, :, None], axis=1)
        angles = np.arctan2(vectors[:, :, 1], vectors[:, :, 0])
        return np.where(np.isfinite(found), np.exp(6j * angles), 0).mean(axis=1), is_sure

    def _candidates(self, some: Array, rings: int) -> Array:
        """Ids of the discs in the cells around, each cell once; -1 fills up."""
        near = []
        for axis in (0, 1):
            steps = np.arange(-rings, rings + 1)
            cells = self.place[some, axis][:, None] + steps
            if self.periods[axis] > 0:
                if len(steps) > self.shape[axis]:
                    cells = np.broadcast_to(
                        np.arange(self.shape[axis]), (len(some), self.shape[axis])
                    )
                near.append(cells % self.shape[axis])
            else:
                near.append(np.where((cells < 0) | (cells >= self.shape[axis]), -1, cells))
        numbers = near[0][:, :, None] * self.shape[1] + near[1][:, None, :]
        numbers = np.where((near[0][:, :, None] < 0) | (near[1][:, None, :] < 0), -1, numbers)
        return self.table[numbers.reshape(len(some), -1)].reshape(len(some), -1)
