# SPDX-License-Identifier: BSD-3-Clause
"""Measure a scene over ranks and threads: `python3 -m carrom.scaling SCENE --ranks 1 2 4`.

A row for each shape: seconds of stepping, speedup and efficiency against the shape with the fewest
cores. `--from TABLE.csv` adds the last two columns to a table of job_scripts/strong_scaling.sbatch.
"""

from __future__ import annotations

import argparse
import csv
import os
import sys
import tempfile
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import Any

from carrom.destinations import refuse_owned
from carrom.errors import CarromError, FileError
from carrom.plain import open_plain
from carrom.running import run

MEASURED = (
    "ranks",
    "threads",
    "n_discs",
    "steps",
    "wall_seconds",
    "ns_per_disc_step",
    "state_hash",
)
COLUMNS = (*MEASURED, "cores", "speedup", "efficiency")
Row = dict[str, Any]


def measure(
    scene: str | os.PathLike[str],
    ranks: Sequence[int] = (1,),
    threads: Sequence[int] = (1,),
    *,
    steps: int | None = None,
    repeat: int = 1,
    is_weak: bool = False,
    note: Callable[[Row], None] | None = None,
    **overrides: Any,
) -> list[Row]:
    """Run a scene on each number of ranks with each number of threads; see `with_efficiency`.

    Args:
        scene: the path of a scene
        ranks: numbers of ranks
        threads: numbers of threads of each rank
        steps: steps to run, instead of the scene's
        repeat: runs of each shape; the fastest counts
        is_weak: discs grow with the cores, at the same packing; `discs.count` is for one core
        note: is called with each row as soon as it is measured
        **overrides: keys of the scene, as for `carrom.run`
    """
    rows = []
    for n_threads in threads:
        for n_ranks in ranks:
            keys = dict(overrides)
            if is_weak:
                keys["discs__count"] = int(overrides["discs__count"]) * n_ranks * n_threads
            runs = [_report(scene, n_ranks, n_threads, steps, keys) for _ in range(repeat)]
            rows.append(min(runs, key=lambda row: float(row["wall_seconds"])))
            if note is not None:
                note(rows[-1])
    return with_efficiency(rows, is_weak=is_weak)


def _report(
    scene: str | os.PathLike[str], ranks: int, threads: int, steps: int | None, keys: Row
) -> Row:
    with tempfile.TemporaryDirectory() as folder:
        done = run(
            scene,
            ranks,
            threads,
            Path(folder) / "run",
            steps=steps,
            progress=False,
            output__checkpoint__at_end=False,
            **keys,
        )
        report = done.report
    return {name: report[name] for name in MEASURED}


def with_efficiency(rows: Iterable[Row], *, is_weak: bool = False) -> list[Row]:
    """Add `cores`, `speedup` and `efficiency`, in the order of threads, then ranks.

    Speedup is against the row with the fewest cores, per disc and step. Efficiency is speedup over
    the ratio of cores.

    Raises:
        CarromError: rows of one scene have different state hashes, or a row has no steps
    """
    rows = [dict(row) for row in rows]
    if not rows:
        raise FileError("a table of scaling needs a row")
    for row in rows:
        row["cores"] = int(row["ranks"]) * int(row["threads"])
    first = min(rows, key=lambda row: row["cores"])
    for row in rows:
        row["speedup"] = _seconds_of_a_step(first) / _seconds_of_a_step(row)
        row["efficiency"] = row["speedup"] * first["cores"] / row["cores"]
    hashes = {row["state_hash"] for row in rows}
    if len(hashes) > 1 and not is_weak:
        raise CarromError(f"the shapes come to different states: {', '.join(sorted(hashes))}")
    return sorted(rows, key=lambda row: (int(row["threads"]), int(row["ranks"])))


def _seconds_of_a_step(row: Row) -> float:
    """Seconds per disc and step."""
    n = int(row["steps"]) * int(row["n_discs"])
    if n == 0:
        raise CarromError("a table of scaling needs runs of at least one step")
    return float(row["wall_seconds"]) / n


def write_table(rows: Iterable[Row], path: str | os.PathLike[str]) -> None:
    """Write rows as CSV. The first columns are those of job_scripts/strong_scaling.sbatch."""
    refuse_owned(path)
    with open(path, "w", encoding="ascii", newline="") as file:
        table = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        table.writeheader()
        for row in rows:
            numbers = {name: f"{row[name]:.4f}" for name in ("speedup", "efficiency")}
            table.writerow({name: row[name] for name in COLUMNS} | numbers)


def read_table(path: str | os.PathLike[str], *, is_weak: bool = False) -> list[Row]:
    """Read a table that this module or a job script has written, and add what it lacks."""
    try:
        with open_plain(path, "r", encoding="ascii", newline="") as file:
            rows = [{name: row[name] for name in MEASURED} for row in csv.DictReader(file)]
        return with_efficiency(rows, is_weak=is_weak)
    except (OSError, ValueError, KeyError, TypeError, ZeroDivisionError) as error:
        raise FileError(f"{path}: is no table of scaling: {error}") from None


