#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws the tables of `carrom accuracy`: error against cost, error against nu dt, cost against N, and what formulas lose.
With --page it also writes which method is fastest for a wanted error, and at which speed both cost the same.

Errors are taken start by start, against the event-driven method (double, stable, K = 1) from the same start; bars are one standard
error over starts. Costs are medians over starts and repetitions, with bars from quartile to quartile, in core-microseconds
per disc and mean free time (that of the event-driven method), which is physical time; ratios of costs are taken within a start and
repetition. A figure is drawn where the tables have what it needs. points.csv gets the numbers.
"""
import argparse
import csv
import math
import pathlib
from collections import defaultdict

import matplotlib

matplotlib.use("Agg")
import matplotlib.lines
import matplotlib.pyplot as plt
import matplotlib.ticker
import numpy as np

STYLES = [("o", "-"), ("s", "--"), ("^", "-."), ("D", ":"), ("v", "-"), ("P", "--")]
GREYS = ["#000000", "#c05000", "#0060b0", "#777777", "#208040", "#a040a0"]
FORMULAS = [("stable", "off"), ("naive", "off"), ("naive", "on")]
NAMES = {("stable", "off"): "stable", ("naive", "off"): "naive", ("naive", "on"): "naive, contracted"}
LAWS = [(precision, *formula) for precision in ("double", "single") for formula in FORMULAS]
EXACT = ("event-driven", 1, "double", "stable", "off")


def read(paths):
    rows = []
    for path in paths:
        try:
            with open(path, newline="") as table:
                lines = csv.DictReader(table)
                if "core_seconds" not in (lines.fieldnames or []):
                    raise SystemExit(f"{path}: is no table of `carrom accuracy`" +
                                     (" but one of distances: plot_distances.py draws it" if "collisions_per_disc" in (lines.fieldnames or []) else ""))
                rows += list(lines)
        except (OSError, UnicodeDecodeError) as error:
            raise SystemExit(f"{path}: cannot be read: {error}") from None
    return rows


def setting_of(row):
    return row["method"], int(row["micro_steps"]), row["precision"], row["arithmetic"], row["contraction"]


class Point:
    """A setting of one gas, over its starts."""

    def __init__(self, rows, exact):
        good = [row for row in rows if not row["failure"] and (row["start_hash"], row["steps"]) in exact]
        everything = [(row, exact[row["start_hash"], row["steps"]]) for row in good]
        pairs = [(row, reference) for row, reference in everything if row["repetition"] == "0"] # the others have the same bits
        self.n_starts = len(pairs)
        self.rate = self.mean([float(a["collision_frequency"]) / float(b["collision_frequency"]) - 1 for a, b in pairs])
        self.wall = self.mean([float(a["wall_pressure"]) / float(b["wall_pressure"]) - 1 for a, b in pairs])
        self.pressure = self.mean([float(a["virial_pressure"]) / float(b["virial_pressure"]) - 1 for a, b in pairs])
        self.identity = self.mean([float(b["wall_pressure"]) / float(b["virial_pressure"]) - 1 for _, b in pairs])
        self.overlaps = self.mean([float(a["overlapping_pairs_per_disc"]) for a, _ in pairs])
        self.deepest = max([float(a["deepest_overlap"]) for a, _ in pairs], default=0)
        self.distance = self.mean([float(a["distance_rms"]) for a, _ in pairs])
        self.collisions = self.mean([int(a["steps"]) * float(b["collision_frequency"]) for a, b in pairs])[0]
        # Root mean square, in diameters per micro-step.
        self.speed = self.mean([math.sqrt(2 * float(a["kinetic_energy"]) / int(a["n_discs"])) / (2 * float(a["radius"]) * int(a["micro_steps"]))
                                for a, _ in pairs])[0]
        self.nu_dt = self.mean([float(b["collision_frequency"]) / int(a["micro_steps"]) for a, b in pairs])[0]
        self.runs = {(a["start"], a["repetition"]): 1e6 * float(a["core_seconds"]) / (int(a["n_discs"]) * int(a["steps"]) * float(b["collision_frequency"]))
                     for a, b in everything}
        self.costs = np.percentile(list(self.runs.values()), [25, 50, 75]) if self.runs else np.full(3, np.nan)
        self.cost = self.costs[1]
        # What is no trajectory of hard discs any more: it stopped, or the event-driven method has let discs into each other.
        self.failures = sum(1 for row in rows if row["failure"] or (row["method"] == "event-driven" and float(row["overlapping_pairs_per_disc"]) > 0))

    def cost_ratios(self, other):
        """Quartiles of the cost over that of another setting, within the same start and repetition."""
        ratios = [cost / other.runs[run] for run, cost in self.runs.items() if run in other.runs]
        return np.percentile(ratios, [25, 50, 75]) if ratios else np.full(3, np.nan)

    def spread(self):
        """Of the costs of one start's repetitions, largest over smallest less 1: the median over starts."""
        by_start = defaultdict(list)
        for (start, _), cost in self.runs.items():
            by_start[start].append(cost)
        return float(np.median([max(costs) / min(costs) - 1 for costs in by_start.values()]))

    @staticmethod
    def mean(values):
        if not values:
            return math.nan, math.nan
        error = np.std(values, ddof=1) / math.sqrt(len(values)) if len(values) > 1 else math.nan
        return float(np.mean(values)), float(error)


