#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Run scenes that measure fields and correlations, and draw what they have measured.

  build/python/bin/python docs/tools/fields.py build/carrom [NAME ...] [--output docs/pictures]

NAME is shock, transport, heat_between_walls or slow_liquid. Together they take some minutes.
"""
import argparse
import pathlib
import subprocess
import tempfile

import matplotlib.pyplot as plt
import numpy as np
import plot_style

TOP = pathlib.Path(__file__).resolve().parents[2]
LABELS = {
    "shear": "shear viscosity", "bulk": "bulk viscosity", "conductivity": "thermal conductivity",
    "scattering": r"$F_s$ at $k = \pi/r$", "squares": "mean square displacement",
    "chi_4": r"$\chi_4$ of the overlap",
}


def read(path):
    """Columns of a table by name."""
    return np.genfromtxt(path, delimiter=",", names=True, comments="#",
                         skip_header=sum(line.startswith("#") for line in open(path)))


def draw_shock(figure, measured):
    """Profiles at the end, with what Rankine and Hugoniot's jumps give behind the front."""
    table = read(measured / "profiles.csv")
    table = table[table["to_step"] == table["to_step"].max()]
    curves = (("density", table["density"], 0.7490), ("kT", table["temperature"], 1.9130),
              ("pressure", table["xx"] + table["contact_xx"], 2.1787))
    for axes, (name, values, known) in zip(figure.subplots(1, 3), curves):
        axes.plot(table["x"], values, color="#0060b0", label="run")
        axes.axhline(known, color="black", linewidth=1, linestyle="--", label="jumps")
        axes.set(xlabel="x", ylabel=name, ylim=(0, 1.15 * np.nanmax(values)))
    figure.axes[0].legend(loc="lower right")


def draw_transport(figure, measured):
    """Coefficients by the time up to which currents are correlated; dashes are Enskog's."""
    table = read(measured / "transport.csv")
    table = table[table["steps"] <= 128]
    curves = (("shear", 0.3138), ("bulk", 0.1449), ("conductivity", 1.4837))
    for axes, (name, known) in zip(figure.subplots(1, 3), curves):
        axes.semilogx(table["steps"], table[f"{name}_slope"], ".-", color="#c05000",
                      label="Green-Kubo")
        axes.errorbar(table["steps"], table[name], table[f"{name}_error"], color="#0060b0",
                      label="Helfand")
        axes.axhline(known, color="black", linewidth=1, linestyle="--", label="Enskog")
        highest = max(np.nanmax(table[f"{name}_slope"]), np.nanmax(table[name]))
        axes.set(xlabel="steps", ylabel=LABELS[name], ylim=(0, 1.1 * highest))
    figure.axes[0].legend()


def draw_heat_between_walls(figure, measured):
    """Temperature, and the flow of heat with its two parts; dashes are what the walls give."""
    table = read(measured / "profiles.csv")
    walls = read(measured / "wall_exchange.csv")
    places = np.unique(table["x"])
    def mean(column):
        return np.array([table[column][table["x"] == x].mean() for x in places])
    left, right = figure.subplots(1, 2)
    left.plot(places, mean("temperature"), ".-", color="#c05000")
    left.set(xlabel="x", ylabel="kT", ylim=(0, None))
    carried, passed = mean("heat_x"), mean("contact_heat_x")
    right.plot(places, carried + passed, ".-", color="#0060b0", label="both")
    right.plot(places, carried, ".-", color="#c05000", label="carried by discs")
    right.plot(places, passed, ".-", color="#208040", label="passed on in collisions")
    right.axhline((walls["left_heat"] - walls["right_heat"]) / 2, color="black", linewidth=0.8,
                  linestyle="--")
    # Room above the curves for the legend.
    right.set(xlabel="x", ylabel="flow of heat", ylim=(0, 1.45 * (carried + passed).max()))
    right.legend(loc="upper right")


def draw_slow_liquid(figure, measured):
    """F_s, mean square displacement and chi_4 of small and large discs."""
    for axes, (name, scale) in zip(figure.subplots(1, 3), (("scattering", "linear"),
                                                           ("squares", "log"),
                                                           ("chi_4", "linear"))):
        for kind, colour in ((1, "#0060b0"), (2, "#c05000")):
            table = read(measured / f"correlations_{kind}.csv")
            table = table[table["count"] >= 25]
            axes.plot(table["steps"], table[name], ".-", color=colour,
                      label=("small", "large")[kind - 1])
        axes.set(xlabel="steps", ylabel=LABELS[name], xscale="log", yscale=scale)
    figure.axes[0].legend()


PICTURES = {"shock": draw_shock, "transport": draw_transport,
            "heat_between_walls": draw_heat_between_walls, "slow_liquid": draw_slow_liquid}
SCENES = {"heat_between_walls": "conduction"} # where its name is another one
MORE = {"heat_between_walls": ["output.measurements.quantities=['profiles', 'wall_exchange']",
                               "output.measurements.from_step=2000",
                               "output.measurements.profile_columns=20",
                               "output.measurements.profile_rows=1"]}


def main():
    """Draw the pictures that are asked for."""
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("names", nargs="*", metavar="NAME", choices=[*PICTURES, []])
    parser.add_argument("--output", type=pathlib.Path, default=TOP / "docs/pictures")
    options = parser.parse_args()
    plot_style.use()
    for name in options.names or PICTURES:
        with tempfile.TemporaryDirectory() as folder:
            settings = [word for text in MORE.get(name, []) for word in ("--set", text)]
            subprocess.run([options.program.resolve(), "run",
                            TOP / f"inputs/{SCENES.get(name, name)}.toml", "--quiet",
                            "-o", f"{folder}/run", *settings], check=True)
            figure = plt.figure(figsize=(11, 3.6))
            PICTURES[name](figure, pathlib.Path(folder, "run/measurements"))
            figure.savefig(options.output / f"{name}.png", dpi=100)


if __name__ == "__main__":
    main()
