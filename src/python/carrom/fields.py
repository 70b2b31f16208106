# SPDX-License-Identifier: BSD-3-Clause
"""Tables of `"profiles"` as arrays over blocks, rows and columns of the grid."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carrom.errors import NoDataError

if TYPE_CHECKING:
    from carrom.disc_arrays import Array
    from carrom.named_columns import NamedColumns

_PLACES = ("to_step", "x", "y")


def is_grid(names: tuple[str, ...]) -> bool:
    """Whether a table with these columns has a row for each cell of a grid and block."""
    return names[:3] == _PLACES


class Fields:
    """A table of profiles, taken apart.

    Attributes:
        steps: last steps of the blocks, (B,)
        shape: rows and columns of the grid
        x: centres of the columns, (B, columns); they move with the box
        y: centres of the rows, (B, rows)
    """

    def __init__(self, table: NamedColumns) -> None:
        """Take the table of one species or of all."""
        if not is_grid(table.columns):
            raise NoDataError("the table has no grid; take one of those that profiles write")
        self._table = table
        steps = np.asarray(table["to_step"])
        self.steps: Array = np.unique(steps)
        self.n_blocks = len(self.steps)
        per_block = len(table) // max(self.n_blocks, 1)
        y = np.asarray(table["y"])[:per_block]
        n_rows = len(np.unique(y))
        self.shape = (n_rows, per_block // max(n_rows, 1))
        self.x: Array = self._grid("x")[:, 0, :] if self.n_blocks else np.empty((0, 0))
        self.y: Array = self._grid("y")[:, :, 0] if self.n_blocks else np.empty((0, 0))

    @property
    def is_map(self) -> bool:
        """Whether the grid has several rows and several columns."""
        return min(self.shape) > 1

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the fields."""
        return (*self._table.columns[3:], "pressure")

    def values(self, name: str) -> Array:
        """Return a field, (B, rows, columns)."""
        if name == "pressure":
            parts = ("xx", "yy", "contact_xx", "contact_yy")
            total: Array = np.sum([self._grid(part) for part in parts], axis=0) / 2
            return total
        if name not in self.names:
            raise NoDataError(f"profiles have no field {name!r}; they have {', '.join(self.names)}")
        return self._grid(name)

    def block_of(self, step: int | None) -> int:
        """Return the number of the block that ends with a step; the last one for None."""
        if step is None:
            return self.n_blocks - 1
        found = np.flatnonzero(self.steps == step)
        if len(found) == 0:
            ends = ", ".join(f"{one:.0f}" for one in self.steps)
            raise NoDataError(f"no block of profiles ends with step {step}; blocks end with {ends}")
        return int(found[0])

    def _grid(self, name: str) -> Array:
        return np.asarray(self._table[name]).reshape(self.n_blocks, *self.shape)
