#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Count messages, and predict scaling, on a simulated cluster (SimGrid):
tests/studies/simulated_cluster.cpp.

  tests/studies/simulate.py SIMULATED_CLUSTER                 compare with messages.csv;
                                                        code 1 if a number is off by 3 %
  tests/studies/simulate.py SIMULATED_CLUSTER --record          write messages.csv anew
  tests/studies/simulate.py SIMULATED_CLUSTER --study FILE    16 to 1024 ranks, weak and
                                                        strong scaling, as CSV: minutes

What is compared does not depend on the machine, nor on how fast anything is: messages, bytes and
collective operations per rank and step, on 16 ranks of 1000 discs. That calls whose messages grow
with the ranks (any-to-any) stay at zero is a demand of its own.
"""

import argparse
import concurrent.futures
import csv
import math
import os
import subprocess
import sys
import tempfile
import threading
import time
from typing import NamedTuple

TOLERANCE = 0.03
ONE_AT_A_TIME = 5_000_000  # discs from which on two studies at a time might not have enough memory
FOLDER = os.path.dirname(os.path.abspath(__file__))
TABLE = os.path.join(FOLDER, "messages.csv")
PLATFORM = os.path.join(FOLDER, "fat_tree.xml")
PINNED = ("messages", "most_messages", "bytes", "collectives", "network_messages")
# Computing time of a rank in nanoseconds: per own disc and micro-step of the gas, measured on one
# core with 1e5 and 1e6 discs, and of the slow gas, with 1e6 (docs/understanding/performance.md). A
# rank sends a disc, 64 bytes, once a window and when the disc has collided. That takes 436 to 456
# instructions, in the slow gas 484; an own disc takes 208 a micro-step. Valgrind counted them with
# 64,000 discs on 8 and 16 ranks against one. So a sent disc counts as 2.1 own discs.
NS_IN_CACHE, NS_IN_MEMORY, NS_SLOW = 23.0, 31.4, 2.6
SENT_TO_OWN = 2.1
MOST_IN_CACHE = 200_000  # discs of a rank


class Case(NamedTuple):
    """Discs of packing 0.2; each stands for `stands_for`, in the box of all those, in windows as
    long as theirs (0: as it chooses).
    """

    name: str
    ranks: int
    n_discs: int
    stands_for: int = 1
    window: int = 0
    speed: float = 0.5 / math.sqrt(3)  # radii per step, root mean square
    is_slow: bool = False
    steps: int = 64

    @property
    def ns_gas(self):
        return (
            NS_IN_CACHE
            if self.n_discs * self.stands_for <= MOST_IN_CACHE * self.ranks
            else NS_IN_MEMORY
        )

    @property
    def ns_own(self):
        return NS_SLOW if self.is_slow else self.ns_gas

    @property
    def ns_halo(self):
        return round(SENT_TO_OWN * self.ns_gas, 1)


def gas(case, method="time-stepped"):
    """Discs of radius 1; from a lattice, which the steps before those that count forget. Speeds are
    spread evenly where discs meet often enough to change that, else they are what that changes them
    to, Maxwell's.
    """
    size = math.sqrt(case.n_discs * math.pi / (0.2 / case.stands_for))
    return (
        f"[box]\nsize = {size!r}\n[discs]\ncount = {case.n_discs}\nradius = 1.0\ngenerator ="
        f" \"lattice\"\nvelocities = \"{'uniform' if case.stands_for == 1 else 'maxwell'}\"\nspeed"
        f" = {case.speed!r}\n[time]\nsteps = {64 + case.steps}\nmethod = \"{method}\"\n"
    )


def simulated(program, case, method="time-stepped", timeout=3600):
    """One run's numbers, by the names in the program's heading."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "scene.toml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(gas(case, method))
        numbers = [
            str(n) for n in (case.steps, case.ns_own, case.ns_halo, case.stands_for, case.window)
        ]
        command = [program, PLATFORM, str(case.ranks), "1", path, *numbers]
        command.append("--log=root.thresh:warning")
        heading = subprocess.run(
            [program], capture_output=True, text=True, check=True
        ).stdout.strip()
        run = subprocess.run(
            command,
            capture_output=True,
            text=True,
            timeout=timeout,
            check=False,
            env={**os.environ, "OMP_NUM_THREADS": "1"},
        )
    if run.returncode != 0:
        sys.exit(f"{' '.join(command)} failed:\n{run.stderr}")
    return dict(zip(heading.split(","), run.stdout.strip().splitlines()[-1].split(",")))


def pinned(program):
    return {
        method: simulated(program, Case("pinned", 16, 16_000), method, 600)
        for method in ("time-stepped", "event-driven")
    }


