# SPDX-License-Identifier: BSD-3-Clause
"""Where the walls of a box are at a step: some move at a constant speed, some oscillate."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from carrom.scene import flattened

Edges = tuple[float, float, float, float]
"""Low x, low y, high x, high y."""

_SIDES = ("left", "bottom", "right", "top")


@dataclass(frozen=True)
class Walls:
    """The walls at a step, and the part of the plane in which they are at any step of the run."""

    places: Edges
    room: Edges


def at_rest(box: Any, corner: Any = (0.0, 0.0)) -> Walls:
    """Return the walls of a box in which none moves; `corner` is the lower left one."""
    (x, y), (width, height) = map(float, corner), map(float, box)
    edges = (x, y, x + width, y + height)
    return Walls(edges, edges)


def walls_at(scene: Mapping[str, Any], box: Any, step: int, corner: Any = (0.0, 0.0)) -> Walls:
    """Return the walls of a scene; `box` are the edges that its frames name, [Lx, Ly].

    The frames of a run share one box, which has room for walls that move, but not for those that
    oscillate beyond their line.
    """
    resting = at_rest(box, corner)
    keys = flattened(scene)
    if "box.size" not in keys:  # legacy text, whose walls are at rest
        return resting
    size = keys["box.size"]
    edges = list(map(float, size)) if isinstance(size, list) else [float(size)] * 2
    lines = at_rest(edges, corner).places
    places = [line + _shift(keys, side, step) for line, side in zip(lines, _SIDES)]
    reach = [_amplitude(keys, side) for side in _SIDES]
    left, bottom = (min(resting.room[i], lines[i] - reach[i], places[i]) for i in (0, 1))
    right, top = (max(resting.room[i], lines[i] + reach[i], places[i]) for i in (2, 3))
    return Walls((places[0], places[1], places[2], places[3]), (left, bottom, right, top))


def _kind(keys: Mapping[str, Any], side: str) -> str:
    return str(keys.get(f"box.{side}.kind", "wall"))


def _amplitude(keys: Mapping[str, Any], side: str) -> float:
    return float(keys[f"box.{side}.amplitude"]) if _kind(keys, side) == "oscillating" else 0.0


def _shift(keys: Mapping[str, Any], side: str, step: int) -> float:
    """How far the wall is from its line, along +x or +y, as docs/reference/effects.md says."""
    if _kind(keys, side) == "moving":
        return float(keys[f"box.{side}.speed"]) * step
    if _kind(keys, side) == "oscillating":
        period, phase = float(keys[f"box.{side}.period"]), float(keys.get(f"box.{side}.phase", 0))
        return _amplitude(keys, side) * math.sin(2 * math.pi * (step % period) / period + phase)
    return 0.0
