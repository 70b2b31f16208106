# SPDX-License-Identifier: BSD-3-Clause
"""What each rank of a large cluster would do in a window: arithmetic on counted figures.

A gas has a density of 1 where it is densest, so that the mean distance of its discs is the unit of
length there. Its discs lie in rectangles of even density. The box is cut into columns, which are
the program's strips, and columns into rows, by counts of discs or by work. A rank gets the discs of
all others that lie within `depth` of its own rectangle.
"""

import bisect
import itertools
import math
from typing import NamedTuple

DISC_BYTES, HISTORY_BYTES = 64, 8
WORK_OF_DISC = 0.14  # work for each disc of a block or its halo; a collision is 1
WORTH_A_GROUP, LEAST_SAVED = 0.95, 600  # src/domain/domains.cpp
DISCS_IN_CACHE = 24_000  # in a block with its halo (src/event_driven/block_window.cpp)


class Rectangle(NamedTuple):
    x_low: float
    x_high: float
    y_low: float
    y_high: float

    @property
    def area(self):
        return max(0.0, self.x_high - self.x_low) * max(0.0, self.y_high - self.y_low)

    def within(self, other):
        return Rectangle(
            max(self.x_low, other.x_low),
            min(self.x_high, other.x_high),
            max(self.y_low, other.y_low),
            min(self.y_high, other.y_high),
        )

    def widened(self, by):
        return Rectangle(self.x_low - by, self.x_high + by, self.y_low - by, self.y_high + by)


class Piece(NamedTuple):
    """A part of the box in which the density is even."""

    rectangle: Rectangle
    density: float

    def discs_in(self, rectangle):
        return self.density * self.rectangle.within(rectangle).area


class Window(NamedTuple):
    """Of the event-driven method, as counted."""

    collisions: float  # collisions per disc where the density is 1
    reach: float  # in mean distances of discs where the density is 1
    halo: int  # depth of a block's halo in reaches

    @property
    def depth(self):
        """Of a halo, in mean distances of discs where the density is 1."""
        return self.reach * self.halo


def even_gas(n_discs):
    side = math.sqrt(n_discs)
    return [Piece(Rectangle(0, side, 0, side), 1.0)]


def half_crowded_gas(n_discs):
    """Half of the discs lie in a corner that is one hundredth of the box."""
    corner = math.sqrt(n_discs / 2)
    box = 10 * corner
    thin = n_discs / 2 / (box * box - corner * corner)
    return [
        Piece(Rectangle(0, corner, 0, corner), 1.0),
        Piece(Rectangle(0, corner, corner, box), thin),
        Piece(Rectangle(corner, box, 0, box), thin),
    ]


def box_of(gas):
    return Rectangle(
        0, max(p.rectangle.x_high for p in gas), 0, max(p.rectangle.y_high for p in gas)
    )


def weight_of(piece, by_work, window):
    """Of a disc."""
    return WORK_OF_DISC + window.collisions * piece.density if by_work else 1.0


def cuts(parts, n):
    """Cuts an axis into n parts of equal weight. Each of `parts` is (low, high, weight)."""
    edges = sorted({edge for low, high, _ in parts for edge in (low, high)})
    sums = [0.0]
    for low, high in itertools.pairwise(edges):
        sums.append(
            sums[-1]
            + sum(
                weight * (high - low) / (to - since)
                for since, to, weight in parts
                if since <= low and high <= to
            )
        )
    found = [edges[0]]
    for k in range(1, n):
        wanted = sums[-1] * k / n
        i = min(max(1, bisect.bisect_left(sums, wanted)), len(edges) - 1)
        share = (wanted - sums[i - 1]) / (sums[i] - sums[i - 1])
        found.append(edges[i - 1] + share * (edges[i] - edges[i - 1]))
    return [*found, edges[-1]]


class Cut(NamedTuple):
    x: list  # edges of columns
    y: list  # edges of the rows of each column

    def rectangles(self):
        return [
            Rectangle(self.x[i], self.x[i + 1], rows[k], rows[k + 1])
            for i, rows in enumerate(self.y)
            for k in range(len(rows) - 1)
        ]


def cut_box(gas, n_ranks, n_rows, by_work, window):
    box = box_of(gas)

    def weight(piece, rectangle):
        return weight_of(piece, by_work, window) * piece.discs_in(rectangle)

    x = cuts(
        [(p.rectangle.x_low, p.rectangle.x_high, weight(p, p.rectangle)) for p in gas],
        n_ranks // n_rows,
    )
    y = []
    for low, high in itertools.pairwise(x):
        column = Rectangle(low, high, box.y_low, box.y_high)
        y.append(
            cuts([(p.rectangle.y_low, p.rectangle.y_high, weight(p, column)) for p in gas], n_rows)
            if n_rows > 1
            else [box.y_low, box.y_high]
        )
    return Cut(x, y)


