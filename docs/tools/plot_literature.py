#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws tables of `tests/physics/literature.py`, `heaps.py`, `silo.py` and `dense` of `flow_studies.py`, each beside itself as PNG. Bars are
standard errors, or the scatter of five starts for heaps."""
import argparse
import csv
import pathlib

import matplotlib.pyplot as plt
import plot_style


def read(path):
    """Columns by name, of numbers where all are; an empty cell is nan."""

    def numbers(words):
        try:
            return [float(word or "nan") for word in words]
        except ValueError:
            return words

    with open(path, newline="") as table:
        rows = list(csv.DictReader(table))
    return {name: numbers([row[name] for row in rows]) for name in rows[0]}


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
                      marker="o", capsize=2)
    axes.set(xlabel="$t / t_0$", ylabel=r"$\sqrt{kT(0) / kT}$ over Haff's law")
    axes.axhline(1, color="black", linewidth=0.8)
    axes.legend()


# Packing fraction and P* of Engel and others, Phys. Rev. E 87, 042134 (2013): 512^2 discs by
# event-driven dynamics, 1024^2 by Monte Carlo.
ENGEL = {
    "512$^2$, Engel and others": ((0.698, 9.169588), (0.700, 9.18640), (0.704, 9.18966), (0.708, 9.18445), (0.716, 9.18282), (0.720, 9.32450)),
    "1024$^2$, Engel and others": (
        (0.698, 9.169342), (0.700, 9.185405), (0.704, 9.18674), (0.708, 9.184959), (0.712, 9.183379), (0.716, 9.18327), (0.720, 9.23083)
    ),
}


def draw_melting(axes, table):
    axes.errorbar(table["packing"], table["P"], table["P_error"], label="128$^2$, Carrom", color="#0060b0", marker="o", capsize=3)
    axes.plot(table["packing"], table["P_known"], label="128$^2$, Li and others", color="black", marker="x", linestyle="none")
    for (label, points), marker in zip(ENGEL.items(), ("^", "s")):
        axes.plot(*zip(*points), label=label, color="0.5", marker=marker, markerfacecolor="white", linestyle="none")
    order = axes.twinx()
    order.errorbar(table["packing"], table["psi6"], table["psi6_error"], label=r"$|\psi_6|$ of all discs, Carrom", color="#c05000", marker="D", linestyle=":")
    order.set(ylabel=r"$|\psi_6|$ of all discs", ylim=(0, 1))
    order.grid(False)
    axes.set(xlabel="packing fraction", ylabel=r"pressure $P^* = P (2r)^2 / kT$", xticks=(0.69, 0.70, 0.71, 0.72, 0.73))
    handles = [one for pair in (axes, order) for one in pair.get_legend_handles_labels()[0]]
    axes.legend(handles=handles, fontsize="small", loc="upper center")


def draw_dense(axes, table):
    """Ratios to Enskog's near freezing, and those of the table of less dense gases."""
    thin = read(pathlib.Path(__file__).parents[1] / "data" / "validation" / "transport.csv")
    for name, colour, marker in (("shear", "#0060b0", "o"), ("bulk", "#703090", "D"), ("conductivity", "#208040", "^"), ("diffusion", "#c05000", "s")):
        axes.errorbar(table["packing"], table[name], table[f"{name}_error"], label=name, color=colour, marker=marker, linewidth=0.8, capsize=3)
        if name in thin:
            known = thin[f"{name}_known"]
            points = [[value / enskog for value, enskog in zip(thin[column], known)] for column in (name, f"{name}_error")]
            axes.errorbar(thin["packing"], *points, color=colour, marker=marker, markerfacecolor="white", linewidth=0.8, capsize=3)
    axes.axhline(1, color="black", linewidth=0.8)
    axes.axvline(0.7, color="black", linewidth=0.8, linestyle=":")
    axes.text(0.7, 0.1, "freezing ", ha="right")
    axes.set(xlabel="packing fraction", ylabel="measured / Enskog's", ylim=(0, None), xlim=(0, 0.72))
    axes.legend(loc="upper left")


def draw_heaps(axes, table):
    for study, fill in (("heap", "full"), ("column", "none")):
        chosen = [k for k, name in enumerate(table["study"]) if name == study]
        for who, colour, marker, aside in (("carrom", "#0060b0", "o", -0.01), ("lammps", "#c05000", "s", 0.01)):
            x = [table["friction"][k] + aside for k in chosen]
            slopes, scatter = ([table[f"slope_{who}{end}"][k] for k in chosen] for end in ("", "_scatter"))
            label = f"{study}, {'Carrom' if who == 'carrom' else 'LAMMPS, soft discs'}"
            axes.errorbar(x, slopes, scatter, label=label, color=colour, marker=marker, fillstyle=fill, linestyle="none", capsize=3)
    axes.set(xlabel="friction", ylabel="slope of the surface in degrees")
    axes.legend()


def draw_silo(axes, table):
    x = table["opening"]
    power = [w ** (2 / 3) for w in table["flow"]]
    errors = [2 / 3 * error * w ** (-1 / 3) for w, error in zip(table["flow"], table["flow_error"])]
    axes.errorbar(x, power, errors, label="Carrom", color="#0060b0", marker="o", linestyle="none", capsize=3)
    law = [w ** (2 / 3) for w in table["law"]]
    slope = (law[-1] - law[0]) / (x[-1] - x[0])
    k = x[0] - law[0] / slope
    axes.plot([k, x[-1]], [0, law[-1]], label=f"Beverloo's law, $k$ = {k:.2f}", color="black", linewidth=0.8)
    axes.set(xlabel="opening in diameters", ylabel="(discs that leave in a step)$^{2/3}$", xlim=(0, None), ylim=(0, None))
    axes.legend()


DRAW = {
    "dense": draw_dense,
    "pressure": lambda axes, table: draw_deviations(axes, table, "Z", r"$Z$ off Kolafa and Rottner's, $10^{-4}$ of it"),
    "li": lambda axes, table: draw_deviations(axes, table, "P", r"$P^*$ off that of Li and others, $10^{-4}$ of it"),
    "enskog": draw_enskog,
    "haff": draw_haff,
    "melting": draw_melting,
    "heaps": draw_heaps,
    "silo": draw_silo,
}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("tables", nargs="+", type=pathlib.Path, help=f"files {', '.join(f'{name}.csv' for name in DRAW)}")
    plot_style.use()
    for path in parser.parse_args().tables:
        if path.stem not in DRAW:
            raise SystemExit(f"{path}: is none of {', '.join(f'{name}.csv' for name in DRAW)}")
        figure, axes = plt.subplots()
        DRAW[path.stem](axes, read(path))
        figure.savefig(path.with_suffix(".png"))
        plt.close(figure)


if __name__ == "__main__":
    main()
