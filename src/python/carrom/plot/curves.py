# SPDX-License-Identifier: BSD-3-Clause
"""Curves of runs: energy and collisions over time, tables of measurements, equation of state."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from typing import Union

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes

from carrom.errors import NoDataError
from carrom.fields import Fields
from carrom.physics import compressibility, henderson, virial_equation
from carrom.plot.fields import draw_field
from carrom.plot.panels import draw_table, is_drawable, middles
from carrom.plot.sources import as_run
from carrom.runs import Run
from carrom.sweeps import Sweep

_USUAL_FIELDS = ("density", "temperature", "vx", "vy")
RunLike = Union[Run, str, "os.PathLike[str]"]


def _new_axes(ax: Axes | None) -> Axes:
    if ax is not None:
        return ax
    _, new = plt.subplots(figsize=(6.4, 4.4), layout="constrained")
    return new


def _items(source: RunLike | Iterable[RunLike]) -> list[RunLike]:
    return [source] if isinstance(source, (Run, str, os.PathLike)) else list(source)


def history(source: RunLike) -> list[Axes]:
    """Draw kinetic energy (of the frames) and collisions per step (of the log) over time.

    Energy is relative to the first frame. Frames in single precision show some 1e-7 of rounding.
    """
    run = as_run(source)
    parts: list[Callable[[Axes, Run], None]] = []
    if len(run.frames) and run.frames.has("velocity"):
        parts.append(_draw_energy)
    try:
        run.collisions_between(0, 0)
        parts.append(_draw_collisions)
    except NoDataError:
        pass
    if not parts:
        raise NoDataError(f"{run.name}: has neither frames with velocities nor collisions")
    _, grid = plt.subplots(
        len(parts),
        figsize=(7.2, 2.8 * len(parts)),
        sharex=True,
        squeeze=False,
        layout="constrained",
    )
    axes: list[Axes] = list(grid[:, 0])
    for draw, ax in zip(parts, axes):
        draw(ax, run)
    axes[-1].set_xlabel("step")
    return axes


def _draw_energy(ax: Axes, run: Run) -> None:
    frames = run.frames
    energy = np.array([frame.kinetic_energy for frame in frames])
    start = energy[0] or 1.0
    ax.plot(frames.steps, energy / start - 1, marker="." if len(energy) < 200 else None)
    ax.set(ylabel="change of kinetic energy\n(of that at the start)")
    ax.ticklabel_format(axis="y", style="sci", scilimits=(-3, 3))
    ax.set_title(f"kinetic energy at the start {energy[0]:.10g}", fontsize="medium")


def _draw_collisions(ax: Axes, run: Run, most_points: int = 400) -> None:
    table = run.collisions
    steps, partners = np.asarray(table["step"]), np.asarray(table["q"])
    first = int(steps.min()) if len(steps) else 1
    last = int(steps.max()) if len(steps) else 1
    width = -(-(last - first + 1) // most_points)  # steps per point; the last point may have fewer
    edges = np.minimum(np.arange(first, last + width + 1, width), last + 1) - 0.5
    edges = np.unique(edges)
    for is_wall, label in ((False, "pairs"), (True, "walls")):
        counts, _ = np.histogram(steps[(partners < 0) == is_wall], edges)
        ax.stairs(counts / np.diff(edges), edges, label=label)
    ax.set(ylabel="collisions per step", ylim=(0, None))
    ax.legend()


def radial_distribution(
    source: RunLike | Iterable[RunLike],
    *,
    in_diameters: bool = False,
    ax: Axes | None = None,
) -> Axes:
    """Draw g(r) of one or more runs, of `"radial_distribution"` of `[output.measurements]`.

    A band around each curve shows one standard error, where the run has enough samples for it.

    Args:
        source: a run, a path, or several of them
        in_diameters: show distances over the diameter of the largest disc
        ax: where to draw; a new figure if None
    """
    ax = _new_axes(ax)
    sources = _items(source)
    for item in sources:
        run = as_run(item)
        table = run.tables["radial_distribution"]
        unit = _diameter(run) if in_diameters else 1.0
        curves = [name for name in table.columns if name == "g" or name.startswith("g_")]
        kinds = [name for name in curves if not name.endswith("_error")]
        for kind in kinds:
            label = run.name if len(sources) > 1 else kind
            distances, g = middles(table) / unit, table[kind]
            (line,) = ax.plot(distances, g, label=label)
            if f"{kind}_error" in curves:  # tables of version 0.2 have none
                error = table[f"{kind}_error"]
                ax.fill_between(distances, g - error, g + error, color=line.get_color(), alpha=0.3)
        if len(sources) > 1 or len(kinds) > 1:
            ax.legend()
    ax.axhline(1, color="0.7", linewidth=0.8)
    ax.set(xlabel="distance / diameter" if in_diameters else "distance", ylabel="g", ylim=(0, None))
    return ax


def _diameter(run: Run) -> float:
    frames = run.frames if len(run.frames) else run.checkpoints
    return 2 * float(frames[-1].radius.max())


def equation_of_state(
    source: Sweep | RunLike | Iterable[RunLike], *, theory: bool = True, ax: Axes | None = None
) -> Axes:
    """Draw Z = p A / (N kT) against the packing fraction, with one standard error.

    `carrom.compressibility` says where Z comes from.

    Args:
        source: a sweep, a run, a path, or several of them
        theory: draw Henderson's equation and the virial equation too
        ax: where to draw; a new figure if None
    """
    runs = source.runs if isinstance(source, Sweep) else [as_run(item) for item in _items(source)]
    if not runs:
        raise NoDataError("an equation of state needs a finished run")
    ax = _new_axes(ax)
    points = sorted((float(run.report["packing"]), *compressibility(run)) for run in runs)
    packings, values, errors = (np.array(column) for column in zip(*points))
    if theory:
        line = np.linspace(0, max(packings.max(), 0.05), 200)
        ax.plot(line, henderson(line), color="0.6", label="Henderson (1975)")
        ax.plot(line, virial_equation(line), "k--", linewidth=0.8, label="virial equation")
    ax.errorbar(packings, values, yerr=errors, fmt="o", markersize=4, capsize=2, label="measured")
    ax.set(xlabel="packing fraction", ylabel="Z = p A / (N kT)")
    ax.legend()
    return ax


def measurements(source: RunLike) -> list[Axes]:
    """Draw the tables of `[output.measurements]`, a panel for each that is a curve."""
    run = as_run(source)
    names = [name for name, table in run.tables.items() if is_drawable(table)]
    if not names:
        known = ", ".join(run.tables) or "none"
        raise NoDataError(f"{run.name}: has no table to draw; it has {known}")
    axes = _panels(len(names))
    for ax, name in zip(axes, names):
        draw_table(ax, run, name)
    return axes


def _height_of(fields: Fields) -> float:
    """Return the height of a panel, in inches: flat for a flat map."""
    if not fields.is_map:
        return 3.4
    x, y = fields.x[-1], fields.y[-1]
    return float(np.clip(3.6 * np.ptp(y) / np.ptp(x) + 0.9, 1.6, 6))


def _panels(n: int, height: float = 3.4) -> list[Axes]:
    """Return axes in two columns."""
    n_columns = min(2, n)
    n_rows = -(-n // n_columns)
    _, grid = plt.subplots(
        n_rows,
        n_columns,
        figsize=(4.8 * n_columns, height * n_rows),
        squeeze=False,
        layout="constrained",
    )
    axes: list[Axes] = list(grid.flat)
    for ax in axes[n:]:
        ax.remove()
    return axes[:n]


def profiles(
    source: RunLike,
    columns: Sequence[str] = _USUAL_FIELDS,
    *,
    step: int | None = None,
    species: int | None = None,
) -> list[Axes]:
    """Draw fields of `"profiles"`, a panel for each of them.

    On a grid of rows and columns a panel is a map of one block. Where the grid has a single row or
    column it has a curve for each block, the last one in black.

    Args:
        source: a run, or a path
        columns: names of fields; "pressure" is the sum of both parts of half the trace
        step: the block that ends with this step; the last one if None
        species: that species alone, counted from 1; it needs `profile_species = 1`
    """
    run = as_run(source)
    name = "profiles" if species is None else f"profiles_{species}"
    fields = Fields(run.tables[name])
    if fields.n_blocks == 0:
        raise NoDataError(f"{run.name}: has no whole block of profiles yet")
    axes = _panels(len(columns), _height_of(fields))
    for ax, column in zip(axes, columns):
        draw_field(ax, fields, column, fields.block_of(step))
    return axes
