# SPDX-License-Identifier: BSD-3-Clause
"""A field of `"profiles"`: a map, or a curve where the grid has a single row or column."""

from __future__ import annotations

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from carrom.fields import Fields


def draw_field(ax: Axes, fields: Fields, column: str, block: int) -> Any:
    """Draw one field of a block, and others beside it where it is a curve."""
    values = fields.values(column)
    ax.set_title(f"{column}, up to step {fields.steps[block]:.0f}", fontsize="medium")
    if fields.is_map:
        low, high = np.nanmin(values[block]), np.nanmax(values[block])
        style: dict[str, Any] = {"cmap": "viridis"}
        if low < 0 < high:  # flows: white where nothing moves
            style = {"cmap": "RdBu_r", "vmin": -max(-low, high), "vmax": max(-low, high)}
        mesh = ax.pcolormesh(
            fields.x[block], fields.y[block], values[block], shading="nearest", **style
        )
        ax.set(xlabel="x", ylabel="y", aspect="equal")
        ax.figure.colorbar(mesh, cax=ax.inset_axes((1.02, 0, 0.03, 1)))  # as high as the map
        return mesh
    along, place = ("x", fields.x) if fields.shape[1] > 1 else ("y", fields.y)
    colours = plt.get_cmap("viridis")(np.linspace(0, 0.9, max(block, 1)))
    for earlier in range(block):
        curve = values[earlier].ravel()
        ax.plot(place[earlier], curve, color=colours[earlier], linewidth=0.7, alpha=0.6)
    (line,) = ax.plot(place[block], values[block].ravel(), color="black", linewidth=1.2)
    ax.set(xlabel=along, ylabel=column)
    return line
