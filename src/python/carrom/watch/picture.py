# SPDX-License-Identifier: BSD-3-Clause
"""What the page draws of a frame: discs, or their density where there are too many."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from carrom.disc_arrays import Array
from carrom.errors import NoDataError
from carrom.frame import Frame
from carrom.watch.colour_scale import speeds
from carrom.watch.order import hexatic_order
from carrom.watch.walls import Walls, at_rest

MOST_DISCS = 150_000
"""More discs in view are drawn as a density."""
CELLS = 320
"""Cells along the longer side of a density."""
_VIEW = "a view is x_low,y_low,x_high,y_high"
COLOURS = ("speed", "psi6", "species")


@dataclass(frozen=True)
class View:
    """The part of the box that the page shows."""

    x_low: float
    y_low: float
    x_high: float
    y_high: float

    def __post_init__(self) -> None:
        """Refuse what is no rectangle."""
        edges = (self.x_high - self.x_low, self.y_high - self.y_low)
        if not all(0 < edge < np.inf for edge in edges):
            raise ValueError(_VIEW)

    @classmethod
    def of(cls, text: str) -> View:
        """Read four numbers with commas between them."""
        numbers = [float(word) for word in text.split(",")]
        if len(numbers) != 4:
            raise ValueError(_VIEW)
        return cls(*numbers)


def picture(
    frame: Frame,
    colour: str,
    view: View | None,
    most: int = MOST_DISCS,
    walls: Walls | None = None,
) -> tuple[dict[str, Any], bytes]:
    """Return what the page draws: facts about it, and float32 numbers.

    `kind` "discs": columns x, y, value and, where radii differ, radius; x and y count from the
    view's corner. `kind` "density": rows of cells, the packing fraction and then the mean value.
    Without `walls` those of the frame's box are at rest.
    """
    if colour not in COLOURS:
        raise ValueError(f"colour is one of {', '.join(COLOURS)}")
    walls = walls or at_rest(frame.box, frame.corner)
    seen = view or View(*walls.room)
    places = _places_in(frame, seen)
    about: dict[str, Any] = {
        "step": frame.step,
        "total": frame.n_discs,
        "inside": int(np.count_nonzero(frame.present)),
        "shown": len(places),
        "walls": list(walls.places),
        "room": list(walls.room),
        "view": [seen.x_low, seen.y_low, seen.x_high, seen.y_high],
        "colour": colour,
        "radius": float(frame.radius.max()) if frame.n_discs else 0.0,
    }
    if len(places) > most:
        if colour == "psi6":
            about["colour"] = "speed"
            about["note"] = f"psi6 is drawn of at most {most} discs: zoom in"
        values = _values(frame, places, about["colour"], about)
        about["kind"] = "density"
        return about, _density(frame, places, values, seen, about)
    about["kind"] = "discs"
    values = _values(frame, places, colour, about)
    return about, _discs(frame, places, values, seen, about)


def _places_in(frame: Frame, view: View) -> Array:
    x, y = frame.x[:, 0], frame.x[:, 1]
    margin = float(frame.radius.max()) if frame.n_discs else 0.0
    is_seen = frame.present & (x > view.x_low - margin) & (x < view.x_high + margin)
    is_seen &= (y > view.y_low - margin) & (y < view.y_high + margin)
    return np.flatnonzero(is_seen)


def _values(frame: Frame, places: Array, colour: str, about: dict[str, Any]) -> Array:
    if colour == "species":
        about["species"] = int(frame.species.max()) + 1 if frame.n_discs else 1
        return np.asarray(frame.species[places], dtype=np.float32)
    if colour == "psi6":
        edges = np.where(frame.periodic, frame.box, 0.0)
        centres = frame.x_from_corner[places].astype(float)
        return np.abs(hexatic_order(centres, edges)).astype(np.float32)
    try:
        return speeds(frame.v[places])
    except NoDataError:
        about["note"] = "frames have no velocities: see output.trajectory.fields"
        return np.zeros(len(places), dtype=np.float32)


def _discs(frame: Frame, places: Array, values: Array, view: View, about: dict[str, Any]) -> bytes:
    columns = [frame.x[places, 0] - view.x_low, frame.x[places, 1] - view.y_low, values]
    radii = frame.radius[places]
    if len(radii) and radii.min() != radii.max():
        about["has_radii"] = True
        columns.append(radii)
    return b"".join(np.ascontiguousarray(column, dtype="<f4").tobytes() for column in columns)


def _density(
    frame: Frame, places: Array, values: Array, view: View, about: dict[str, Any]
) -> bytes:
    width, height = view.x_high - view.x_low, view.y_high - view.y_low
    cell = max(width, height) / CELLS
    columns, rows = max(1, round(width / cell)), max(1, round(height / cell))
    x = ((frame.x[places, 0] - view.x_low) * (columns / width)).astype(np.int64)
    y = ((frame.x[places, 1] - view.y_low) * (rows / height)).astype(np.int64)
    number = np.clip(y, 0, rows - 1) * columns + np.clip(x, 0, columns - 1)
    areas = np.pi * frame.radius[places] ** 2
    n_cells = columns * rows
    counts = np.bincount(number, minlength=n_cells)
    fraction = np.bincount(number, weights=areas, minlength=n_cells) / (width * height / n_cells)
    mean = np.bincount(number, weights=values, minlength=n_cells) / np.maximum(counts, 1)
    about["grid"] = [columns, rows]
    return b"".join(np.asarray(part, dtype="<f4").tobytes() for part in (fraction, mean))
