# SPDX-License-Identifier: BSD-3-Clause
"""Discs to scale, coloured by what they do."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.collections import EllipseCollection, LineCollection, PatchCollection
from matplotlib.colors import Colormap, ListedColormap
from matplotlib.patches import Circle, Rectangle

from carrom.disc_arrays import Array
from carrom.frame import Frame
from carrom.plot.sources import COLOURS, Drawable, frame_of, scene_of

_LABELS = {
    "speed": "speed (lengths per step)",
    "vx": "velocity along x (lengths per step)",
    "vy": "velocity along y (lengths per step)",
    "spin": "spin (radians per step, counterclockwise)",
    "direction": "direction (radians)",
    "strip": "strip",
    "species": "species",
}
_TWO_SIDED = ("vx", "vy", "spin")
_ROUND = ("direction",)
_NUMBERED = ("strip", "species")


@dataclass
class Style:
    """How discs are drawn.

    Attributes:
        colour: one of `COLOURS`, or one number a disc, (N,)
        view: x0, y0, x1, y1 of the part to show; the box if None
        fastest: the number of the strongest colour; 99 in 100 discs are below it if None
        ranks: how many strips there are, for colour "strip"
        label: what the bar of colours says
        cmap: a colour map of matplotlib, instead of the usual one
        bar: whether there is a bar of colours
        limits: the numbers of the first and the last colour, instead of `fastest`
        magnify: how many times as large as they are discs are drawn
    """

    colour: str | npt.ArrayLike = "speed"
    view: npt.ArrayLike | None = None
    fastest: float | None = None
    ranks: int = 4
    label: str | None = None
    cmap: str | Colormap | None = None
    bar: bool = True
    limits: npt.ArrayLike | None = None
    magnify: float = 1.0

    def __post_init__(self) -> None:
        if isinstance(self.colour, str) and self.colour not in COLOURS:
            known = ", ".join(COLOURS)
            raise ValueError(f"no colour {self.colour!r}; there are {known}, or an array (N,)")
        if not self.magnify > 0:
            raise ValueError(f"magnify must be above 0, not {self.magnify}")
        if self.ranks < 1:
            raise ValueError(f"ranks must be at least 1, not {self.ranks}")
        if self.fastest is not None and not self.fastest > 0:
            raise ValueError(f"fastest must be above 0, not {self.fastest}")
        if self.view is not None:
            view = np.asarray(self.view, dtype=float)
            if view.shape != (4,) or not np.all(view[:2] < view[2:]):
                raise ValueError(f"a view is x0, y0, x1, y1 with x0 < x1, y0 < y1, not {self.view}")
        if self.limits is not None and np.shape(self.limits) != (2,):
            raise ValueError(f"limits are the first and the last number, not {self.limits}")


def colour_of(
    colour: str | npt.ArrayLike | None, color: str | npt.ArrayLike | None
) -> str | npt.ArrayLike:
    """Return what was given, in either spelling.

    Raises:
        TypeError: both were
    """
    if colour is not None and color is not None:
        raise TypeError("colour and color are one argument; give one of them")
    given = colour if colour is not None else color
    return "speed" if given is None else given


def frame(
    source: Drawable,
    step: int | None = None,
    *,
    colour: str | npt.ArrayLike | None = None,
    color: str | npt.ArrayLike | None = None,
    view: npt.ArrayLike | None = None,
    fastest: float | None = None,
    ranks: int = 4,
    label: str | None = None,
    cmap: str | Colormap | None = None,
    bar: bool = True,
    limits: npt.ArrayLike | None = None,
    magnify: float = 1.0,
    scene: Mapping[str, Any] | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw the discs of one step to scale, with obstacles and the sides of the box.

    Args:
        source: a run, frames, a frame, or a path
        step: the step to show; the last one if None
        colour: "speed" (the default), "vx", "vy", "spin", "direction", "strip", "species", or an
            array (N,)
        color: the same
        view: x0, y0, x1, y1 of the part to show, lengths
        fastest: the number of the strongest colour; 99 in 100 discs are below it if None
        ranks: how many strips there are, for colour "strip"
        label: what the bar of colours says
        cmap: a colour map of matplotlib
        bar: whether there is a bar of colours
        limits: the numbers of the first and the last colour, instead of `fastest`
        magnify: draw discs so many times as large as they are, where they would be dots
        scene: where obstacles stand, if the source does not know
        ax: where to draw; a new figure if None
    """
    shown = frame_of(source, step)
    chosen = colour_of(colour, color)
    style = Style(chosen, view, fastest, ranks, label, cmap, bar, limits, magnify)
    picture = Picture(shown, style, scene_of(source) if scene is None else scene, ax)
    picture.show(shown)
    return picture.axes


