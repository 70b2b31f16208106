#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draw kinetic energy and collisions over time, from a trajectory, a log of collisions, or both.

  docs/tools/plot_history.py --trajectory trajectory.h5 --collisions collisions.h5 -o history.png

Energy is that of the trajectory's velocities, relative to the first frame; single-precision ones show some 1e-7 of
rounding. Collisions are counted per step (or per so many, where there are many steps), pairs and walls apart.
"""
import argparse

import matplotlib

matplotlib.use("Agg")
import h5py
import matplotlib.pyplot as plt
import numpy as np

from frames import Frames


def draw_energy(axes, path):
    frames = Frames(path)
    energy = np.array([0.5 * np.sum(frames.velocities(frame) ** 2) for frame in range(len(frames.steps))])
    axes.plot(frames.steps, energy / energy[0] - 1, marker=".")
    axes.set(ylabel="change of kinetic energy\n(of that at the start)")
    axes.ticklabel_format(axis="y", style="sci", scilimits=(-3, 3))
    axes.set_title(f"kinetic energy at the start {energy[0]:.10g}", fontsize="medium")


def draw_collisions(axes, path, most_points=400):
    with h5py.File(path, "r") as file:
        steps, partners = file["carrom/collisions/step"][:], file["carrom/collisions/q"][:]
    last = int(steps.max()) if len(steps) else 1
    width = -(-last // most_points)  # steps per point
    edges = np.arange(0, last + width, width) + 0.5
    for is_wall, label in ((False, "pairs"), (True, "walls")):
        counts, _ = np.histogram(steps[(partners < 0) == is_wall], edges)
        axes.plot(edges[:-1] + 0.5, counts / width, drawstyle="steps-post", label=label)
    axes.set(ylabel="collisions per step", ylim=(0, None))
    axes.legend()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--trajectory")
    parser.add_argument("--collisions")
    parser.add_argument("-o", "--output", required=True)
    options = parser.parse_args()
    parts = [(draw, path) for draw, path in ((draw_energy, options.trajectory), (draw_collisions, options.collisions)) if path]
    if not parts:
        parser.error("name a --trajectory, a log of --collisions, or both")
    figure, all_axes = plt.subplots(len(parts), figsize=(7.2, 2.8 * len(parts)), sharex=True, squeeze=False, layout="constrained")
    for axes, (draw, path) in zip(all_axes[:, 0], parts):
        draw(axes, path)
    all_axes[-1, 0].set_xlabel("step")
    figure.savefig(options.output, dpi=110)


if __name__ == "__main__":
    main()
