#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the tables of `tests/physics/literature.py`, each beside itself as PNG. Bars are standard errors."""
import argparse
import csv
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def read(path):
    """Columns of numbers by name; an empty cell is nan."""
    with open(path, newline="") as table:
        rows = list(csv.DictReader(table))
    return {name: [float(row[name] or "nan") for row in rows] for name in rows[0]}


def draw_deviations(axes, table, name, label):
    """How far a column is from what is known, along the packing fraction."""
    for x, found, error, known, known_error in zip(table["packing"], table[name], table[f"{name}_error"], table[f"{name}_known"],
                                                   table[f"{name}_known_error"]):
        axes.errorbar(x, (found - known) / known * 1e4, error / known * 1e4, marker="o", color="#0060b0", capsize=3)
        axes.errorbar(x, 0, known_error / known * 1e4, marker="_", color="black", capsize=3)
    axes.set(xlabel="packing fraction", ylabel=label, xticks=table["packing"])


def draw_enskog(axes, table):
    for name, label, colour, marker in (("decay", "first decay of velocities", "#0060b0", "o"), ("D", "diffusion, 10 to 20 free times", "#c05000", "s")):
        axes.errorbar(table["packing"], table[name], table[f"{name}_error"], label=label, color=colour, marker=marker, linestyle="none", capsize=3)
    axes.set(xlabel="packing fraction", ylabel="measured / Enskog's")
    axes.axhline(1, color="black", linewidth=0.8)
    axes.legend()


def draw_haff(axes, table):
    for restitution, colour in ((0.98, "#0060b0"), (0.95, "#208040"), (0.9, "#c05000")):
        chosen = [k for k, e in enumerate(table["restitution"]) if e == restitution]
        axes.errorbar(*([table[name][k] for k in chosen] for name in ("time", "ratio", "ratio_error")), label=f"restitution {restitution}", color=colour,
                      marker="o", markersize=3, capsize=2)
    axes.set(xlabel="$t / t_0$", ylabel=r"$\sqrt{kT(0) / kT}$ over Haff's law")
    axes.axhline(1, color="black", linewidth=0.8)
    axes.legend()


DRAW = {
    "pressure": lambda axes, table: draw_deviations(axes, table, "Z", r"$Z$ off Kolafa and Rottner's, $10^{-4}$ of it"),
    "li": lambda axes, table: draw_deviations(axes, table, "P", r"$P^*$ off that of Li and others, $10^{-4}$ of it"),
    "enskog": draw_enskog,
    "haff": draw_haff,
}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("tables", nargs="+", type=pathlib.Path, help=f"files {', '.join(f'{name}.csv' for name in DRAW)}")
    for path in parser.parse_args().tables:
        if path.stem not in DRAW:
            raise SystemExit(f"{path}: is none of {', '.join(f'{name}.csv' for name in DRAW)}")
        figure, axes = plt.subplots(figsize=(5, 3.4), layout="constrained")
        DRAW[path.stem](axes, read(path))
        figure.savefig(path.with_suffix(".png"), dpi=100)
        plt.close(figure)


if __name__ == "__main__":
    main()
