#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draw one step of Carrom's text output, discs to scale, coloured by speed.

  build/carrom run inputs/jet.toml --set output.text=ends | docs/tools/plot_frame.py --radius 1 --size 500 -o jet.png

Reads lines `step id x y vx vy [p_c w_c]` from standard input or FILE and draws the last step, or --step.
"""
import argparse
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import EllipseCollection


def read_step(lines, wanted):
    """The rows (x, y, vx, vy) of one step: `wanted`, or the last one."""
    rows, present = [], None
    for line in lines:
        fields = line.split()
        step = int(fields[0])
        if wanted is not None and step != wanted:
            continue
        if step != present:
            rows, present = [], step
        rows.append([float(value) for value in fields[2:6]])
    if not rows:
        sys.exit("plot_frame: no lines of that step")
    return present, np.array(rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", nargs="?", type=argparse.FileType(), default=sys.stdin)
    parser.add_argument("--radius", type=float, required=True, help="the discs' radius, in the scene's unit")
    parser.add_argument("--size", type=float, required=True, help="the box's size")
    parser.add_argument("--step", type=int)
    parser.add_argument("--view", type=float, nargs=4, metavar=("X0", "Y0", "X1", "Y1"), help="part of the box to show")
    parser.add_argument("-o", "--output", required=True)
    options = parser.parse_args()

    step, rows = read_step(options.file, options.step)
    x0, y0, x1, y1 = options.view or (0, 0, options.size, options.size)
    margin = options.radius
    seen = ((rows[:, 0] > x0 - margin) & (rows[:, 0] < x1 + margin) & (rows[:, 1] > y0 - margin) & (rows[:, 1] < y1 + margin))
    rows = rows[seen]
    speed = np.hypot(rows[:, 2], rows[:, 3])

    figure, axes = plt.subplots(figsize=(7.2, 6.2), layout="constrained")
    width = np.full(len(rows), 2 * options.radius)
    discs = EllipseCollection(width, width, np.zeros(len(rows)), units="x", offsets=rows[:, :2],
                              transOffset=axes.transData, cmap="viridis", linewidths=0)
    discs.set_array(speed)
    discs.set_clim(0, np.quantile(speed, 0.99) or 1)
    axes.add_collection(discs)
    axes.set(xlim=(x0, x1), ylim=(y0, y1), aspect="equal", xlabel="x", ylabel="y", title=f"step {step}")
    figure.colorbar(discs, label="speed (lengths per step)", shrink=0.9)
    figure.savefig(options.output, dpi=110)


if __name__ == "__main__":
    main()
