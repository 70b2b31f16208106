#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Predict how both methods scale on a large simulated cluster, from counted figures.

  tests/studies/cluster_model.py REPLAY_CLUSTER                compare with cluster_model.csv;
                                                        code 1 if a number is off by 2 %, or if
                                                        the model disagrees with the counts
  tests/studies/cluster_model.py REPLAY_CLUSTER --record       write cluster_model.csv anew
  tests/studies/cluster_model.py REPLAY_CLUSTER --study FILE   1 to 8192 ranks, as CSV: minutes

Real runs on 1 and 16 ranks give what a window has (cluster_counts.py, and for the time-stepped
method docs/data/performance/cluster.csv): collisions, how far blocks see, how deep halos are, how
many block runs are repeated, how many messages and reductions there are. cluster_plan.py and
cluster_case.py work out what each rank would have of that, and replay_cluster.cpp replays it on a
network.
A node has 32 ranks of one thread, which share its network card. Efficiency is the time of one core
over the time of all ranks together.
"""

import argparse
import concurrent.futures
import csv
import os
import re
import subprocess
import sys
import time

import cluster_plan
from cluster_case import (
    MICRO_STEPS,
    Case,
    event_plan,
    gas_of,
    reach_of,
    script_of,
    stepped_plan,
)
from cluster_counts import (
    FOLDER,
    PLATFORM,
    counted_in,
    is_off,
    read_counts,
    read_rows,
    write,
)
from cluster_plan import DISC_BYTES, HISTORY_BYTES, Window

TOLERANCE = 0.02
# Largest relative errors of the model for runs that were counted: for homogeneous gases (True), and
# for gases with half of the discs clustered, where blocks have discs of both densities.
TOLERANCE_OF_MODEL = {True: 0.06, False: 0.12}
TABLE = os.path.join(FOLDER, "cluster_model.csv")

FIELDS = (
    "case",
    "method",
    "ranks",
    "rows",
    "n_discs",
    "seen",
    "halo",
    "partners",
    "busiest",
    "own_ms",
    "window_ms",
    "computing_ms",
    "exchanging_ms",
    "reducing_ms",
    "messages",
    "bytes",
    "efficiency",
)


def simulated(program, case, counts):
    plan = event_plan(case, counts) if case.method == "event-driven" else stepped_plan(case)
    run = subprocess.run(
        [program, PLATFORM, "--log=root.thresh:warning"],
        input=script_of(case, plan),
        capture_output=True,
        text=True,
        check=False,
    )
    if run.returncode != 0:
        sys.exit(f"{program} failed for {case}:\n{run.stderr}")
    window, computing, exchanging, reducing, messages, sent = map(float, run.stdout.split(","))
    is_stepped = case.method != "event-driven"
    mean = sum(plan.first) / case.ranks
    own = plan.own * (MICRO_STEPS if is_stepped else 1)
    return dict(
        zip(
            FIELDS,
            (
                case.name,
                case.method,
                case.ranks,
                case.rows,
                f"{case.n_discs:.0f}",
                f"{plan.seen:.3f}",
                f"{sum(sum(h.values()) for h in plan.halos) / case.n_discs:.3f}",
                f"{sum(map(len, plan.halos)) / case.ranks:.2f}",
                f"{max(plan.first) / mean:.3f}",
                *(f"{ns / 1e6:.4g}" for ns in (own, window, computing, exchanging, reducing)),
                f"{messages:.4g}",
                f"{sent:.5g}",
                f"{own / window:.3f}",
            ),
        )
    )


# Depths of halos in mean distances of discs (group_choice in src/engine/engine_base.cpp).
USUAL_DEPTH = {"event-driven": 10, "time-stepped": 1.2}
MOST_STRONG = 1024  # ranks; with more of them strips are narrower than a few discs


def cases_of(ranks):
    weak, strong = 1e6 * ranks, 1e8
    for method, is_even, label in (
        ("event-driven", True, "event-driven"),
        ("event-driven", False, "event-driven, half in 1 %"),
        ("time-stepped", True, "time-stepped"),
        ("time-stepped", False, "time-stepped, half in 1 %"),
    ):
        for kind, n_discs in (("weak, 1e6 a rank", weak), ("strong, 1e8", strong)):
            if kind.startswith("strong") and ranks > MOST_STRONG:
                continue
            rows = cluster_plan.rows_of(n_discs, ranks, USUAL_DEPTH[method])
            yield Case(f"{kind}, {label}", ranks, n_discs, method, is_even, rows)
            if is_even and rows > 1:  # for comparison
                yield Case(f"{kind}, {label}, whole strips", ranks, n_discs, method, is_even)


def study(program, path, n_workers, ranks_wanted, only):
    counts = read_counts()
    chosen = [
        case._replace(windows=2 if ranks > MOST_STRONG else 6)
        for ranks in ranks_wanted
        for case in cases_of(ranks)
        if re.search(only, case.name)
    ]

    def run(case):
        start = time.monotonic()
        row = simulated(program, case, counts)
        print(
            f"{case.name}, {case.ranks} ranks: efficiency {row['efficiency']}"
            f" ({time.monotonic() - start:.0f} s)",
            file=sys.stderr,
            flush=True,
        )
        return row

    with concurrent.futures.ThreadPoolExecutor(n_workers) as workers:
        rows = list(workers.map(run, chosen))
    if os.path.exists(path):
        with open(path, encoding="utf-8") as file:
            done = {(row["case"], str(row["ranks"])) for row in rows}
            rows += [row for row in csv.DictReader(file) if (row["case"], row["ranks"]) not in done]
    write(path, sorted(rows, key=lambda row: (row["case"], int(row["ranks"]))))


def pinned(program):
    """Small enough for a test, and one of each kind."""
    counts = read_counts()
    return [simulated(program, case._replace(windows=4), counts) for case in cases_of(64)]


def compare(program):
    code = compare_model()
    with open(TABLE, encoding="utf-8") as file:
        recorded = {row["case"]: row for row in csv.DictReader(file)}
    for row in pinned(program):
        for name in ("efficiency", "halo", "messages", "bytes"):
            code |= is_off(row["case"], name, row[name], recorded[row["case"]][name], TOLERANCE)
    return code


def compare_model():
    """What the model says of blocks and halos, beside the counts of real runs."""
    code = 0
    for row in read_rows():
        if row["discs"] < 1e5:
            continue
        counted = counted_in(row)
        case = Case("", int(row["ranks"]), row["discs"], is_even=row["crowd"] == 0)
        gas = gas_of(case)
        window = Window(counted.collisions, reach_of(counted, row["discs"]), int(row["halo"]))
        rows = int(row["across"])
        cut = cluster_plan.cut_box(gas, case.ranks, rows, True, window)
        blocks = [cluster_plan.blocks_of(gas, part, window) for part in cut.rectangles()]
        halos = cluster_plan.halos(gas, cut, window.depth)
        n_halo = sum(sum(h.values()) for h in halos) / case.ranks
        name = f"model of {case.ranks} ranks, {rows} across, {row['discs']:.0f} discs"
        name += f", crowd {row['crowd']:.0f}"
        seen = sum(b.seen for b in blocks) / row["discs"]
        n_bytes = n_halo * (DISC_BYTES + HISTORY_BYTES)
        bound = TOLERANCE_OF_MODEL[case.is_even]
        code |= is_off(name, "seen", seen, row["seen"], bound)
        code |= is_off(name, "bytes", n_bytes, row["bytes"], bound)
    return code


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("program", metavar="PROGRAM")
    parser.add_argument("--record", action="store_true")
    parser.add_argument("--study", metavar="FILE")
    parser.add_argument(
        "--ranks",
        type=int,
        nargs="+",
        default=[1, 16, 64, 256, 1024, 8192],
        help="of the study; other rows of the file stay; 8192 take most of the time",
    )
    parser.add_argument("--only", default="", help="a pattern for names of cases")
    parser.add_argument("--jobs", type=int, default=1, help="of the study, side by side")
    options = parser.parse_args()
    if options.study:
        study(options.program, options.study, options.jobs, options.ranks, options.only)
    elif options.record:
        write(TABLE, pinned(options.program))
    else:
        return compare(options.program)
    return 0


if __name__ == "__main__":
    sys.exit(main())
