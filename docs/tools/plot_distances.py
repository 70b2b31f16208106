#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the tables of `carrom accuracy --distances`: how far discs get from those of the exact run, along time.

Lines are medians over starts of the root mean square distance, bands from the lowest to the highest start. The horizons are
where a difference that grows by the largest Lyapunov exponent comes from one rounding, of 1e-16 or 6e-8, to 1: beyond them a
trajectory says nothing, whatever computed it. Writes distances.png, and growth.csv with the growth that was found.
"""
import argparse
import csv
import math
import pathlib
from collections import defaultdict

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

# Largest Lyapunov exponent per collision of a disc by packing, by two trajectories that are drawn together again and again
# (Benettin's method), 64 discs between hard walls, to 1 or 2 %: measured with another program.
EXPONENTS = {0.1: 2.66, 0.2: 1.64, 0.3: 1.15, 0.4: 0.863, 0.5: 0.656}
ROUNDING = {"double": 1e-16, "single": 6e-8}
# (method, K, precision): label, colour, line style, marker
CURVES = {
    ("event-driven", 16, "double"): ("event-driven, double, other syncs (K = 16)", "#000000", "-", "o"),
    ("event-driven", 1, "single"): ("event-driven, single", "#0060b0", "--", "s"),
    ("time-stepped", 256, "double"): ("time-stepped, double, K = 256", "#c05000", "-.", "^"),
    ("time-stepped", 16, "double"): ("time-stepped, double, K = 16", "#777777", ":", "D"),
    ("time-stepped", 1, "double"): ("time-stepped, double, K = 1", "#208040", "-", "v"),
}


def read(paths):
    """{packing: {(method, K, precision): {collisions per disc: distances of all starts}}}; collisions are means over starts."""
    looks = defaultdict(lambda: defaultdict(lambda: defaultdict(list)))
    for path in paths:
        with open(path, newline="") as table:
            lines = csv.DictReader(table)
            if "collisions_per_disc" not in (lines.fieldnames or []):
                raise SystemExit(f"{path}: is no table of `carrom accuracy --distances`")
            for row in lines:
                if row["arithmetic"] == "stable":
                    setting = row["method"], int(row["micro_steps"]), row["precision"]
                    looks[float(row["packing"])][setting][int(row["step"])].append((float(row["collisions_per_disc"]), float(row["distance_rms"])))
    return {packing: {setting: common(steps) for setting, steps in settings.items()} for packing, settings in sorted(looks.items())}


def common(steps):
    """The looks that all starts have: runs differ by one or two, as frequencies of collisions do."""
    most = max(len(pairs) for pairs in steps.values())
    return {np.mean([c for c, _ in pairs]): np.array([d for _, d in pairs]) for _, pairs in sorted(steps.items()) if len(pairs) == most}


def exponent_of(packing):
    return next((value for known, value in EXPONENTS.items() if abs(known - packing) < 0.005), None)


def growth(looks):
    """Slope of the logarithm of the distance per collision, start by start, between 1e-12 and 1e-2; mean and standard error."""
    collisions = np.array(list(looks))
    slopes = []
    for distances in np.array(list(looks.values())).T:
        chosen = (distances > 1e-12) & (distances < 1e-2)
        if chosen.sum() >= 4:
            slopes.append(np.polyfit(collisions[chosen], np.log(distances[chosen]), 1)[0])
    if len(slopes) < 2:
        return None
    return np.mean(slopes), np.std(slopes, ddof=1) / math.sqrt(len(slopes))


def draw(gases, path):
    figure, panels = plt.subplots(1, len(gases), figsize=(4.3 * len(gases), 5.2), layout="constrained", sharey=True, squeeze=False)
    for axes, (packing, settings) in zip(panels.flat, gases.items()):
        for setting, (label, colour, line, marker) in CURVES.items():
            if setting not in settings:
                continue
            looks = [(c, d[d > 0]) for c, d in settings[setting].items() if np.median(d) > 0]
            xs = [c for c, _ in looks]
            axes.fill_between(xs, [d.min() for _, d in looks], [d.max() for _, d in looks], color=colour, alpha=0.12, linewidth=0)
            axes.plot(xs, [np.median(d) for _, d in looks], color=colour, linestyle=line, marker=marker, markersize=4, markevery=max(1, len(xs) // 8),
                      linewidth=1.4, label=label)
        exponent = exponent_of(packing)
        end = max(max(looks) for looks in settings.values())
        if exponent:
            for precision, size in ROUNDING.items():
                horizon = math.log(1 / size) / exponent
                axes.axvline(horizon, color="black", linewidth=1.2, linestyle=(0, (6, 3)))
                axes.annotate(f"horizon, {precision}", (horizon, 2e-17), xytext=(-3, 0), textcoords="offset points", rotation=90, ha="right", va="bottom", fontsize=8)
            xs = np.array([0.22 * end, 0.22 * end + math.log(1e6) / exponent])
            axes.plot(xs, 1e-12 * np.exp(exponent * (xs - xs[0])), color="0.6", linewidth=4, alpha=0.6, zorder=0, label="slope: Lyapunov exponent")
        axes.set(yscale="log", ylim=(1e-17, 1e2), xlim=(0, end), xlabel="collisions per disc (event-driven)", title=f"packing {packing:.3g}")
        axes.grid(True, which="major", color="0.92")
    panels[0, 0].set_ylabel("r.m.s. distance to the exact run, in diameters")
    figure.legend(*panels.flat[0].get_legend_handles_labels(), fontsize=9, loc="outside lower center", ncols=3)
    figure.savefig(path, dpi=120)
    plt.close(figure)


def first_above(looks, limit):
    return next((f"{c:.0f}" for c, d in looks.items() if np.median(d) > limit), f"more than {max(looks):.0f}")


def write_growth(gases, path):
    """A line for each setting: when distances are how large, and how fast roundings grow."""
    with open(path, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["packing", "method", "micro_steps", "precision", "collisions_to_1e-6_sigma", "collisions_to_0.1_sigma", "growth_per_collision",
                         "standard_error", "lyapunov_exponent"])
        for packing, settings in gases.items():
            for (method, k, precision), looks in sorted(settings.items()):
                found = growth(looks) if method == "event-driven" and precision == "double" else None
                numbers = [f"{found[0]:.3f}", f"{found[1]:.3f}", exponent_of(packing) or ""] if found else ["", "", ""]
                writer.writerow([f"{packing:.3g}", method, k, precision, first_above(looks, 1e-6), first_above(looks, 0.1), *numbers])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tables", nargs="+", type=pathlib.Path, help="tables of carrom accuracy --distances")
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("."), help="folder for the figure and the table")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    gases = read(options.tables)
    draw(gases, options.output / "distances.png")
    write_growth(gases, options.output / "growth.csv")


if __name__ == "__main__":
    main()
