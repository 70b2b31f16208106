# SPDX-License-Identifier: BSD-3-Clause
"""Panels for the tables of `[output.measurements]`.

A table is drawn by what it says itself: names of its columns, and its remarks. So a new quantity
needs nothing here. A few tables gain by more than that: those in `_SPECIAL`.
"""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
from matplotlib.axes import Axes

from carrom.disc_arrays import Array
from carrom.fields import Fields, is_grid
from carrom.plot.fields import draw_field
from carrom.runs import Run
from carrom.tables import Table

_COUNTS = ("count", "pairs", "collisions", "neighbours")
# For example "velocities in lengths per step", which a remark says of `from` and `to`.
_PLACES = re.compile(r"(?:^|[;,:] )(\w+) in (the scene's unit of length|lengths per step|steps)\b")


def middles(table: Table) -> Array:
    """Return the middles of the intervals from `from` to `to`."""
    return np.asarray(table["from"] + table["to"]) / 2


def is_drawable(table: Table) -> bool:
    """Whether a table is a curve or a map: several rows, and a column of numbers over another."""
    return len(table) > 1 and bool(_curves(table))


def draw_table(ax: Axes, run: Run, name: str) -> None:
    """Draw a table of a run, titled by its name."""
    table = run.tables[name]
    ax.set_title(name.replace("_", " "), fontsize="medium")
    if is_grid(table.columns):
        fields = Fields(table)
        draw_field(ax, fields, "density", fields.n_blocks - 1)
    elif (kind := re.sub(r"_[0-9]+$", "", name)) in _SPECIAL:
        _SPECIAL[kind](ax, run, table)
    else:
        _draw_curves(ax, table)


def _across(table: Table) -> tuple[Array, str, set[str]]:
    """Return what stands along x, its label, and the columns that it is made of."""
    names = table.columns
    if {"from", "to"} <= set(names):
        found = [match for remark in table.remarks if (match := _PLACES.search(remark))]
        label = f"{found[0][1]} ({found[0][2]})" if found else "from ... to"
        return middles(table), label, {"from", "to"}
    if {"from_step", "to_step"} <= set(names):
        return (
            np.asarray(table["from_step"] + table["to_step"]) / 2,
            "step",
            {"from_step", "to_step"},
        )
    return np.asarray(table[names[0]]), names[0], {names[0], "time"}


def _curves(table: Table) -> list[str]:
    """Return the columns to draw: all but those along x, counts and errors."""
    along = _across(table)[2]
    return [
        name
        for name in table.columns
        if name not in along
        and not name.endswith("_error")
        and name.split("_")[-1] not in _COUNTS
        and np.any(np.isfinite(table[name]))
    ]


def _draw_curves(ax: Axes, table: Table) -> None:
    x, label, _ = _across(table)
    names = _curves(table)
    for name in names:
        y = np.asarray(table[name])
        (line,) = ax.plot(x, y, label=name, linewidth=1)
        if f"{name}_error" in table.columns:
            error = np.asarray(table[f"{name}_error"])
            ax.fill_between(x, y - error, y + error, color=line.get_color(), alpha=0.25)
    ax.set_xlabel(label)
    if len(names) == 1:
        ax.set_ylabel(names[0])
    else:
        ax.legend(fontsize="small")


def _radial_distribution(ax: Axes, run: Run, table: Table) -> None:
    _draw_curves(ax, table)
    ax.axhline(1, color="0.7", linewidth=0.8)


def _velocities(ax: Axes, run: Run, table: Table) -> None:
    """Beside the normal distribution of the same variance."""
    _draw_curves(ax, table)
    v = middles(table)
    counts = table["vx_count"] + table["vy_count"]
    variance = float(np.sum(counts * v**2) / max(np.sum(counts), 1))
    if variance > 0:
        normal = np.exp(-(v**2) / (2 * variance)) / np.sqrt(2 * np.pi * variance)
        ax.plot(v, normal, color="black", linewidth=0.8, label="Maxwell")
    ax.legend(fontsize="small")


def _wall_pressure(ax: Axes, run: Run, table: Table) -> None:
    """Over time, each side's mean in the legend. Periodic sides have none."""
    mean = run.tables["wall_pressure"]
    x, label, _ = _across(table)
    for side in _curves(table):
        text = side
        if len(mean) and f"{side}_error" in mean.columns:
            text = f"{side}: {mean[side][0]:.4g} ± {mean[side + '_error'][0]:.1g}"
        ax.plot(x, table[side], linewidth=0.8, label=text)
    ax.set(xlabel=label, ylabel="wall pressure", ylim=(0, None))
    ax.legend(fontsize="small")


def _displacement(ax: Axes, run: Run, table: Table) -> None:
    """In logarithmic scales, where free flight has the slope 2 and diffusion the slope 1."""
    moved = table["steps"] > 0
    for name in _curves(table):
        ax.loglog(table["steps"][moved], table[name][moved], label=name)
    ax.set(xlabel="steps", ylabel="mean square displacement")
    ax.legend()


def _thermo(ax: Axes, run: Run, table: Table) -> None:
    """Numbers of different units in one panel: each is divided by its mean."""
    for name in ("energy", "temperature", "collision_rate"):
        values = np.asarray(table[name])
        mean = float(np.nanmean(values)) if np.any(np.isfinite(values)) else 0.0
        if mean > 0:
            ax.plot(table["step"], values / mean, linewidth=1, label=name)
    ax.set(xlabel="step", ylabel="over the mean")
    ax.legend(fontsize="small")


def _correlations(ax: Axes, run: Run, table: Table) -> None:
    """How discs forget their places and velocities, over decades of time."""
    first = float(table["velocities"][0]) if len(table) else 0.0
    ax.semilogx(table["steps"], table["scattering"], label="F_s")
    ax.semilogx(table["steps"], table["overlap"], label="overlap")
    if first > 0:
        ax.semilogx(table["steps"], table["velocities"] / first, label="velocities, over the first")
    ax.set_xlabel("steps")
    ax.legend(fontsize="small")


def _transport(ax: Axes, run: Run, table: Table) -> None:
    """Coefficients by lag, of Helfand's moments, each over its largest up to a 16th of all lags.

    Late lags are noise.
    """
    steps = np.asarray(table["steps"])
    early = steps <= steps.max(initial=0) / 16
    for name in ("shear", "bulk", "conductivity"):
        values, errors = np.asarray(table[name]), np.asarray(table[f"{name}_error"])
        unit = float(values[early].max(initial=0))
        if unit == 0:
            continue
        ax.semilogx(steps, values / unit, label=f"{name} / {unit:.3g}")
        low, high = (values - errors) / unit, (values + errors) / unit
        ax.fill_between(steps, low, high, alpha=0.25)
    ax.set(xlabel="steps", ylim=(0, 1.8))
    ax.legend(fontsize="small")


_SPECIAL: dict[str, Callable[[Axes, Run, Table], None]] = {
    "correlations": _correlations,
    "displacement": _displacement,
    "radial_distribution": _radial_distribution,
    "thermo": _thermo,
    "transport": _transport,
    "velocities": _velocities,
    "wall_pressure_history": _wall_pressure,
}
