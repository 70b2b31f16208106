# SPDX-License-Identifier: BSD-3-Clause
"""Tables of numbers with named columns."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from carrom import display, labelled
from carrom.errors import FileError, NoDataError
from carrom.named_columns import NamedColumns
from carrom.plain import read_text

if TYPE_CHECKING:
    import pandas
    import xarray

_WHOLE = ("count", "neighbours", "pairs", "steps", "step", "collisions")


class Table(NamedColumns):
    """A structured array: `table["g"]` is a column, `table[3]` a row.

    Attributes:
        remarks: what the program wrote about the table: samples, meaning, units
    """

    def to_pandas(self) -> pandas.DataFrame:
        """Return the table as a pandas DataFrame; remarks go to its `attrs`."""
        return labelled.table_to_pandas(self)

    def to_xarray(self) -> xarray.Dataset:
        """Return the table as an xarray Dataset with the dimension `row`."""
        return labelled.table_to_xarray(self)

    def _ipython_key_completions_(self) -> list[str]:
        return list(self.columns)

    def _repr_html_(self) -> str | None:
        if self.dtype.names is None or self.ndim != 1:
            return None  # a column is shown as any array
        return display.rows("table", self.columns, self.tolist())


def is_whole(name: str) -> bool:
    """Whether a column of the program's tables holds whole numbers."""
    words = name.split("_")
    return words[-1] in _WHOLE or words[0] == "pairs"


def read_csv(path: str | os.PathLike[str]) -> Table:
    """Read a table that the program wrote: CSV with remarks behind `#`. Numbers keep every bit.

    Columns of counts and steps become int64, all others float64.
    """
    try:
        lines = read_text(path).splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise FileError(f"{path}: cannot be read: {error}") from None
    remarks = [line[1:].strip() for line in lines if line.startswith("#")]
    rows = [line.split(",") for line in lines if line and not line.startswith("#")]
    names = rows[0] if rows else []
    if not names or any(len(row) != len(names) for row in rows):
        raise FileError(f"{path}: is no table: rows have different lengths, or there are none")
    dtype = [(name, np.int64 if is_whole(name) else np.float64) for name in names]
    try:
        values = [
            tuple(int(word) if kind is np.int64 else float(word) for (_, kind), word in zipped)
            for zipped in (zip(dtype, row) for row in rows[1:])
        ]
    except ValueError as error:
        raise FileError(f"{path}: is no table of numbers: {error}") from None
    return Table(np.array(values, dtype=dtype), remarks)


class Tables(Mapping[str, Table]):
    """The tables of a folder, by name: `run.tables["radial_distribution"]`. Read at each access."""

    def __init__(self, folder: Path | None, owner: str) -> None:
        """Search a folder, or none; `owner` is whose tables these are, for messages."""
        self._folder = folder
        self._owner = owner

    def _paths(self) -> dict[str, Path]:
        if self._folder is None or not self._folder.is_dir():
            return {}
        return {path.stem: path for path in sorted(self._folder.glob("*.csv"))}

    def __getitem__(self, name: str) -> Table:
        paths = self._paths()
        if name not in paths:
            known = ", ".join(paths) or "none yet"
            raise _NoTableError(
                f"{self._owner} has no table {name!r}; it has {known}. "
                "output.measurements.quantities of the scene says what is measured"
            )
        return read_csv(paths[name])

    def __iter__(self) -> Iterator[str]:
        return iter(self._paths())

    def __len__(self) -> int:
        return len(self._paths())

    def to_pandas(self) -> dict[str, pandas.DataFrame]:
        """Return all tables as pandas DataFrames, by name."""
        return {name: table.to_pandas() for name, table in self.items()}

    def to_xarray(self) -> dict[str, xarray.Dataset]:
        """Return all tables as xarray Datasets, by name."""
        return {name: table.to_xarray() for name, table in self.items()}

    def _ipython_key_completions_(self) -> list[str]:
        return list(self)

    def _repr_html_(self) -> str:
        tables = {name: ", ".join(table.columns) for name, table in self.items()}
        return display.facts(f"tables of {self._owner} and their columns", tables)

    def __repr__(self) -> str:
        return f"<tables of {self._owner}: {', '.join(self) or 'none'}>"


class _NoTableError(NoDataError, KeyError):
    """Is a KeyError too, so that `in` and `get` work."""

    __str__ = Exception.__str__
