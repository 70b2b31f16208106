#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Count messages, and predict scaling, on a simulated cluster (SimGrid): tests/performance/simulated_cluster.cpp.

  tests/performance/simulate.py SIMULATED_CLUSTER                   compare with messages.csv; code 1 if a number is off by 3 %
  tests/performance/simulate.py SIMULATED_CLUSTER --record          write messages.csv anew
  tests/performance/simulate.py SIMULATED_CLUSTER --study FILE      16 to 1024 ranks, weak and strong scaling, as CSV: minutes

What is compared does not depend on the machine, nor on how fast anything is: messages, bytes and collective operations per
rank and step, on 16 ranks of 1000 discs. That calls whose messages grow with the ranks (any-to-any) stay at zero is a demand of its own.
"""
import argparse
import concurrent.futures
import csv
import math
import os
import subprocess
import sys
import tempfile
import time
from typing import NamedTuple

TOLERANCE = 0.03
FOLDER = os.path.dirname(os.path.abspath(__file__))
TABLE = os.path.join(FOLDER, "messages.csv")
PLATFORM = os.path.join(FOLDER, "fat_tree.xml")
PINNED = ("messages", "most_messages", "bytes", "collectives", "network_messages")
# Nanoseconds that a rank computes for: per own disc and micro-step of the gas, of the slow gas, and per disc of the halo that
# comes (once a window). Measured on one core (docs/performance.md): a gas of 1e5 discs a rank, a slow one of 1e6; a disc in a
# window, cells and filter included.
NS_OWN, NS_OWN_SLOW, NS_HALO = 23.0, 3.8, 60.0


class Case(NamedTuple):
    """Discs of packing 0.2; each stands for `stands_for`, in the box of all those, in windows as long as theirs (0: as it chooses)."""
    name: str
    ranks: int
    n_discs: int
    stands_for: int = 1
    window: int = 0
    speed: float = 0.5 / math.sqrt(3) # radii per step, root mean square
    ns_own: float = NS_OWN
    steps: int = 64


def gas(case, rule="one"):
    """Discs of radius 1; from a lattice, which the steps before those that count forget. Speeds are spread evenly where discs meet
    often enough to change that, else they are what that changes them to, Maxwell's."""
    size = math.sqrt(case.n_discs * math.pi / (0.2 / case.stands_for))
    return (f"[box]\nsize = {size!r}\n[discs]\ncount = {case.n_discs}\nradius = 1.0\ngenerator = \"lattice\"\n"
            f"velocities = \"{'uniform' if case.stands_for == 1 else 'maxwell'}\"\nspeed = {case.speed!r}\n[time]\nsteps = {64 + case.steps}\ncollisions = \"{rule}\"\n")


def simulated(program, case, rule="one", timeout=3600):
    """One run's numbers, by the names in the program's heading."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "scene.toml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(gas(case, rule))
        numbers = [str(n) for n in (case.steps, case.ns_own, NS_HALO, case.stands_for, case.window)]
        command = [program, PLATFORM, str(case.ranks), path, *numbers, "--log=root.thresh:warning"]
        heading = subprocess.run([program], capture_output=True, text=True, check=True).stdout.strip()
        run = subprocess.run(command, capture_output=True, text=True, timeout=timeout, check=False, env={**os.environ, "OMP_NUM_THREADS": "1"})
    if run.returncode != 0:
        sys.exit(f"{' '.join(command)} failed:\n{run.stderr}")
    return dict(zip(heading.split(","), run.stdout.strip().splitlines()[-1].split(",")))


def pinned(program):
    return {rule: simulated(program, Case("pinned", 16, 16_000), rule, 600) for rule in ("one", "all")}


def record(program):
    with open(TABLE, "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["rule", *PINNED])
        for rule, found in pinned(program).items():
            table.writerow([rule] + [found[name] for name in PINNED])


def compare(program):
    code = 0
    now = pinned(program)
    with open(TABLE, encoding="utf-8") as file:
        for row in csv.DictReader(file):
            found = now[row["rule"]]
            for name in PINNED:
                before, after = float(row[name]), float(found[name])
                print(f"rule \"{row['rule']}\", per rank and step: {name} {after:g}, recorded {before:g}")
                if abs(after - before) > TOLERANCE * before:
                    print("  if that is meant, record it and say why (tests/performance/simulate.py SIMULATED_CLUSTER --record)")
                    code = 1
            if float(found["any_to_any"]) != 0:
                print(f"  {found['any_to_any']} calls a step whose messages grow with the number of ranks")
                code = 1
    return code


def cases():
    """Largest first, for several to run side by side."""
    for ranks in (1024, 256, 64, 16, 1):
        yield Case("weak, 1e6 a rank, slow", ranks, 20_000 * ranks, stands_for=50, speed=0.01 * math.sqrt(2), ns_own=NS_OWN_SLOW)
        yield Case("weak, 1e6 a rank", ranks, 20_000 * ranks, stands_for=50, window=3)
        yield Case("strong, 1e8", ranks, 2_000_000, stands_for=50, window=3)
        if ranks == 1024:
            continue # these have strips about as narrow as what a window looks at
        yield Case("weak, 2e4 a rank", ranks, 20_000 * ranks)
        yield Case("weak, 2e3 a rank", ranks, 2000 * ranks)
        yield Case("strong, 1e6", ranks, 1_000_000)


def study(program, path, largest, n_workers, most_ranks):
    fields = ("n_discs", "steps", "messages", "most_messages", "bytes", "collectives", "any_to_any", "network_messages", "step_seconds", "own_seconds", "efficiency")
    chosen = [case for case in cases() if case.n_discs <= largest and case.ranks <= most_ranks]

    def run(case):
        start = time.monotonic()
        found = simulated(program, case)
        print(f"{case.name}, {case.ranks} ranks: efficiency {float(found['efficiency']):.3f}, {float(found['messages']):.2f} messages "
              f"a rank and step ({time.monotonic() - start:.0f} s)", file=sys.stderr)
        return case, found

    results = []
    with concurrent.futures.ThreadPoolExecutor(n_workers) as workers:
        for finished in concurrent.futures.as_completed([workers.submit(run, case) for case in chosen]):
            results = sorted([*results, finished.result()], key=lambda result: (result[0].name, result[0].ranks))
            with open(path, "w", encoding="utf-8", newline="") as file: # anew each time: an end before the end loses nothing
                table = csv.writer(file, lineterminator="\n")
                table.writerow(["case", "ranks", "stands_for", *fields, "ns_own", "ns_halo"])
                for case, found in results:
                    table.writerow([case.name, case.ranks, case.stands_for] + [found[field] for field in fields] + [case.ns_own, NS_HALO])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", metavar="SIMULATED_CLUSTER")
    parser.add_argument("--record", action="store_true")
    parser.add_argument("--study", metavar="FILE")
    parser.add_argument("--largest", type=float, default=2.1e7, help="of the study: leave out what has more discs; 5e6 take 1.8 GB, 2e7, which 1024 ranks need, 13 GB")
    parser.add_argument("--most-ranks", type=int, default=1024, help="of the study; 1024 take some six minutes a case")
    parser.add_argument("--jobs", type=int, default=2, help="of the study: so many simulations side by side")
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