class Picture:
    """Axes that show one frame after the other."""

    def __init__(
        self, first: Frame, style: Style, scene: Mapping[str, Any], ax: Axes | None = None
    ) -> None:
        """Set the scale of colours by the first frame; it is the same for all."""
        whole = (*first.corner, *(first.corner + first.box)) if style.view is None else style.view
        x0, y0, x1, y1 = np.asarray(whole, dtype=float).tolist()
        self.view = (x0, y0, x1, y1)
        if ax is None:
            # A wide view needs no more height than it fills, with room for title and labels.
            height = min(6.2, max(1.9, 5.4 * (y1 - y0) / (x1 - x0) + 0.9))
            _, ax = plt.subplots(figsize=(7.2, height), layout="constrained")
        self.axes = ax
        self.style = style
        ax.set(xlim=(x0, x1), ylim=(y0, y1), aspect="equal", xlabel="x", ylabel="y")
        _add_obstacles(ax, scene, first.box, first.corner)
        has_shape = scene.get("box", {}).get("shape", "rectangle") != "rectangle"
        edge = "none" if has_shape else "0.3"
        self.sides = Rectangle((0, 0), 0, 0, fill=False, edgecolor=edge, linewidth=1)
        self.sides.set(x=first.corner[0], y=first.corner[1])
        ax.add_patch(self.sides)
        self.discs = EllipseCollection(
            [],
            [],
            [],
            units="xy",
            offsets=np.empty((0, 2)),
            offset_transform=ax.transData,
            linewidths=0,
            cmap=self._cmap(first),
        )
        self.discs.set_clim(*self._limits(first))
        ax.add_collection(self.discs)
        if style.bar and ax.figure is not None:
            self._add_bar(first)

    def show(self, frame: Frame) -> None:
        """Show a frame instead of the one before."""
        self.sides.set(width=frame.box[0], height=frame.box[1])
        x0, y0, x1, y1 = self.view
        x, y, r = frame.x[:, 0], frame.x[:, 1], frame.radius
        seen = frame.present & (x > x0 - r) & (x < x1 + r) & (y > y0 - r) & (y < y1 + r)
        width = 2 * self.style.magnify * r[seen]
        self.discs.set(
            widths=width,
            heights=width,
            angles=np.zeros(len(width)),
            offsets=frame.x[seen],
            array=self._values(frame)[seen],
        )
        times = f", discs drawn {self.style.magnify:g} times as large"
        self.axes.set_title(f"step {frame.step}{times if self.style.magnify != 1 else ''}")

    def _values(self, frame: Frame) -> Array:
        colour = self.style.colour
        if not isinstance(colour, str):
            values = np.asarray(colour)
            if values.shape != (frame.n_discs,):
                wanted = f"({frame.n_discs},): one number a disc"
                raise ValueError(f"colour has the shape {values.shape}, not {wanted}")
            return values
        if colour == "strip":
            return frame.strips(self.style.ranks)
        if colour in ("vx", "vy"):
            return np.asarray(frame.v[:, 0 if colour == "vx" else 1])
        return np.asarray(getattr(frame, colour))

    def _n_numbers(self, first: Frame) -> int:
        """How many numbered colours there are."""
        if self.style.colour == "strip":
            return self.style.ranks
        return int(first.species.max(initial=0)) + 1

    def _is(self, kinds: tuple[str, ...]) -> bool:
        return isinstance(self.style.colour, str) and self.style.colour in kinds

    def _cmap(self, first: Frame) -> str | Colormap:
        if self.style.cmap is not None:
            return self.style.cmap
        if self._is(_NUMBERED):
            tab = mpl.colormaps["tab10"]
            return ListedColormap([tab(k % 10) for k in range(self._n_numbers(first))])
        if self._is(_ROUND):
            return "hsv"
        return "coolwarm" if self._is(_TWO_SIDED) else "viridis"

    def _limits(self, first: Frame) -> tuple[float, float]:
        if self.style.limits is not None:
            first_colour, last_colour = np.asarray(self.style.limits, dtype=float).tolist()
            return first_colour, last_colour
        if self._is(_NUMBERED):
            return -0.5, self._n_numbers(first) - 0.5
        if self._is(_ROUND):
            return -np.pi, np.pi
        values = self._values(first)[first.present]
        strongest = self.style.fastest
        if strongest is None:
            strongest = float(np.quantile(np.abs(values), 0.99)) if len(values) else 1.0
            strongest = strongest or 1.0
        if self._is(("speed",)):
            return 0.0, strongest
        if self._is(_TWO_SIDED):
            return -strongest, strongest
        lowest = min(0.0, float(values.min())) if len(values) else 0.0
        return lowest, strongest

    def _add_bar(self, first: Frame) -> None:
        label = self.style.label
        if label is None and isinstance(self.style.colour, str):
            label = _LABELS[self.style.colour]
        ticks = range(self._n_numbers(first)) if self._is(_NUMBERED) else None
        self.axes.figure.colorbar(
            self.discs, ax=self.axes, label=label or "", shrink=0.9, ticks=ticks
        )


