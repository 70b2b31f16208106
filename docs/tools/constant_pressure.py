#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws discs at constant pressure: packing over time, and against pressure beside the literature.

  docs/tools/constant_pressure.py CARROM PICTURE     needs the package of src/python

It runs inputs/constant_pressure.toml at two pressures, and reads docs/data/validation/barostat.csv. The picture is
docs/pictures/constant_pressure.png.
"""
import csv
import pathlib

import carrom
import matplotlib.pyplot as plt
import plot_style

TOP = pathlib.Path(__file__).parents[2]
PRESSURES = (7.5, 10.0)


def run_at(program, pressure):
    scene = carrom.read_scene(TOP / "inputs/constant_pressure.toml")
    scene["effects"]["barostat"]["pressure"] = pressure
    return carrom.run(scene, program=program, threads=1)


def main():
    options = plot_style.program_and_picture(__doc__)
    figure, (time, state) = plt.subplots(1, 2, figsize=(11, 4.5))
    for pressure in PRESSURES:
        history = run_at(options.program, pressure).tables["volume_history"]
        time.plot(history["step"], history["packing"], label=f"P d² / kT = {pressure:g}", linewidth=1)
    time.set(xlabel="step", ylabel="packing fraction")
    time.legend()
    with open(TOP / "docs/data/validation/barostat.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    for phase, marker in (("liquid", "o"), ("solid", "s")):
        chosen = [row for row in rows if row["phase"] == phase]
        pressures = [float(row["P"]) for row in chosen]
        state.plot([float(row["packing_known"]) for row in chosen], pressures, "kx", markersize=10)
        state.errorbar(
            [float(row["packing"]) for row in chosen], pressures, xerr=[float(row["packing_error"]) for row in chosen],
            marker=marker, linestyle="none", markerfacecolor="none", capsize=3, label=f"constant pressure, {phase}",
        )
    state.plot([], [], "kx", markersize=10, label="constant volume")
    state.axvspan(0.700, 0.716, color="0.9", label="coexistence in an endless box")
    state.set(xlabel="packing fraction", ylabel="P d² / kT")
    state.legend(fontsize="small")
    figure.savefig(options.picture)


if __name__ == "__main__":
    main()
