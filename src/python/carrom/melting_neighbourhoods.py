# SPDX-License-Identifier: BSD-3-Clause
"""The packing around points, and around each disc: see `carrom.melting`."""

from __future__ import annotations

import math

import numpy as np

from carrom.adapters import package
from carrom.disc_arrays import Array, DiscArrays
from carrom.melting_parts import Given, listed, present, with_images


def local_packing(frames: Given, radius: float, points: int = 1000) -> Array:
    """Return the packing in circles around points of a regular grid, (frames, points).

    A disc counts with its whole area if its centre is in the circle. So steps of one disc show in
    histograms of small circles. Points do not depend on discs, so every part of the box has the
    same weight. At coexistence a histogram has two peaks if circles are smaller than the phases.

    Args:
        frames: frames with positions
        radius: of the circles, at most half the shorter side of the box
        points: about this many; the grid has the box's shape
    """
    given = listed(frames, "local_packing")
    spatial = package("scipy.spatial", "local_packing", "scipy")
    if not 0 < radius <= min(given[0].box) / 2:
        raise ValueError("radius is above 0 and at most half the shorter side of the box")
    result = []
    for frame in given:
        tree = spatial.cKDTree(present(frame), boxsize=frame.box)
        found = tree.query_ball_point(grid(frame, points), radius)
        squares = np.asarray(frame.radius[frame.present]) ** 2
        result.append([squares[inside].sum() / radius**2 for inside in found])
    return np.array(result)


def cell_packing(frame: DiscArrays) -> Array:
    """Return the area of each disc over the area of its Voronoi cell, (n,).

    Cells are those of the centres, so all radii must be equal. Discs that have left are left out.

    Raises:
        ValueError: radii differ
    """
    listed(frame, "cell_packing")
    if np.ptp(frame.radius) > 1e-9 * np.max(frame.radius):
        raise ValueError("cell_packing: radii differ, but cells of centres would cut large discs")
    spatial = package("scipy.spatial", "cell_packing", "scipy")
    x = present(frame)
    # Cells of a dense sample end within a few distances of neighbours.
    margin = 6 * math.sqrt(float(np.prod(frame.box)) / len(x))
    voronoi = spatial.Voronoi(with_images(x, frame.box, min(margin, float(min(frame.box)))))
    areas = [_polygon(voronoi.vertices[voronoi.regions[k]]) for k in voronoi.point_region[: len(x)]]
    return np.asarray(math.pi * frame.radius[frame.present] ** 2 / np.array(areas))


def grid(frame: DiscArrays, points: int) -> Array:
    """Return the points (n, 2) of a regular grid with about so many."""
    lx, ly = frame.box
    columns = max(1, round(math.sqrt(points * lx / ly)))
    rows = max(1, round(points / columns))
    x, y = (np.arange(columns) + 0.5) * lx / columns, (np.arange(rows) + 0.5) * ly / rows
    return np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)


def _polygon(corners: Array) -> float:
    """Area of a polygon whose corners follow each other."""
    x, y = corners.T
    return 0.5 * abs(float(x @ np.roll(y, -1) - y @ np.roll(x, -1)))
