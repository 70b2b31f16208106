# SPDX-License-Identifier: BSD-3-Clause
"""Tables and frames as pandas and xarray, with names on rows, columns and axes."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from carrom.errors import MissingPackageError, NoDataError
from carrom.fields import Fields, is_grid
from carrom.named_columns import NamedColumns

if TYPE_CHECKING:
    import pandas
    import xarray

    from carrom.disc_arrays import Array, DiscArrays

_UNITS = {
    "position": "length",
    "velocity": "length per step",
    "spin": "radians per step",
    "direction": "radians",
    "radius": "length",
}
_FIELDS = {"position": "x", "velocity": "v"}
_NUMBERS = ("spin", "direction", "psi6", "neighbours", "wall_collisions", "pair_collisions")
_BODIES = ("radius", "mass", "species", "present")


def import_package(name: str, wanted_by: str) -> Any:
    """Import pandas or xarray, or say how to install it."""
    try:
        return __import__(name)
    except ImportError:
        raise MissingPackageError(f"{wanted_by} needs {name}: pip install {name}") from None


def _arrays_of(frame: DiscArrays) -> dict[str, Array]:
    """Return all that a frame has of its discs: (N, 2) or (N,). What is not stored is left out."""
    arrays: dict[str, Array] = {}
    for name in (*_FIELDS, *_NUMBERS, *_BODIES):
        with contextlib.suppress(NoDataError):
            arrays[name] = np.asarray(getattr(frame, _FIELDS.get(name, name)))
    return arrays


def table_to_pandas(table: NamedColumns) -> pandas.DataFrame:
    """See `Table.to_pandas`."""
    pd = import_package("pandas", "to_pandas")
    frame: pandas.DataFrame = pd.DataFrame(
        {name: np.asarray(table[name]) for name in table.columns}
    )
    frame.attrs["remarks"] = list(table.remarks)
    return frame


def table_to_xarray(table: NamedColumns) -> xarray.Dataset:
    """See `Table.to_xarray`."""
    xr = import_package("xarray", "to_xarray")
    attributes = {"remarks": list(table.remarks)}
    if is_grid(table.columns):
        return _fields_to_xarray(xr, Fields(table), attributes)
    variables = {name: ("row", np.asarray(table[name])) for name in table.columns}
    data: xarray.Dataset = xr.Dataset(variables, attrs=attributes)
    return data


def _fields_to_xarray(xr: Any, fields: Fields, attributes: dict[str, Any]) -> xarray.Dataset:
    """Over blocks, rows and columns. Where walls move, places depend on the block."""
    places: dict[str, Any] = {}
    for name, place in (("x", fields.x), ("y", fields.y)):
        is_fixed = bool(np.all(place == place[:1]))
        places[name] = (name, place[0]) if is_fixed and len(place) else (("step", name), place)
    variables = {name: (("step", "y", "x"), fields.values(name)) for name in fields.names}
    data: xarray.Dataset = xr.Dataset(
        variables, coords={"step": fields.steps, **places}, attrs=attributes
    )
    return data


def frame_to_pandas(frame: DiscArrays) -> pandas.DataFrame:
    """See `Frame.to_pandas`."""
    pd = import_package("pandas", "to_pandas")
    columns: dict[str, Array] = {}
    for name, array in _arrays_of(frame).items():
        if name in _FIELDS:
            letter = "" if name == "position" else "v"
            columns |= {f"{letter}{axis}": array[:, k] for k, axis in enumerate("xy")}
        else:
            columns[name] = array
    index = pd.RangeIndex(frame.n_discs, name="disc")
    data: pandas.DataFrame = pd.DataFrame(columns, index=index)
    data.attrs |= {"step": frame.step, "box": frame.box.tolist()}
    return data


def frames_to_pandas(frames: Sequence[DiscArrays]) -> pandas.DataFrame:
    """See `Frames.to_pandas`."""
    pd = import_package("pandas", "to_pandas")
    _need_frames(frames, "to_pandas")
    parts = {frame.step: frame_to_pandas(frame) for frame in frames}
    data: pandas.DataFrame = pd.concat(parts, names=["step", "disc"])
    return data


def frame_to_xarray(frame: DiscArrays) -> xarray.Dataset:
    """See `Frame.to_xarray`."""
    xr = import_package("xarray", "to_xarray")
    variables = {}
    for name, array in _arrays_of(frame).items():
        dims = ("disc", "axis") if name in _FIELDS else ("disc",)
        units = {"units": _UNITS[name]} if name in _UNITS else {}
        variables[name] = (dims, array, units)
    coordinates = {"disc": np.arange(frame.n_discs), "axis": ["x", "y"], "step": frame.step}
    variables["box"] = (("axis",), np.asarray(frame.box), {"units": "length"})
    attributes = {"periodic": [int(is_periodic) for is_periodic in frame.periodic]}
    data: xarray.Dataset = xr.Dataset(variables, coords=coordinates, attrs=attributes)
    return data


def frames_to_xarray(frames: Sequence[DiscArrays]) -> xarray.Dataset:
    """See `Frames.to_xarray`."""
    xr = import_package("xarray", "to_xarray")
    _need_frames(frames, "to_xarray")
    bodies = ["radius", "mass", "species"]
    parts = [frame_to_xarray(frame) for frame in frames]
    moving = xr.concat([part.drop_vars(bodies) for part in parts], dim="step")
    data: xarray.Dataset = moving.merge(parts[0][bodies].drop_vars("step"))
    return data


def _need_frames(frames: Sequence[DiscArrays], wanted_by: str) -> None:
    if len(frames) == 0:
        raise NoDataError(f"{wanted_by} needs at least one frame")


def grid_to_xarray(table: NamedColumns, keys: Mapping[str, Sequence[Any]]) -> xarray.Dataset:
    """Return columns of a table over the axes of a grid; nan where a point has no row."""
    xr = import_package("xarray", "to_xarray")
    shape = tuple(len(values) for values in keys.values())
    places = [
        tuple(list(map(str, values)).index(str(row[key])) for key, values in keys.items())
        for row in table
    ]
    variables = {}
    for name in table.columns:
        if name not in keys:
            numbers = np.full(shape, np.nan)
            for place, value in zip(places, np.asarray(table[name])):
                numbers[place] = value
            variables[name] = (tuple(keys), numbers)
    coordinates = {key: list(values) for key, values in keys.items()}
    data: xarray.Dataset = xr.Dataset(variables, coords=coordinates)
    return data