def points_by_gas(rows):
    """{(packing, N): {setting: Point}}"""
    gases = defaultdict(lambda: defaultdict(list))
    for row in rows:
        gases[float(row["packing"]), int(row["n_discs"])][setting_of(row)].append(row)
    result = {}
    for gas, settings in sorted(gases.items()):
        exact = {(r["start_hash"], r["steps"]): r for r in settings.get(EXACT, []) if not r["failure"] and r["repetition"] == "0"}
        result[gas] = {setting: Point(rs, exact) for setting, rs in settings.items()}
    return result


def default_curve(points):
    """Points of the time-stepped method as runs use it, by K."""
    return sorted((s[1], p) for s, p in points.items() if s[0] == "time-stepped" and s[2:] == ("double", "stable", "off"))


def exact_point(points):
    return points.get(EXACT)


def law_name(law):
    return f"{law[0]}, {NAMES[law[1:]]}"


def curve_of(points, method, law):
    return sorted((s[1], p) for s, p in points.items() if s[0] == method and s[2:] == law)


def bars(quartiles):
    """Medians, and the lengths of bars down and up to the quartiles."""
    quartiles = np.array(quartiles)
    return quartiles[:, 1], [quartiles[:, 1] - quartiles[:, 0], quartiles[:, 2] - quartiles[:, 1]]


def draw_errors(axes, xs, means, index, label, x_bars=None):
    """Errors with bars; hollow where an error is less than two standard errors: nothing but noise is known of it there."""
    marker, line = STYLES[index]
    values, errors = np.array([abs(m[0]) for m in means]), np.array([m[1] for m in means])
    lower = np.minimum(errors, 0.9 * values)
    axes.errorbar(xs, values, yerr=[lower, errors], xerr=x_bars, marker=marker, linestyle=line, color=GREYS[index], label=label, capsize=2, linewidth=1.2,
                  markersize=5, markerfacecolor="white")
    clear = values > 2 * errors
    axes.plot(np.array(xs)[clear], values[clear], marker=marker, linestyle="none", color=GREYS[index], markersize=5, zorder=4)


