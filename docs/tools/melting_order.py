#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How far order reaches in 128^2 discs, from liquid to solid: a table of exponents and a picture.

  docs/tools/melting_order.py CARROM RUNS TABLE PICTURE     some 12 core-minutes; needs the package, scipy and matplotlib

Runs begin from a crystal and are kept in the folder RUNS, so that a second call only draws.
docs/data/validation/melting_order.csv and docs/pictures/melting_order.png are made by it.
"""
import argparse
import csv
import math
import pathlib

import carrom
import matplotlib.pyplot as plt
import numpy as np
import plot_style
from carrom import melting

ROWS = 128
PACKINGS = {0.69: "liquid", 0.718: "hexatic", 0.72: "where a solid melts", 0.73: "solid"}
# Steps, those before averages begin, and those from frame to frame. A liquid forgets its start sooner.
LENGTHS = {0.69: (10_000, 5_000, 250)} | dict.fromkeys((0.718, 0.72, 0.73), (32_000, 20_000, 500))
DRAWN = (0.69, 0.72, 0.73)
SIDES = ("left", "right", "bottom", "top")
BETWEEN = (4.0, 24.0)  # diameters, over which powers are fitted


def scene_of(packing):
    """Discs of diameter 1 that collide about once in a step."""
    spacing = math.sqrt(math.pi / (2 * math.sqrt(3) * packing))
    width = ROWS * spacing
    steps, early, every = LENGTHS[packing]
    return {
        "box": {"size": [width, width * math.sqrt(3) / 2]} | {side: {"kind": "periodic"} for side in SIDES},
        "discs": {
            "count": ROWS**2,
            "packing": packing,
            "generator": "triangular",
            "speed": math.sqrt(math.pi / 8) / (9.2 * math.pi / 4 / packing - 1),
            "seed": 1,
        },
        "time": {"steps": steps, "method": "event-driven"},
        "output": {
            "averages_from_step": early,
            "trajectory": {"every_steps": every, "fields": ["position", "psi6"]},
            "measurements": {
                "quantities": ["psi6", "structure_factor", "radial_distribution"],
                "every_steps": every,
                "from_step": early,
                "bins": 640,
                "largest_distance": 32.0,
                "largest_wavenumber": 9.0,
            },
        },
    }


def run_of(program, folder, packing):
    path = folder / f"r{packing}"
    if (path / "report.json").exists():
        return carrom.open(path)
    return carrom.run(scene_of(packing), program=program, threads=1, folder=path)


def late_frames(run):
    early = run.scene["output"]["averages_from_step"]
    return [frame for frame in run.frames if frame.step >= early]


def curves_of(frames):
    """Distances, and g6 and the order of places of each frame."""
    bonds, waves = ([f([frame]) for frame in frames] for f in (melting.bond_correlation, melting.wave_correlation))
    return bonds[0].r, np.array([one.value for one in bonds]), np.array([one.value for one in waves])


def exponent_of(r, curves):
    """The power of the mean curve, and its standard error from the scatter of quarters of the run."""
    quarters = [melting.decay(r, part.mean(axis=0), BETWEEN).value for part in np.array_split(curves, 4)]
    return melting.decay(r, curves.mean(axis=0), BETWEEN).value, np.std(quarters, ddof=1) / 2


def row_of(packing, frames, r, bonds, waves):
    whole = melting.block_order(frames, [1])[0]
    row = {"packing": packing, "phase": PACKINGS[packing], "discs": ROWS**2, "frames": len(frames)}
    row |= {"psi6": f"{whole.order.value:.4f}", "psi6_error": f"{whole.order.error:.4f}"}
    if whole.order.value < 0.2:  # a liquid has no powers
        return row | dict.fromkeys(("eta6", "eta6_error", "eta6_most", "eta", "eta_error", "eta_most"), "")
    for name, curves, most in (("eta6", bonds, 1 / 4), ("eta", waves, 1 / 3)):
        value, error = exponent_of(r, curves)
        row |= {name: f"{value:.4f}", f"{name}_error": f"{error:.4f}", f"{name}_most": f"{most:.4f}"}
    return row


def draw(found, path):
    plot_style.use()
    figure, ((bonds, waves), (peak, local)) = plt.subplots(2, 2, figsize=(11, 9))
    for packing, (frames, r, *curves) in found.items():
        if packing not in DRAWN:
            continue
        label = f"{packing:g}, {PACKINGS[packing]}"
        for ax, curve in zip((bonds, waves), curves):
            ax.plot(r, curve.mean(axis=0), label=label, marker=".")
        packed = melting.local_packing(frames[::2], 8.0, 400)
        local.hist(packed.ravel(), np.arange(0.63, 0.78, 0.004), density=True, histtype="step", label=label, linewidth=1.5)
    r = np.array([3.0, 30.0])
    bonds.plot(r, 0.55 * (r / 3) ** -0.25, "k--", label="$r^{-1/4}$, least of a hexatic")
    waves.plot(r, 0.5 * (r / 3) ** (-1 / 3), "k--", label="$r^{-1/3}$, least of a solid")
    for ax, name in ((bonds, "$g_6(r)$"), (waves, r"mean of cos $G (r - r')$")):
        ax.set(xscale="log", yscale="log", xlabel="distance in diameters", ylabel=name, ylim=(0.01, 1))
    local.set(xlabel="packing in circles of radius 8", ylabel="probability density")
    solid = max(found)
    kx, ky, s = melting.structure_map(found[solid][0])
    image = peak.pcolormesh(kx, ky, np.log10(s.T), cmap="viridis")
    figure.colorbar(image, ax=peak, label=f"log10 S(kx, ky), packing {solid:g}")
    peak.set(xlabel="kx in 1 / diameters", ylabel="ky", aspect="equal")
    peak.grid(False)
    for ax in (bonds, waves, local):
        ax.legend(fontsize="x-small")
    figure.savefig(path)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", metavar="CARROM")
    for name in ("runs", "table", "picture"):
        parser.add_argument(name, metavar=name.upper(), type=pathlib.Path)
    parser.add_argument("--packings", type=float, nargs="+", choices=PACKINGS, default=list(PACKINGS))
    options = parser.parse_args()
    found = {}
    for packing in options.packings:
        frames = late_frames(run_of(options.program, options.runs, packing))
        found[packing] = (frames, *curves_of(frames))
    rows = [row_of(packing, *numbers) for packing, numbers in found.items()]
    with open(options.table, "w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        table.writeheader()
        table.writerows(rows)
    draw(found, options.picture)


if __name__ == "__main__":
    main()
