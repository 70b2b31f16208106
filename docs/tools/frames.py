# SPDX-License-Identifier: BSD-3-Clause
"""Frames of Carrom's checkpoints and trajectories, for the tools beside this file."""
import sys
import tomllib

import h5py
import numpy as np


class Frames:
    """The frames of a file: `steps`, the box's size, and the discs of one frame at a time, in the scene's units."""

    def __init__(self, path):
        try:
            self.file = h5py.File(path, "r")
            self.discs = self.file["particles/discs"]
            self.steps = self.discs["box/edges/step"][:]
        except (OSError, KeyError) as error:
            sys.exit(f"{path}: not a checkpoint or trajectory of carrom ({error})")
        if len(self.steps) == 0:
            sys.exit(f"{path}: has no frames yet")
        self.size = float(self.discs["box/edges/value"][0, 0])
        is_checkpoint = "carrom/run" in self.file
        self.radius = float(self.file["carrom/run/radius" if is_checkpoint else "parameters/radius"][()])

        self.radii = self._radii(is_checkpoint)

    def _radii(self, is_checkpoint):
        """Of each disc, or one number for all. A checkpoint has them in its scene's text, or as species of their own."""
        if "radius" in self.discs:
            return self.discs["radius"][()]
        if "carrom/species" in self.file:
            return np.repeat(self.file["carrom/species/radius"][:], self.file["carrom/species/count"][:].astype(int))
        if not is_checkpoint or not self.file["carrom/run/scene_name"].asstr()[()].endswith(".toml"):
            return self.radius
        discs = tomllib.loads(self.file["carrom/run/scene_text"].asstr()[()]).get("discs", {})
        if "species" in discs:
            return np.concatenate([np.full(int(one["count"]), float(one["radius"])) for one in discs["species"]])
        rows = discs.get("list", [])
        return np.array([row[4] for row in rows]) if rows and len(rows[0]) >= 6 else self.radius

    def nearest(self, step):
        """The number of the frame of that step; the last one for None."""
        if step is None:
            return len(self.steps) - 1
        found = np.flatnonzero(self.steps == step)
        if len(found) == 0:
            sys.exit(f"no frame of step {step}; there are {len(self.steps)}, of steps {self.steps[0]} to {self.steps[-1]}")
        return int(found[0])

    def positions(self, frame):
        """Array (n, 2)."""
        return self._field("position", frame)

    def velocities(self, frame):
        """Array (n, 2), per step."""
        return self._field("velocity", frame)

    def spins(self, frame):
        """Array (n), angles per step, counterclockwise."""
        if "carrom/discs/spin" in self.file:  # a checkpoint of one frame
            return self.file["carrom/discs/spin"][:] * self.file["carrom/run/micro_steps"][()]
        if "angular_velocity" not in self.discs:
            sys.exit(f"{self.file.filename}: has no spins; rough discs have, see output.trajectory.fields")
        return self.discs["angular_velocity"]["value"][frame].astype(float)

    def _field(self, name, frame):
        if name not in self.discs:
            sys.exit(f"{self.file.filename}: has no {name}; see output.trajectory.fields")
        return self.discs[name]["value"][frame, :, :2].astype(float)


def strips_of(x, n_ranks):
    """The strip of each disc when n_ranks ranks have equally many: ranks own slabs of x."""
    strip = np.empty(len(x), dtype=int)
    strip[np.argsort(x, kind="stable")] = np.arange(len(x)) * n_ranks // len(x)
    return strip