def record(program):
    with open(TABLE, "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["method", *PINNED])
        for method, found in pinned(program).items():
            table.writerow([method] + [found[name] for name in PINNED])


def compare(program):
    code = 0
    now = pinned(program)
    with open(TABLE, encoding="utf-8") as file:
        for row in csv.DictReader(file):
            found = now[row["method"]]
            for name in PINNED:
                before, after = float(row[name]), float(found[name])
                print(
                    f"method \"{row['method']}\", per rank and step: {name} {after:g}, recorded"
                    f" {before:g}"
                )
                if abs(after - before) > TOLERANCE * before:
                    print(
                        "  if that is meant, record it and say why (tests/studies/simulate.py"
                        " SIMULATED_CLUSTER --record)"
                    )
                    code = 1
            if float(found["any_to_any"]) != 0:
                print(
                    f"  {found['any_to_any']} calls a step whose messages grow with the number of"
                    " ranks"
                )
                code = 1
    return code


def cases():
    """Largest first, for several to run side by side."""
    for ranks in (1024, 256, 64, 16, 1):
        for discs, stands_for in (("1e6", 50), ("4e6", 200)):
            yield Case(
                f"weak, {discs} a rank, slow",
                ranks,
                20_000 * ranks,
                stands_for=stands_for,
                speed=0.01 * math.sqrt(2),
                is_slow=True,
            )
        yield Case("weak, 1e6 a rank", ranks, 20_000 * ranks, stands_for=50, window=3)
        yield Case("weak, 4e6 a rank", ranks, 20_000 * ranks, stands_for=200, window=3)
        yield Case("strong, 1e8", ranks, 2_000_000, stands_for=50, window=3)
        if ranks == 1024:
            continue  # with strips about as narrow as a window's reach
        yield Case("weak, 2e4 a rank", ranks, 20_000 * ranks)
        yield Case("weak, 2e3 a rank", ranks, 2000 * ranks)
        yield Case("strong, 1e6", ranks, 1_000_000)


def study(program, path, largest, n_workers, most_ranks):
    fields = (
        "n_discs",
        "steps",
        "messages",
        "most_messages",
        "bytes",
        "collectives",
        "any_to_any",
        "network_messages",
        "step_seconds",
        "own_seconds",
        "efficiency",
    )
    chosen = [case for case in cases() if case.n_discs <= largest and case.ranks <= most_ranks]
    tasks = [
        [case for case in chosen if case.n_discs > ONE_AT_A_TIME]
    ]  # two at a time might need too much memory
    tasks += [[case] for case in chosen if case.n_discs <= ONE_AT_A_TIME]

    def run(case):
        start = time.monotonic()
        found = simulated(program, case)
        print(
            f"{case.name}, {case.ranks} ranks: efficiency {float(found['efficiency']):.3f},"
            f" {float(found['messages']):.2f} messages a rank and step"
            f" ({time.monotonic() - start:.0f} s)",
            file=sys.stderr,
        )
        return case, found

    results = []
    has_changed = threading.Lock()

    def run_all(of_task):
        for case in of_task:
            add(*run(case))

    def add(case, found):
        with has_changed:
            results.append((case, found))
            results.sort(key=lambda result: (result[0].name, result[0].ranks))
            with open(
                path, "w", encoding="utf-8", newline=""
            ) as file:  # written again each time, so that an early end loses nothing
                table = csv.writer(file, lineterminator="\n")
                table.writerow(["case", "ranks", "stands_for", *fields, "ns_own", "ns_halo"])
                for done, numbers in results:
                    table.writerow(
                        [done.name, done.ranks, done.stands_for]
                        + [numbers[field] for field in fields]
                        + [done.ns_own, done.ns_halo]
                    )

    with concurrent.futures.ThreadPoolExecutor(n_workers) as workers:
        for finished in concurrent.futures.as_completed(
            [workers.submit(run_all, task) for task in tasks]
        ):
            finished.result()


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("program", metavar="SIMULATED_CLUSTER")
    parser.add_argument("--record", action="store_true")
    parser.add_argument("--study", metavar="FILE")
    parser.add_argument(
        "--largest",
        type=float,
        default=2.1e7,
        help=(
            "of the study: leave out what has more discs; 5e6 take 1.8 GB, 2e7, which 1024 ranks"
            " need, 13 GB"
        ),
    )
    parser.add_argument(
        "--most-ranks",
        type=int,
        default=1024,
        help="of the study; 1024 take some six minutes a case",
    )
    parser.add_argument(
        "--jobs", type=int, default=2, help="of the study: so many simulations side by side"
    )
    options = parser.parse_args()
    if options.study:
        study(options.program, options.study, options.largest, options.jobs, options.most_ranks)
    elif options.record:
        record(options.program)
    else:
        return compare(options.program)
    return 0


if __name__ == "__main__":
    sys.exit(main())
