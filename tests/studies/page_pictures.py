# SPDX-License-Identifier: BSD-3-Clause
"""The pictures of docs/understanding/performance.md, for page.py."""

import pathlib
import re
import sys

import matplotlib.pyplot as plt

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "docs" / "tools"))
import plot_style

STYLES = [
    (marker, line, colour)
    for marker, line, colour in zip("os^Dvx", ("-", "--", "-.", ":", "-", "--"), plot_style.COLOURS)
]
KERNELS = {
    "vector_filter": "filter of pairs",
    "contact_predicate": "contact predicate",
    "cell_grid_sort": "sorting into cells",
}


def new_axes(xlabel, ylabel):
    figure, axes = plt.subplots()
    axes.set(xlabel=xlabel, ylabel=ylabel)
    return figure, axes


def draw_series(axes, series):
    for index, (label, points) in enumerate(series.items()):
        marker, line, colour = STYLES[index % len(STYLES)]
        axes.plot(
            [x for x, _ in points],
            [y for _, y in points],
            marker=marker,
            linestyle=line,
            color=colour,
            markerfacecolor="white",
            label=label,
        )
    axes.legend()


def draw_cluster(rows, folder):
    for kind, title in (("weak", "weak_scaling.png"), ("strong", "strong_scaling.png")):
        series = {}
        for row in rows:
            if row["case"].startswith(kind):
                series.setdefault(row["case"].split(", ", 1)[1], []).append(
                    (int(row["ranks"]), float(row["efficiency"]))
                )
        if not series:
            continue
        figure, axes = new_axes(
            "ranks, one a node (simulated)", "time of own computing / time of a step"
        )
        draw_series(
            axes,
            {
                name.replace(" a rank", " discs a rank")
                + (" discs in all" if kind == "strong" else ""): sorted(points)
                for name, points in series.items()
            },
        )
        axes.axhline(0.9, color="0.6", linewidth=1)
        axes.set_xscale("log", base=2)
        ticks = sorted({int(row["ranks"]) for row in rows})
        axes.set_xticks(ticks, [str(tick) for tick in ticks])
        axes.set_ylim(0, 1.05)
        figure.savefig(folder / title)
        plt.close(figure)


def draw_large_cluster(rows, folder):
    figure, both = plt.subplots(1, 2, figsize=(11, 5.5), sharey=True)
    for axes, kind in zip(both, ("weak, 1e6 a rank", "strong, 1e8")):
        series, chosen = {}, (row for row in rows if row["case"].startswith(kind))
        for row in chosen:
            point = (int(row["ranks"]), float(row["efficiency"]))
            series.setdefault(row["case"].removeprefix(f"{kind}, "), []).append(point)
        draw_series(axes, series)
        axes.get_legend().remove()
        axes.set_xscale("log", base=2)
        axes.set(xlabel=f"ranks, 32 a node ({kind})", ylim=(0, 1.05))
    both[0].set_ylabel("time of one core / time of all ranks")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=2)
    figure.savefig(folder / "large_cluster.png")
    plt.close(figure)


def draw_numbers(rows, folder):
    points = sorted(
        (int(r["n_discs"]), float(r["ns_per_disc_step"]))
        for r in rows
        if re.fullmatch(r"gas, 1e\d", r["case"])
    )
    if len(points) < 2:
        return
    streams = sorted(
        (int(r["n_discs"]), 1e9 / float(r["stream_rate"]))
        for r in rows
        if re.fullmatch(r"gas, 1e\d", r["case"]) and r["stream_rate"]
    )
    figure, axes = new_axes("number of discs N", "nanoseconds per disc and step")
    draw_series(
        axes,
        {
            "gas of packing 0.2, time-stepped method, one core": points,
            "a plain stream of 64 bytes a disc": streams,
        },
    )
    axes.set(xscale="log", yscale="log")
    figure.savefig(folder / "cost_against_size.png")
    plt.close(figure)


def draw_sizes(rows, folder):
    """Collisions a second against the ratio of sizes, of Carrom and of EDMD, which has no rate
    where it did not end within its time.
    """
    series = {}
    for row in rows:
        found = re.fullmatch(r"sizes 1 and (\d+), packing (\S+)", row["case"])
        for name, column in (("Carrom", "rate"), ("EDMD", "edmd_rate")):
            if found and row[column]:
                points = series.setdefault(f"{name}, packing {found.group(2)}", [])
                points.append((int(found.group(1)), float(row[column]) / 1e6))
    figure, axes = new_axes("ratio of radii R", "million collisions per second")
    draw_series(axes, series)
    axes.set(xscale="log", yscale="log")
    axes.set_xticks([1, 3, 10, 30], ["1", "3", "10", "30"])
    axes.minorticks_off()
    figure.savefig(folder / "sizes.png")
    plt.close(figure)


def draw_roofline(kernels, peaks, folder):
    figure, axes = new_axes("operations per byte", "$10^9$ operations per second, one core")
    low, high = 0.02, 64.0
    for name, gbytes, line in (
        ("cache", peaks["stream_cache"], "--"),
        ("memory", peaks["stream_memory"], "-"),
    ):
        knee = peaks["single"] / gbytes
        axes.plot(
            [low, knee, high],
            [low * gbytes, peaks["single"], peaks["single"]],
            color="black",
            linestyle=line,
            linewidth=1.2,
            label=f"{name}, {gbytes:.0f} GB/s, then single precision",
        )
    axes.axhline(peaks["double"], color="0.5", linestyle=":", label="double precision")
    shown = [kernel for kernel in kernels if kernel["flops"] > 0]
    for index, kernel in enumerate(shown):
        x, y = kernel["flops"] / kernel["bytes"], kernel["items_per_second"] * kernel["flops"] / 1e9
        name = kernel.get("run_name", kernel["name"]).removesuffix("_median")
        kind, _, n_discs = name.partition("/")
        name = KERNELS.get(kind, kind) + (f", {int(n_discs):,} discs" if n_discs else "")
        axes.plot(
            [x],
            [y],
            marker=STYLES[index % len(STYLES)][0],
            color="black",
            linestyle="none",
            markersize=6,
            markerfacecolor="white",
        )
        axes.annotate(
            name,
            (x, y),
            textcoords="offset points",
            xytext=(7, (4, -12, 4, 4, -12)[index % 5]),
            ha="left",  # labels are right of the points, because the roofline is left of them
            fontsize=10,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5, "alpha": 0.8},
        )
    axes.set(xscale="log", yscale="log", xlim=(low, high))
    axes.legend(fontsize=10, loc="lower right")
    figure.savefig(folder / "roofline.png")
    plt.close(figure)