def plot(rows: Sequence[Row], path: str | os.PathLike[str]) -> None:
    """Draw speedup and efficiency against cores, a line for each number of threads."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot

    refuse_owned(path)
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(9, 3.8), layout="constrained")
    cores = sorted({int(row["cores"]) for row in rows})
    left.plot(cores, [n / cores[0] for n in cores], color="0.6", linestyle="--", label="ideal")
    right.axhline(1, color="0.6", linestyle="--")
    for threads in sorted({int(row["threads"]) for row in rows}):
        some = sorted((r for r in rows if int(r["threads"]) == threads), key=lambda r: r["cores"])
        at = [row["cores"] for row in some]
        label = f"{threads} thread{'s' if threads > 1 else ''} a rank"
        left.plot(at, [row["speedup"] for row in some], "o-", label=label)
        right.plot(at, [row["efficiency"] for row in some], "o-")
    left.set(xlabel="cores: ranks x threads", ylabel="speedup", ylim=(0, None))
    right.set(xlabel="cores: ranks x threads", ylabel="efficiency", ylim=(0, None))
    for axes in (left, right):
        axes.set_xticks(cores)
    left.legend()
    figure.savefig(path, dpi=120)
    pyplot.close(figure)


def _line(row: Row) -> str:
    return f"{row['ranks']:>5} {row['threads']:>7} {float(row['wall_seconds']):>10.4f} s"


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python3 -m carrom.scaling",
        description="Measure a scene over ranks and threads, with speedup and efficiency.",
        epilog="Leave the machine alone meanwhile. The fastest of --repeat runs counts.",
    )
    parser.add_argument("scene", nargs="?", help="SCENE.toml or FILE.in")
    parser.add_argument("--from", dest="table", help="a table that is there, instead of runs")
    parser.add_argument("--ranks", type=int, nargs="+", default=[1], metavar="R")
    parser.add_argument("--threads", type=int, nargs="+", default=[1], metavar="T")
    parser.add_argument("--steps", type=int, help="instead of the scene's")
    parser.add_argument("--discs", type=int, help="instead of the scene's; for one core if --weak")
    parser.add_argument("--repeat", type=int, default=3, help="runs of each shape; default 3")
    parser.add_argument("--weak", action="store_true", help="discs grow with the cores")
    parser.add_argument("-o", "--output", default="scaling.csv", help="default %(default)s")
    parser.add_argument("--plot", help="a picture too (.png, .pdf, .svg); needs matplotlib")
    return parser


def _rows(wanted: argparse.Namespace) -> list[Row]:
    if wanted.table:
        return read_table(wanted.table, is_weak=wanted.weak)
    available = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    if max(wanted.ranks) * max(wanted.threads) > (available or 1):
        print(
            f"warning: there are {available} cores; shapes with more measure waiting",
            file=sys.stderr,
        )
    keys = {} if wanted.discs is None else {"discs__count": wanted.discs}
    print("ranks threads  best time", file=sys.stderr)
    return measure(
        wanted.scene,
        wanted.ranks,
        wanted.threads,
        steps=wanted.steps,
        repeat=wanted.repeat,
        is_weak=wanted.weak,
        note=lambda row: print(_line(row), file=sys.stderr, flush=True),
        **keys,
    )


def main(words: Sequence[str] | None = None) -> int:
    """Measure what the command line asks for; 1 if states differ, 2 if the input is wrong."""
    parser = _parser()
    wanted = parser.parse_args(words)
    if (wanted.scene is None) == (wanted.table is None):
        parser.error("give a scene, or --from TABLE")
    if min(*wanted.ranks, *wanted.threads, wanted.repeat) < 1:
        parser.error("ranks, threads and repeat are at least 1")
    if wanted.weak and wanted.discs is None and wanted.table is None:
        parser.error("--weak needs --discs, the number for one core")
    try:
        for path in (wanted.output, wanted.plot):
            if path:
                refuse_owned(path)
        rows = _rows(wanted)
        write_table(rows, wanted.output)
        if wanted.plot:
            plot(rows, wanted.plot)
    except ImportError as error:
        print(f"carrom.scaling: {error}: pip install carrom[plot]", file=sys.stderr)
        return 2
    except (CarromError, OSError) as error:
        print(f"carrom.scaling: {error}", file=sys.stderr)
        return 1 if "different states" in str(error) else 2
    print("ranks threads cores    seconds speedup efficiency")
    for row in rows:
        print(
            f"{row['ranks']:>5} {row['threads']:>7} {row['cores']:>5} "
            f"{float(row['wall_seconds']):>10.4f} {row['speedup']:>7.2f} {row['efficiency']:>10.2f}"
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
