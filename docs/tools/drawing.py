# SPDX-License-Identifier: BSD-3-Clause
"""Discs to scale on matplotlib's axes, coloured by speed, velocity along x, spin or strip; shared by plot_frame.py and plot_movie.py."""
import tomllib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection, PatchCollection
from matplotlib.colors import ListedColormap
from matplotlib.patches import Circle

from frames import strips_of


def add_drawing_options(parser):
    parser.add_argument("--colour", choices=("speed", "vx", "spin", "strip"), default="speed")
    parser.add_argument("--ranks", type=int, default=4, help="how many strips to show; default 4")
    parser.add_argument("--view", type=float, nargs=4, metavar=("X0", "Y0", "X1", "Y1"), help="part of the box to show")
    parser.add_argument("--fastest", type=float, help="speed, velocity or spin of the strongest colour; default: 99 in 100 discs are slower")
    parser.add_argument("--scene", help="the scene's TOML, to draw its obstacles from")
    parser.add_argument("--dpi", type=int, default=110)


class Picture:
    """A figure that shows one frame after the other."""

    def __init__(self, frames, options):
        self.frames, self.options = frames, options
        self.view = options.view or (0, 0, frames.size, frames.size)
        self.figure, self.axes = plt.subplots(figsize=(7.2, 6.2), layout="constrained", dpi=options.dpi)
        x0, y0, x1, y1 = self.view
        self.axes.set(xlim=(x0, x1), ylim=(y0, y1), aspect="equal", xlabel="x", ylabel="y")
        if options.scene:
            self._add_obstacles(options.scene)
        self.fastest = options.fastest
        self.discs = self.background = None

    def show(self, frame):
        place = self.frames.positions(frame)
        x0, y0, x1, y1 = self.view
        r = self.frames.radius
        seen = (place[:, 0] > x0 - r) & (place[:, 0] < x1 + r) & (place[:, 1] > y0 - r) & (place[:, 1] < y1 + r)
        values = self._values(place, frame)
        is_first = self.discs is None
        if is_first:
            self._add_discs()
        width = 2 * np.broadcast_to(self.frames.radii, len(place))[seen]
        self.discs.set(widths=width, heights=width, angles=np.zeros(len(width)), offsets=place[seen], array=values[seen])
        self.axes.set_title(f"step {self.frames.steps[frame]}")
        if is_first:
            self.figure.canvas.draw()  # finds the layout, which is the same for all frames and slow to find
            self.figure.set_layout_engine("none")

    def pixels(self):
        """The frame that is shown, as an array (height, width, 3) of bytes. Only discs and title are drawn anew."""
        canvas, title = self.figure.canvas, self.axes.title
        if self.background is None:
            self.discs.set_animated(True)
            title.set_animated(True)
            canvas.draw()
            self.background = canvas.copy_from_bbox(self.figure.bbox)
        canvas.restore_region(self.background)
        self.axes.draw_artist(self.discs)
        self.axes.draw_artist(title)
        for spine in self.axes.spines.values():
            self.axes.draw_artist(spine)
        return np.asarray(canvas.buffer_rgba())[:, :, :3]

    def _add_obstacles(self, path):
        with open(path, "rb") as file:
            scene = tomllib.load(file)
        obstacles, size = scene.get("effects", {}).get("obstacles", {}), self.frames.size
        repeats = [(-size, 0, size) if scene["box"].get(side, {}).get("kind") == "periodic" else (0,) for side in ("left", "bottom")]
        shifts = [(dx, dy) for dx in repeats[0] for dy in repeats[1]]
        circles = [Circle((x + dx, y + dy), max(radius, 0.002 * size)) for x, y, radius in obstacles.get("discs", []) for dx, dy in shifts]
        lines = [((x0 + dx, y0 + dy), (x1 + dx, y1 + dy)) for x0, y0, x1, y1 in obstacles.get("segments", []) for dx, dy in shifts]
        self.axes.add_collection(PatchCollection(circles, facecolors="0.6", edgecolors="none"))
        self.axes.add_collection(LineCollection(lines, colors="0.4", linewidths=1))

    def _add_discs(self):
        """The discs, none yet, and the bar of their colours."""
        self.discs = EllipseCollection([], [], [], units="xy", offsets=np.empty((0, 2)), offset_transform=self.axes.transData,
                                       linewidths=0, **self._colours())
        limits = {"speed": (0, self.fastest), "spin": (-(self.fastest or 0), self.fastest), "vx": (-(self.fastest or 0), self.fastest), "strip": (-0.5, self.options.ranks - 0.5)}
        self.discs.set_clim(*limits[self.options.colour])
        self.axes.add_collection(self.discs)
        self._add_bar()

    def _values(self, place, frame):
        if self.options.colour == "strip":
            return strips_of(place[:, 0], self.options.ranks)
        if self.options.colour == "spin":
            values = self.frames.spins(frame)
        else:
            velocities = self.frames.velocities(frame)
            values = velocities[:, 0] if self.options.colour == "vx" else np.hypot(*velocities.T)
        if self.fastest is None:
            self.fastest = float(np.quantile(np.abs(values), 0.99)) or 1.0  # of the first frame shown; the same in all
        return values

    def _colours(self):
        if self.options.colour == "speed":
            return {"cmap": "viridis"}
        if self.options.colour in ("spin", "vx"):
            return {"cmap": "coolwarm"}
        colours = [matplotlib.colormaps["tab10"](k % 10) for k in range(self.options.ranks)]
        return {"cmap": ListedColormap(colours)}

    def _add_bar(self):
        if self.options.colour == "speed":
            self.figure.colorbar(self.discs, label="speed (lengths per step)", shrink=0.9)
        elif self.options.colour == "vx":
            self.figure.colorbar(self.discs, label="velocity along x (lengths per step)", shrink=0.9)
        elif self.options.colour == "spin":
            self.figure.colorbar(self.discs, label="spin (radians per step, counterclockwise)", shrink=0.9)
        else:
            self.figure.colorbar(self.discs, label="strip", shrink=0.9, ticks=range(self.options.ranks))