def _add_obstacles(axes: Axes, scene: Mapping[str, Any], box: Array, corner: Array) -> None:
    """Draw fixed bodies and the wall of a round box, and their images through periodic sides."""
    obstacles = scene.get("effects", {}).get("obstacles", {})
    walls = scene.get("box", {})
    shifts = [0.0], [0.0]
    for axis, side in enumerate(("left", "bottom")):
        if walls.get(side, {}).get("kind") == "periodic":
            shifts[axis][:] = [-float(box[axis]), 0.0, float(box[axis])]
    moves = [(dx, dy) for dx in shifts[0] for dy in shifts[1]]
    smallest = 0.002 * float(box[0])
    circles = [
        Circle((x + dx, y + dy), max(radius, smallest))
        for x, y, radius in obstacles.get("discs", [])
        for dx, dy in moves
    ]
    paths = [np.reshape(row, (2, 2)) for row in obstacles.get("segments", [])]
    paths += [_closed(np.reshape(row, (-1, 2))) for row in obstacles.get("polygons", [])]
    paths += [_arc(*row) for row in obstacles.get("arcs", [])]
    paths += [wall + corner for wall in _wall(walls.get("shape"), float(box[0]), float(box[1]))]
    lines = [path + np.array(move) for path in paths for move in moves]
    axes.add_collection(PatchCollection(circles, facecolors="0.6", edgecolors="none"))
    axes.add_collection(LineCollection(lines, colors="0.4", linewidths=1))


def _closed(corners: Array) -> Array:
    return np.concatenate((corners, corners[:1]))


def _arc(x: float, y: float, radius: float, start: float = 0, end: float = 360) -> Array:
    """Return points of an arc between two angles in degrees, (n, 2)."""
    angles = np.radians(np.linspace(start, end, 181))
    return np.stack((x + radius * np.cos(angles), y + radius * np.sin(angles)), axis=1)


def _wall(shape: str | None, width: float, height: float) -> list[Array]:
    """Return the wall of a box that is no rectangle, from its lower left corner."""
    radius = min(width, height) / 2
    if shape == "round":
        return [_arc(radius, radius, radius)]
    if shape != "stadium":
        return []
    turn = 0 if width >= height else 90
    high = _arc(width - radius, height - radius, radius, turn - 90, turn + 90)
    low = _arc(radius, radius, radius, turn + 90, turn + 270)
    return [_closed(np.concatenate((high, low)))]
