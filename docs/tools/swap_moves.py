#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws F_s of a dense liquid with swaps and without, and the times in which it falls, by packing.

  docs/tools/swap_moves.py CARROM PICTURE     needs the package of src/python

It runs inputs/swap.toml with swaps to the end and up to step 400, and reads docs/data/validation/swap_times.csv. The
picture is docs/pictures/swap.png.
"""
import csv
import math
import pathlib
import tempfile

import carrom
import matplotlib.pyplot as plt
import plot_style

TOP = pathlib.Path(__file__).parents[2]


def correlations(program, until_step):
    scene = carrom.read_scene(TOP / "inputs/swap.toml")
    scene["effects"]["swap"]["until_step"] = until_step
    scene["output"]["measurements"]["from_step"] = 400
    with tempfile.TemporaryDirectory() as folder:
        return carrom.run(scene, folder=pathlib.Path(folder) / "run", program=program, threads=1).tables["correlations"]


def main():
    options = plot_style.program_and_picture(__doc__)
    figure, (decay, times) = plt.subplots(1, 2, figsize=(11, 4.5))
    for until_step, label in ((0, "with swaps"), (400, "without, from the same states")):
        table = correlations(options.program, until_step)
        decay.semilogx(table["steps"], table["scattering"], "o-", markersize=3, label=label)
    decay.axhline(1 / math.e, color="0.6", linewidth=1)
    decay.set(xlabel="steps", ylabel="F_s", ylim=(0, 1), title="640 discs, packing 0.78")
    decay.legend(fontsize="small")
    with open(TOP / "docs/data/validation/swap_times.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    for goes_on, label, marker in (("1", "with swaps", "o"), ("0", "without", "s")):
        chosen = [row for row in rows if row["swaps_go_on"] == goes_on]
        packings = [float(row["packing"]) for row in chosen]
        values = [float(row["time"].lstrip(">")) for row in chosen]
        (line,) = times.semilogy(packings, values, marker, label=label)
        for packing, value, row in zip(packings, values, chosen, strict=True):
            if row["time"].startswith(">"):
                times.annotate("", (packing, 3 * value), (packing, value), arrowprops={"arrowstyle": "->", "color": line.get_color()})
    times.set(xlabel="packing fraction", ylabel="steps until F_s = 1/e", title="200 discs")
    times.set_ylim(top=3e5)
    times.legend(fontsize="small", loc="upper left")
    figure.savefig(options.picture)


if __name__ == "__main__":
    main()