def rows_of(n_discs, n_ranks, depth):
    """Ranks that share a strip: a power of two, otherwise by the program's rule (choose_groups in
    src/domain/domains.cpp). `depth` is that of halos in mean distances of discs.
    """
    side = math.sqrt(n_discs)

    def seen(rows):
        return math.prod(min(1 + 2 * depth * (n - 1) / side, n) for n in (n_ranks // rows, rows))

    rows = min((2**k for k in range(n_ranks.bit_length())), key=seen)
    saved = (seen(1) - seen(rows)) * n_discs / n_ranks
    return rows if seen(rows) < WORTH_A_GROUP * seen(1) and saved >= LEAST_SAVED else 1


def halos(gas, cut, depth):
    """For each rank, {other rank: discs that the rank gets from it}."""
    found = []
    first_rank = [0, *itertools.accumulate(len(rows) - 1 for rows in cut.y)]
    for own_column, rows in enumerate(cut.y):
        for own_row in range(len(rows) - 1):
            own = Rectangle(
                cut.x[own_column], cut.x[own_column + 1], rows[own_row], rows[own_row + 1]
            )
            seen = own.widened(depth)
            gets = {}
            for i in range(
                max(0, bisect.bisect_right(cut.x, seen.x_low) - 1),
                min(len(cut.y), bisect.bisect_left(cut.x, seen.x_high)),
            ):
                of_column = cut.y[i]
                for k in range(
                    max(0, bisect.bisect_right(of_column, seen.y_low) - 1),
                    min(len(of_column) - 1, bisect.bisect_left(of_column, seen.y_high)),
                ):
                    if (i, k) == (own_column, own_row):
                        continue
                    other = Rectangle(cut.x[i], cut.x[i + 1], of_column[k], of_column[k + 1])
                    n = sum(p.discs_in(other.within(seen)) for p in gas)
                    gets[first_rank[i] + k] = n
            found.append(gets)
    return found


class Blocks(NamedTuple):
    """The blocks of a rank, all of them together."""

    n_own: float  # discs
    n_blocks: float
    seen: float  # discs in the first runs, halos included
    collisions: float  # collisions of own discs
    work: float  # work of first runs; a collision is 1
    borders: float  # total length in mean distances of discs; shared borders count once
    repeated_work: float  # work of a block's repeated run


def blocks_of(gas, own, window):
    """A block is as large as the cache allows with its halo."""
    box = box_of(gas)
    halo = window.depth
    n_own = n_blocks = seen = collisions = work = borders = most_repeated = 0.0
    for piece in gas:
        part = piece.rectangle.within(own)
        if part.area <= 0:
            continue
        side = math.sqrt(DISCS_IN_CACHE / piece.density) - 2 * halo
        if side > box.y_high:
            side = DISCS_IN_CACHE / piece.density / box.y_high - 2 * halo
        side = max(side, 1.5 * halo)
        n_x = math.ceil((part.x_high - part.x_low) / side)
        n_y = math.ceil((part.y_high - part.y_low) / side)
        width, height = (part.x_high - part.x_low) / n_x, (part.y_high - part.y_low) / n_y

        def seen_along(length, n, low_wall, high_wall, by):
            return length + by * (2 - (low_wall + high_wall) / n)

        def area(by):
            return seen_along(
                width, n_x, part.x_low <= box.x_low, part.x_high >= box.x_high, by
            ) * seen_along(height, n_y, part.y_low <= box.y_low, part.y_high >= box.y_high, by)

        per_disc = WORK_OF_DISC + window.collisions * piece.density
        n_own += piece.density * part.area
        n_blocks += n_x * n_y
        seen += n_x * n_y * piece.density * area(halo)
        collisions += window.collisions * piece.density * piece.density * part.area
        # Collisions carry changes across borders, so borders are weighted with the rate of
        # collisions beside them.
        borders += n_x * n_y * (width + height) * math.sqrt(piece.density) * piece.density
        work += n_x * n_y * piece.density * area(halo) * per_disc
        most_repeated = max(most_repeated, piece.density * area(2 * halo) * per_disc)
    return Blocks(n_own, n_blocks, seen, collisions, work, borders, most_repeated)
