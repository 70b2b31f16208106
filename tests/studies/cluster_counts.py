#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Counted figures of windows of the event-driven method, which cluster_model.py uses.

  tests/studies/cluster_counts.py WINDOW_COUNTS --count    write window_counts.csv anew
  tests/studies/cluster_counts.py WINDOW_COUNTS            run its smallest row again;
                                                        code 1 if a count is off by 3 %
"""

import argparse
import csv
import math
import os
import subprocess
import sys
from typing import NamedTuple

TOLERANCE = 0.03
FOLDER = os.path.dirname(os.path.abspath(__file__))
COUNTS = os.path.join(FOLDER, "window_counts.csv")
PLATFORM = os.path.join(FOLDER, "fat_tree.xml")


class Counted(NamedTuple):
    """A window of the event-driven method in a gas of one density."""

    collisions: float  # collisions of a disc at the highest density
    micro_steps: float
    packing: float
    rollbacks: float  # rollbacks per length of block borders, in mean distances of discs
    marked: float  # block runs that a rollback repeats


def read_rows():
    with open(COUNTS, encoding="utf-8") as file:
        return [{k: float(v) for k, v in row.items()} for row in csv.DictReader(file)]


def border_of(row):
    """Length of the borders of blocks in mean distances of discs."""
    are_strips = row["ranks"] > 1 and row["across"] == 1
    n_columns = row["ranks"] if are_strips else math.sqrt(row["blocks"])
    return math.sqrt(row["discs"]) * (n_columns - 1 + row["blocks"] / n_columns - 1)


def rollbacks_in(rows):
    """Rollbacks of a window for each mean distance of discs along borders, and block runs that one
    repeats, over all windows of the rows.
    """
    n = sum(row["windows"] * row["windows_redone"] for row in rows)
    borders = sum(row["windows"] * border_of(row) for row in rows)
    repeated = sum(row["windows"] * row["repeated"] * row["blocks"] for row in rows)
    return n / borders, repeated / n


def counted_in(row, rollbacks=0.0, marked=0.0):
    share_dense = 1 if row["crowd"] == 0 else 0.5
    return Counted(
        row["collisions"] / share_dense,
        row["micro_steps"],
        row["packing"] * share_dense,
        rollbacks,
        marked,
    )


def read_counts():
    rows = read_rows()
    rollbacks = rollbacks_in([r for r in rows if r["crowd"] == 0 and r["discs"] > 1e5])
    return {
        is_even: counted_in(
            next(r for r in rows if r["ranks"] == 1 and (r["crowd"] == 0) == is_even), *rollbacks
        )
        for is_even in (True, False)
    }


def is_off(case, name, now, before, tolerance):
    now, before = float(now), float(before)
    print(f"{case}: {name} {now:g}, recorded {before:g}")
    return abs(now - before) > tolerance * before


def write(path, rows):
    with open(path, "w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        table.writeheader()
        table.writerows(rows)


def counts_of(program, ranks, n_discs, steps, halo, crowd, across):
    words = [PLATFORM, ranks, n_discs, 0.5, steps, halo, crowd, across, "--log=root.thresh:warning"]
    heading = subprocess.run([program], capture_output=True, text=True, check=True).stdout.strip()
    run = subprocess.run(
        [program, *map(str, words)],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "OMP_NUM_THREADS": "1"},
    )
    return dict(zip(heading.split(","), run.stdout.strip().splitlines()[-1].split(",")))


SMALL_RUN = (16, 2e4, 16, 3, 0, 0)  # ranks, discs, steps, halo, crowd, ranks across (0: chosen)
RUNS = (
    (1, 2e5, 384, 3, 0, 0),
    (16, 2e5, 384, 3, 0, 0),
    (16, 2e5, 384, 3, 0, 1),
    (16, 1e5, 96, 4, 0, 0),
    (1, 2e5, 64, 3, 2, 0),
    (16, 2e5, 64, 3, 2, 0),
    SMALL_RUN,
)


def count(program):
    """Runs the program's engine for real: three minutes."""
    write(COUNTS, [counts_of(program, *run) for run in RUNS])


def compare_counts(program):
    now, before = counts_of(program, *SMALL_RUN), read_rows()[-1]
    code = 0
    for name in ("collisions", "carried", "seen", "blocks", "messages", "bytes", "collectives"):
        code |= is_off("window_counts", name, now[name], before[name], TOLERANCE)
    return code


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("program", metavar="WINDOW_COUNTS")
    parser.add_argument("--count", action="store_true")
    options = parser.parse_args()
    if not options.count:
        return compare_counts(options.program)
    count(options.program)
    return 0


if __name__ == "__main__":
    sys.exit(main())
