# SPDX-License-Identifier: BSD-3-Clause
"""Averages and tables of a simulation, as they were when they were asked for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from carrom import display
from carrom.disc_arrays import Array
from carrom.errors import NoDataError
from carrom.labelled import import_package
from carrom.physics import Measured
from carrom.tables import Table, is_whole

if TYPE_CHECKING:
    import pandas
    import xarray

_SHORT = {"Z": "compressibility", "kT": "temperature", "P": "pressure"}


class Averages(Mapping[str, Measured]):
    """Averages and their standard errors: `averages["Z"]`, `averages["mean_speed"]` ...

    An error is nan for a conserved average, for one that is still changing, and if the averages
    are over too few steps or collisions. `averages["Z"].without_error` says which of these it is,
    and so do the printed average and the table of a notebook. Without `time.steps` in the scene an
    error takes 16 steps and 32 collisions; speeds and single components of the pressure take 32
    collisions of each disc. With `time.steps` it takes four blocks; a block is a quarter of all
    steps, and at most 64 micro-steps or the steps between two syncs. In runs of few correlation
    times errors are up to a quarter too small.

    Attributes:
        first_step: the step at which averaging began
        steps: how many steps they are averages over
    """

    def __init__(self, found: Mapping[str, Any]) -> None:
        """Take what the extension returns."""
        self.first_step = int(found["first_step"])
        self.steps = int(found["steps"])
        self._of = {
            name: Measured(entry["value"], entry["error"], entry["without_error"])
            for name, entry in found["averages"].items()
        }

    def __getitem__(self, name: str) -> Measured:
        key = _SHORT.get(name, name)
        if key not in self._of:
            raise _NoSuchNameError(f"no average {name!r}; there are {', '.join(self._of)}")
        return self._of[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._of)

    def __len__(self) -> int:
        return len(self._of)

    def to_pandas(self) -> pandas.DataFrame:
        """Return a DataFrame with a row for each average: `value`, `error`, `without_error`."""
        columns = {
            "average": np.array(list(self._of)),
            "value": np.array([measured.value for measured in self._of.values()]),
            "error": np.array([measured.error for measured in self._of.values()]),
            "without_error": np.array([measured.without_error for measured in self._of.values()]),
        }
        return Table.from_columns(columns).to_pandas().set_index("average")

    def to_xarray(self) -> xarray.Dataset:
        """Return a Dataset of `value` and `error` over `average`, the names."""
        xr = import_package("xarray", "to_xarray")
        columns = {
            name: ("average", np.array([getattr(measured, name) for measured in self.values()]))
            for name in Measured._fields
        }
        data: xarray.Dataset = xr.Dataset(columns, coords={"average": list(self)})
        return data

    def _ipython_key_completions_(self) -> list[str]:
        return [*self, *_SHORT]

    def _repr_html_(self) -> str:
        rows = [
            (name, measured.value, measured.without_error or measured.error)
            for name, measured in self.items()
        ]
        return display.rows("averages", ("average", "value", "error"), rows)

    def __repr__(self) -> str:
        return f"<averages over {self.steps} steps: {', '.join(self)}>"


class _NoSuchNameError(NoDataError, KeyError):
    """Is a KeyError too, so that `in` and `get` work."""

    __str__ = Exception.__str__


class LiveTables(Mapping[str, Table]):
    """Tables of a simulation as they were when they were asked for, by name."""

    def __init__(self, found: list[tuple[str, list[str], Array, list[str]]]) -> None:
        """Take what the extension returns."""
        self._tables = {
            name: _table_of(names, rows, remarks) for name, names, rows, remarks in found
        }

    def __getitem__(self, name: str) -> Table:
        if name not in self._tables:
            known = ", ".join(self._tables) or "none before the first sample"
            raise _NoSuchNameError(
                f"no table {name!r}; there are {known}. output.measurements.quantities of the "
                "scene says what is measured"
            )
        return self._tables[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._tables)

    def __len__(self) -> int:
        return len(self._tables)

    def to_pandas(self) -> dict[str, pandas.DataFrame]:
        """Return all tables as pandas DataFrames, by name."""
        return {name: table.to_pandas() for name, table in self.items()}

    def to_xarray(self) -> dict[str, xarray.Dataset]:
        """Return all tables as xarray Datasets, by name."""
        return {name: table.to_xarray() for name, table in self.items()}

    def _ipython_key_completions_(self) -> list[str]:
        return list(self)

    def __repr__(self) -> str:
        return f"<tables: {', '.join(self) or 'none'}>"


def _table_of(columns: list[str], rows: Array, remarks: list[str]) -> Table:
    numbers = {
        name: rows[:, k].astype(np.int64) if is_whole(name) else rows[:, k]
        for k, name in enumerate(columns)
    }
    return Table.from_columns(numbers, remarks)
