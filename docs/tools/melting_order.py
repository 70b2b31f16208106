#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How far order reaches in 128^2 discs, from liquid to solid: a table of exponents and a picture.

  docs/tools/melting_order.py CARROM RUNS TABLE PICTURE     some 8 core-minutes; needs the package, scipy and matplotlib

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
PACKINGS = {0.69: "liquid", 0.72: "solid at melting", 0.73: "solid"}
# Steps, those before averages begin, and those from frame to frame. A liquid forgets its start sooner.
LENGTHS = {0.69: (10_000, 5_000, 250), 0.72: (32_000, 20_000, 500), 0.73: (32_000, 20_000, 500)}
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


def by_quarters(number, frames):
    """A number of all frames, and its standard error from the scatter of quarters of the run."""
    n = len(frames) // 4
    parts = [number(frames[k * n : (k + 1) * n]) for k in range(4)]
    return number(frames), np.std(parts, ddof=1) / 2


def bond_exponent(frames):
    curve = melting.bond_correlation(frames)
    return melting.decay(curve.r, curve.value, BETWEEN).value


def wave_exponent(frames):
    curve = melting.wave_correlation(frames)
    return melting.decay(curve.r, curve.value, BETWEEN).value


def row_of(packing, run):
    frames = late_frames(run)
    bonds, bonds_error = by_quarters(bond_exponent, frames)
    rows, rows_error = by_quarters(wave_exponent, frames)
    whole = melting.block_order(frames, [1])[0]
    return {
        "packing": packing,
        "phase": PACKINGS[packing],
        "discs": ROWS**2,
        "frames": len(frames),
        "psi6": f"{whole.order.value:.4f}",
        "psi6_error": f"{whole.order.error:.4f}",
        "eta6": f"{bonds:.4f}",
        "eta6_error": f"{bonds_error:.4f}",
        "eta6_most": 0.25,
        "eta": f"{rows:.3f}",
        "eta_error": f"{rows_error:.3f}",
        "eta_most": f"{1 / 3:.4f}",
    }


def draw(runs, path):
    plot_style.use()
    figure, ((bonds, waves), (peak, local)) = plt.subplots(2, 2, figsize=(11, 9))
    for packing, run in runs.items():
        frames = late_frames(run)
        label = f"{packing:g}, {PACKINGS[packing]}"
        for ax, curve in ((bonds, melting.bond_correlation(frames)), (waves, melting.wave_correlation(frames))):
            ax.errorbar(*curve, label=label, marker=".", capsize=2)
        packed = melting.local_packing(frames, 8.0, 400)
        local.hist(packed.ravel(), np.arange(0.63, 0.78, 0.004), density=True, histtype="step", label=label, linewidth=1.5)
    r = np.array([3.0, 30.0])
    bonds.plot(r, 0.55 * (r / 3) ** -0.25, "k--", label="$r^{-1/4}$, least of a hexatic")
    waves.plot(r, 0.5 * (r / 3) ** (-1 / 3), "k--", label="$r^{-1/3}$, least of a solid")
    for ax, name in ((bonds, "$g_6(r)$"), (waves, r"mean of cos $G (r - r')$")):
        ax.set(xscale="log", yscale="log", xlabel="distance in diameters", ylabel=name, ylim=(0.01, 1))
    local.set(xlabel="packing in circles of radius 8", ylabel="probability density")
    solid = max(runs)
    found = melting.structure_map(late_frames(runs[solid]))
    image = peak.pcolormesh(found.kx, found.ky, np.log10(found.s.T), cmap="viridis")
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
    runs = {packing: run_of(options.program, options.runs, packing) for packing in options.packings}
    rows = [row_of(packing, run) for packing, run in runs.items()]
    with open(options.table, "w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, list(rows[0]), lineterminator="\n")
        table.writeheader()
        table.writerows(rows)
    draw(runs, options.picture)


if __name__ == "__main__":
    main()
