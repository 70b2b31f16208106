#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draw the tables that `[output.measurements]` has written into a folder.

  docs/tools/plot_measurements.py measured -o measured.png

One panel for each kind of table that is there. Velocities are shown beside the normal distribution of the same variance;
wall pressures over time, each side's mean in the legend.
"""
import argparse
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np


def read(path):
    """Columns by name."""
    with open(path) as file:
        lines = [line for line in file if not line.startswith("#")]
    numbers = np.array([[float(word) for word in line.split(",")] for line in lines[1:]])
    return dict(zip(lines[0].strip().split(","), numbers.T))


def middles(table):
    return (table["from"] + table["to"]) / 2


def draw_radial_distribution(axes, folder):
    table = read(folder / "radial_distribution.csv")
    axes.plot(middles(table), table["g"])
    axes.axhline(1, color="0.7", linewidth=0.8)
    axes.set(xlabel="distance", ylabel="g", ylim=(0, None))


def draw_velocities(axes, folder):
    table = read(folder / "velocities.csv")
    v = middles(table)
    for name in ("vx", "vy"):
        axes.plot(v, table[f"{name}_density"], drawstyle="steps-mid", label=name)
    counts = table["vx_count"] + table["vy_count"]
    variance = np.sum(counts * v**2) / np.sum(counts)
    if variance > 0:
        axes.plot(v, np.exp(-(v**2) / (2 * variance)) / np.sqrt(2 * np.pi * variance), color="black", linewidth=0.8, label="Maxwell")
    axes.set(xlabel="velocity", ylabel="density of probability")
    axes.legend()


def draw_density(axes, folder):
    for name in ("x", "y"):
        table = read(folder / f"density_{name}.csv")
        axes.plot(middles(table), table["density"], drawstyle="steps-mid", label=f"along {name}")
    axes.set(xlabel="place", ylabel="discs per area", ylim=(0, None))
    axes.legend()


def draw_wall_pressure(axes, folder):
    history, mean = read(folder / "wall_pressure_history.csv"), read(folder / "wall_pressure.csv")
    for side in ("left", "right", "bottom", "top"):
        label = f"{side}: {mean[side][0]:.4g} ± {mean[side + '_error'][0]:.1g}"
        axes.plot((history["from_step"] + history["to_step"]) / 2, history[side], linewidth=0.8, label=label)
    axes.set(xlabel="step", ylabel="wall pressure", ylim=(0, None))
    axes.legend(fontsize="small")


def draw_displacement(axes, folder):
    table = read(folder / "displacement.csv")
    moved = table["steps"] > 0
    for name in ("x", "y", "sum"):
        axes.loglog(table["steps"][moved], table[name][moved], label=name)
    axes.set(xlabel="steps", ylabel="mean square displacement")
    axes.legend()


PANELS = {
    "radial_distribution.csv": draw_radial_distribution,
    "velocities.csv": draw_velocities,
    "density_x.csv": draw_density,
    "wall_pressure_history.csv": draw_wall_pressure,
    "displacement.csv": draw_displacement,
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("-o", "--output", required=True)
    options = parser.parse_args()
    panels = [draw for name, draw in PANELS.items() if (options.folder / name).exists()]
    if not panels:
        parser.error(f"{options.folder} has none of the tables {', '.join(PANELS)}")
    n_columns = min(2, len(panels))
    n_rows = -(-len(panels) // n_columns)
    figure, all_axes = plt.subplots(n_rows, n_columns, figsize=(4.8 * n_columns, 3.4 * n_rows), squeeze=False, layout="constrained")
    for axes in all_axes.flat[len(panels):]:
        axes.remove()
    for axes, draw in zip(all_axes.flat, panels):
        draw(axes, options.folder)
    figure.savefig(options.output, dpi=110)


if __name__ == "__main__":
    main()