def plain_ticks(axis):
    axis.set_major_locator(matplotlib.ticker.LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter(matplotlib.ticker.FormatStrFormatter("%g"))
    axis.set_minor_formatter(matplotlib.ticker.NullFormatter())


def slope_one(axes, x, y, factor, rising):
    xs = np.array([x, x * factor])
    axes.plot(xs, y * (xs / x) ** (1 if rising else -1), color="0.6", linewidth=3, alpha=0.6, zorder=0, label="slope 1 (first order)" if rising else "slope -1 (first order)")


def crossover(points):
    """Error, K and speed at which the time-stepped method costs as much as the event-driven method; None where no K or every K costs more."""
    curve, exact = default_curve(points), exact_point(points)
    if exact is None or not curve or curve[0][1].cost >= exact.cost:
        return None
    for (k1, a), (k2, b) in zip(curve, curve[1:]):
        if b.cost >= exact.cost:
            share = math.log(exact.cost / a.cost) / math.log(b.cost / a.cost)
            return (math.exp((1 - share) * math.log(abs(a.rate[0])) + share * math.log(abs(b.rate[0]))), k1, k2,
                    math.exp((1 - share) * math.log(a.speed) + share * math.log(b.speed)))
    return None


def figure_error_against_cost(gases, path):
    n_columns = min(2, len(gases))
    n_rows = -(-len(gases) // n_columns)
    figure, panels = plt.subplots(n_rows, n_columns, figsize=(1.5 + 4.25 * n_columns, 0.8 + 4 * n_rows), layout="constrained", sharey=True, squeeze=False)
    for axes in panels.flat[len(gases):]:
        axes.remove()
    for axes, ((packing, n), points) in zip(panels.flat, gases.items()):
        curve, exact = default_curve(points), exact_point(points)
        costs, cost_bars = bars([p.costs for _, p in curve])
        draw_errors(axes, costs, [p.rate for _, p in curve], 0, "collision rate", cost_bars)
        draw_errors(axes, costs, [p.pressure for _, p in curve], 1, "pressure (virial)")
        draw_errors(axes, costs, [p.wall for _, p in curve], 2, "pressure (walls)")
        floor = np.median([p.rate[1] for _, p in curve])
        axes.axhspan(1e-5, 2 * floor, color="0.9", zorder=-1, label="statistical floor (2 st. errors of the rate)")
        middle = curve[len(curve) // 2][1]
        slope_one(axes, middle.cost / 2, 9 * abs(middle.rate[0]), 16, rising=False)
        axes.axvspan(exact.costs[0], exact.costs[2], color="0.75", zorder=-1)
        axes.axvline(exact.cost, color="black", linewidth=1.6, linestyle=(0, (6, 2)), label="cost of the event-driven method")
        for k, p in curve:
            if k in (1, 4, 16, 64, 256):
                axes.annotate(f"K={k}", (p.cost, abs(p.rate[0])), xytext=(-5, 4) if k == 1 else (5, 5), textcoords="offset points",
                              ha="right" if k == 1 else "left", fontsize=8, bbox={"pad": 0.5, "color": "white", "alpha": 0.7})
        failed = [p for p in points.values() if p.failures]
        if failed:
            axes.plot([p.cost for p in failed], [np.clip(abs(p.rate[0]), 4e-4, 1) for p in failed], "X", color="black", markersize=8, label="some starts failed")
        axes.set(xscale="log", yscale="log", ylim=(3e-4, 1.2), title=f"packing {packing:.3g}, {n} discs")
        axes.set_xlabel("cost: core-microseconds per disc and mean free time")
        axes.set_xlim(0.62 * min(costs[0], exact.cost), 1.9 * costs[-1])
        plain_ticks(axes.xaxis)
        axes.grid(True, which="major", color="0.92")
    for axes in panels[:, 0]:
        axes.set_ylabel("relative error")
    figure.legend(*panels.flat[0].get_legend_handles_labels(), fontsize=8.5, loc="outside lower center", ncols=1 + n_columns)
    figure.savefig(path, dpi=120)
    plt.close(figure)


def figure_both_methods(gases, path):
    """One panel: the time-stepped method's error against its cost, and as a line of the same colour what the event-driven method costs, which has none."""
    figure, axes = plt.subplots(figsize=(7.6, 5), layout="constrained")
    handles = []
    for index, ((packing, _), points) in enumerate(gases.items()):
        curve, exact = default_curve(points), exact_point(points)
        costs, cost_bars = bars([p.costs for _, p in curve])
        draw_errors(axes, costs, [p.rate for _, p in curve], index, None, cost_bars)
        axes.axvline(exact.cost, color=GREYS[index], linewidth=2, linestyle=STYLES[index][1])
        handles.append(matplotlib.lines.Line2D([], [], color=GREYS[index], marker=STYLES[index][0], linestyle=STYLES[index][1], label=f"packing {packing:.3g}"))
        for k, p in curve:
            if k in ((1, 32, 256) if index == len(gases) - 1 else ()):
                axes.annotate(f"K = {k}", (p.cost, abs(p.rate[0])), xytext=(6, 5), textcoords="offset points", fontsize=10, color=GREYS[index])
    axes.set_xlim(right=1)
    costs = [exact_point(points).cost for points in gases.values()]
    axes.annotate("event-driven method:\nno error", (min(costs), 1.6e-3), xytext=(-8, 0), textcoords="offset points", ha="right", va="bottom", fontsize=11)
    axes.annotate("time-stepped method:\nK micro-steps a step", (0.03, 0.66), xycoords="axes fraction", fontsize=11)
    n = next(iter(gases))[1]
    axes.set(xscale="log", yscale="log", ylim=(1e-3, 1), title=f"{n:,} discs, one core", ylabel="error of the collision rate",
             xlabel="cost: core-microseconds per disc and mean free time")
    axes.yaxis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda y, _: f"{100 * y:g} %"))
    plain_ticks(axes.xaxis)
    axes.grid(True, which="major", color="0.92")
    axes.legend(handles=handles, fontsize=10, loc="upper right")
    with plt.rc_context({"svg.hashsalt": "carrom"}):
        figure.savefig(path, metadata={"Date": None})
    plt.close(figure)


def figure_error_against_nu_dt(gases, path):
    figure, panels = plt.subplots(1, 2, figsize=(10, 4.6), layout="constrained")
    for index, ((packing, _), points) in enumerate(gases.items()):
        curve = default_curve(points)
        nu_dt = [p.nu_dt for _, p in curve]
        draw_errors(panels[0], nu_dt, [p.rate for _, p in curve], index, f"packing {packing:.3g}")
        panels[1].errorbar(nu_dt, [p.overlaps[0] for _, p in curve], yerr=[p.overlaps[1] for _, p in curve], marker=STYLES[index][0],
                           linestyle=STYLES[index][1], color=GREYS[index], label=f"packing {packing:.3g}", capsize=2, linewidth=1.2, markersize=5)
    slope_one(panels[0], 1e-3, 1.3e-3, 200, rising=True)
    slope_one(panels[1], 1e-3, 2e-4, 200, rising=True)
    panels[0].set(ylabel="collisions lost, of those of the event-driven method", ylim=(1e-4, 1.2))
    panels[1].set(ylabel="overlapping pairs that a disc is in")
    for axes in panels:
        axes.set(xscale="log", yscale="log", xlabel=r"$\nu\,dt$: collisions per disc and micro-step (event-driven)")
        axes.grid(True, which="major", color="0.92")
    panels[0].legend(fontsize=8)
    figure.savefig(path, dpi=120)
    plt.close(figure)


def figure_cost_against_size(gases, path):
    figure, panels = plt.subplots(2, 2, figsize=(11, 8.4), layout="constrained", sharex=True)
    sizes = np.array([n for _, n in gases])
    for column, (method, title) in enumerate((("time-stepped", "time-stepped method, K = 1"), ("event-driven", "event-driven method"))):
        usual = [points[method, 1, *LAWS[0]] for points in gases.values()]
        for index, law in enumerate(LAWS):
            points = [gas[method, 1, *law] for gas in gases.values()]
            shift = sizes * 1.04 ** (index - 2.5) # side by side
            style = {"marker": STYLES[index][0], "linestyle": STYLES[index][1], "color": GREYS[index], "label": law_name(law), "markersize": 5, "capsize": 2}
            costs, cost_bars = bars([p.costs for p in points])
            panels[0, column].errorbar(shift, costs * sizes * 1e-6, yerr=np.array(cost_bars) * sizes * 1e-6, **style)
            if index > 0:
                ratios, ratio_bars = bars([p.cost_ratios(base) for p, base in zip(points, usual)])
                panels[1, column].errorbar(shift, ratios, yerr=ratio_bars, **style)
        panels[0, column].set(xscale="log", yscale="log", title=title)
        panels[1, column].axhline(1, color="black", linewidth=0.8)
        panels[1, column].set(xscale="log", xlabel="number of discs N", ylim=(0.8, 1.4))
        panels[0, column].legend(fontsize=8)
        for axes in panels[:, column]:
            axes.grid(True, which="major", color="0.92")
    panels[0, 0].set_ylabel("core-seconds per mean free time")
    panels[1, 0].set_ylabel("cost over that of double, stable")
    figure.savefig(path, dpi=120)
    plt.close(figure)


def figure_formulas(gases, path):
    (gas, points), = list(gases.items())[:1]
    figure, panels = plt.subplots(1, 2, figsize=(11, 4.8), layout="constrained", sharey=True)
    for axes, method in zip(panels, ("time-stepped", "event-driven")):
        base = dict(curve_of(points, method, LAWS[0])) if method == "time-stepped" else defaultdict(lambda: exact_point(points))
        for index, law in enumerate(LAWS):
            curve = curve_of(points, method, law)
            if not curve or (method == "event-driven" and index == 0):
                continue
            shift = 1 + 0.02 * (index - 2.5)
            axes.errorbar([shift * k for k, _ in curve], [100 * ((1 + p.rate[0]) / (1 + base[k].rate[0]) - 1) for k, p in curve],
                          yerr=[100 * p.rate[1] / (1 + base[k].rate[0]) for k, p in curve], marker=STYLES[index][0],
                          linestyle=STYLES[index][1], color=GREYS[index], label=law_name(law), capsize=2, markersize=5, linewidth=1.2)
        axes.axhline(0, color="black", linewidth=0.8)
        axes.set(xscale="log", xlabel="micro-steps K per step", title=f'{method} method, packing {gas[0]:.3g}, {gas[1]} discs')
        ticks = sorted({s[1] for s in points})
        axes.set_xticks(ticks, [str(k) for k in ticks])
        axes.minorticks_off()
        axes.grid(True, color="0.92")
    panels[0].set_ylabel("collision rate against double, stable (%)")
    figure.legend(*panels[0].get_legend_handles_labels(), fontsize=9, loc="outside lower center", ncols=3)
    figure.savefig(path, dpi=120)
    plt.close(figure)


def percent(mean):
    return f"{100 * mean[0]:.2f} ± {100 * mean[1]:.2f}"


POINT_COLUMNS = ["study", "packing", "discs", "starts", "collisions_per_disc", "method", "micro_steps", "precision", "arithmetic", "contraction", "nu_dt",
                 "rate_error_percent", "rate_standard_error", "virial_pressure_error_percent", "virial_pressure_standard_error", "wall_pressure_error_percent",
                 "wall_pressure_standard_error", "overlapping_pairs_per_disc", "deepest_overlap", "distance", "cost_us", "cost_us_lower_quartile",
                 "cost_us_upper_quartile", "failures"]


def write_points(studies, path):
    """A line for each setting of each gas: means over starts, and costs."""
    with open(path, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(POINT_COLUMNS)
        for study, gases in studies.items():
            for (packing, n), points in gases.items():
                for setting, p in sorted(points.items()):
                    numbers = [p.nu_dt, *(100 * value for mean in (p.rate, p.pressure, p.wall) for value in mean), p.overlaps[0], p.deepest, p.distance[0],
                               p.cost, p.costs[0], p.costs[2]]
                    writer.writerow([study, f"{packing:.3g}", n, p.n_starts, f"{p.collisions:.0f}", *setting, *(f"{number:.4g}" for number in numbers), p.failures])


def as_table(heading, rows):
    return "\n".join(["| " + " | ".join(heading) + " |", "|" + "---|" * len(heading)] + ["| " + " | ".join(row) + " |" for row in rows])


def crossover_text(points):
    crossing, first, exact = crossover(points), default_curve(points)[0][1], exact_point(points)
    if crossing:
        return f"{100 * crossing[0]:.2g} %, K = {crossing[1]} to {crossing[2]}", f"{crossing[3]:.2g}"
    return "always slower" if first.cost >= exact.cost else "always faster", ""


def crossover_table(errors, large):
    rows = []
    for gases in (errors, large):
        for (packing, n), points in gases.items():
            exact, first = exact_point(points), default_curve(points)[0][1]
            rows.append([f"{packing:.3g}", str(n), str(exact.n_starts), f"{exact.cost:.3f}", f"{first.cost:.3f}", percent(first.rate), *crossover_text(points)])
    return as_table(["packing", "discs", "starts", "event-driven, µs", "time-stepped K = 1, µs", "its error of the collision rate, %", "equal cost at",
                     "speed there"], rows)


WANTED = (0.1, 0.01, 0.001)


def answer(points, wanted):
    """The least cost of the time-stepped method with an error of the collision rate, two standard errors included, of at most the wanted one."""
    exact, last = exact_point(points), default_curve(points)[-1]
    good = [(p.cost, k) for k, p in default_curve(points) if abs(p.rate[0]) + 2 * p.rate[1] <= wanted]
    if not good:
        return f"more than {last[1].cost:.2f} (K > {last[0]})"
    cost, k = min(good)
    text = f"{cost:.3f} (K = {k})"
    return f"**{text}**" if cost < exact.cost else text


def answers_table(errors, large):
    rows = []
    for gases in (errors, large):
        for (packing, n), points in gases.items():
            rows.append([f"{packing:.3g}", str(n), f"{exact_point(points).cost:.3f}", *(answer(points, wanted) for wanted in WANTED)])
    return as_table(["packing", "discs", "event-driven: no error", *(f"time-stepped: {100 * wanted:g} %" for wanted in WANTED)], rows)


def put(text, name, part):
    begin, end = f"<!-- {name} -->", f"<!-- end of {name} -->"
    if begin not in text or end not in text:
        raise SystemExit(f"the page has no markers '{begin}' and '{end}'")
    return text[:text.index(begin) + len(begin)] + "\n" + part + "\n" + text[text.index(end):]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tables", nargs="+", type=pathlib.Path, help="error*.csv, large*.csv, long*.csv, dilute*.csv, arithmetic*.csv, size*.csv and thin*.csv of a study, or any one table")
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("."), help="folder for the figures")
    parser.add_argument("--page", type=pathlib.Path, help="a page to put tables into, between its markers")
    options = parser.parse_args()
    named = {kind: points_by_gas(read([p for p in options.tables if p.name.startswith(kind)])) for kind in ("large", "long", "dilute", "arithmetic", "size", "thin")}
    errors = points_by_gas(read([p for p in options.tables if not p.name.startswith(tuple(named))]))
    options.output.mkdir(parents=True, exist_ok=True)
    if errors:
        figure_error_against_cost(errors, options.output / "error_against_cost.png")
        figure_error_against_nu_dt(errors, options.output / "error_against_nu_dt.png")
    if named["large"]:
        figure_error_against_cost(named["large"], options.output / "error_against_cost_large.png")
        figure_both_methods({gas: points for gas, points in named["large"].items() if gas[0] in (0.1, 0.3, 0.7)}, options.output / "both_methods.svg")
    if named["size"]:
        figure_cost_against_size(named["size"], options.output / "cost_against_size.png")
    if named["thin"]:
        figure_formulas(named["thin"], options.output / "formulas.png")
    write_points({"error": errors, **named}, options.output / "points.csv")
    if options.page:
        text = put(options.page.read_text(encoding="utf-8"), "crossover", crossover_table(errors, named["large"]))
        text = put(text, "answers", answers_table(errors, named["large"]))
        options.page.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
