# SPDX-License-Identifier: BSD-3-Clause
"""Structured arrays with remarks, which `Table` shows and gives to other packages."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

_Columns = TypeVar("_Columns", bound="NamedColumns")


class NamedColumns(np.ndarray[Any, np.dtype[np.void]]):
    """A structured array: `table["g"]` is a column, `table[3]` a row.

    Attributes:
        remarks: what the program wrote about the table: samples, meaning, units
    """

    remarks: tuple[str, ...]

    def __new__(cls: type[_Columns], rows: npt.ArrayLike, remarks: Sequence[str] = ()) -> _Columns:
        """Take a structured array as it is."""
        table = np.asarray(rows).view(cls)
        if table.dtype.names is None:
            raise TypeError("a table has named columns")
        table.remarks = tuple(remarks)
        return table

    def __array_finalize__(self, source: object) -> None:
        self.remarks = getattr(source, "remarks", ())

    @classmethod
    def from_columns(
        cls: type[_Columns], columns: Mapping[str, npt.ArrayLike], remarks: Sequence[str] = ()
    ) -> _Columns:
        """Join columns of equal length."""
        arrays = {name: np.asarray(values) for name, values in columns.items()}
        length = len(next(iter(arrays.values()), np.empty(0)))
        rows = np.empty(length, dtype=[(name, array.dtype) for name, array in arrays.items()])
        for name, array in arrays.items():
            rows[name] = array
        return cls(rows, remarks)

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the columns."""
        return self.dtype.names or ()
