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

TOLERANCE = 0.03
FOLDER = os.path.dirname(os.path.abspath(__file__))
TABLE = os.path.join(FOLDER, "messages.csv")
PLATFORM = os.path.join(FOLDER, "fat_tree.xml")
PINNED = ("messages", "most_messages", "bytes", "collectives", "network_messages")
STEPS = 64
# Nanoseconds that a rank computes for: per own disc and micro-step, and per disc of the halo that comes (once a window).
# Measured on one core (docs/performance.md): a gas of 1e5 discs a rank; a disc in a window, cells and filter included.
NS_OWN, NS_HALO = 23.0, 60.0


def gas(n_discs, packing, rule, steps):
    """Discs of radius 1, speeds spread evenly up to half a radius per step; from a lattice, which the steps before those that count forget."""
    size = math.sqrt(n_discs * math.pi / packing)
    return (f"[box]\nsize = {size!r}\n[discs]\ncount = {n_discs}\nradius = 1.0\ngenerator = \"lattice\"\nvelocities = \"uniform\"\n"
            f"speed = {0.5 / math.sqrt(3)!r}\n[time]\nsteps = {steps}\ncollisions = \"{rule}\"\n")


def simulated(program, ranks, scene, stands_for=1, timeout=600):
    """One run's numbers, by the names in the program's heading."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "scene.toml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(scene)
        command = [program, PLATFORM, str(ranks), path, str(STEPS), str(NS_OWN), str(NS_HALO), str(stands_for), "--log=root.thresh:warning"]
        heading = subprocess.run([program], capture_output=True, text=True, check=True).stdout.strip()
        run = subprocess.run(command, capture_output=True, text=True, timeout=timeout, check=False, env={**os.environ, "OMP_NUM_THREADS": "1"})
    if run.returncode != 0:
        sys.exit(f"{' '.join(command)} failed:\n{run.stderr}")
    return dict(zip(heading.split(","), run.stdout.strip().splitlines()[-1].split(",")))


def pinned(program):
    return {rule: simulated(program, 16, gas(16_000, 0.2, rule, 2 * STEPS)) for rule in ("one", "all")}


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
    """Name, ranks, discs, packing, discs that one stands for; largest first, for several to run side by side."""
    for ranks in (1024, 256, 64, 16, 1):
        yield "weak, 2e3 a rank", ranks, 2000 * ranks, 0.2, 1
        yield "weak, 2e4 a rank", ranks, 20_000 * ranks, 0.2, 1
        # 5e3 discs a rank stand for 200 each, in the box of all those: strips, halos and windows are theirs.
        yield "weak, 1e6 a rank", ranks, 5000 * ranks, 0.2 / 200, 200
        yield "strong, 1e6", ranks, 1_000_000, 0.2, 1


def study(program, path, largest, n_workers, most_ranks):
    fields = ("n_discs", "steps", "messages", "most_messages", "bytes", "collectives", "any_to_any", "network_messages", "step_seconds", "own_seconds", "efficiency")
    chosen = [case for case in cases() if case[2] <= largest and case[1] <= most_ranks]

    def run(case):
        name, ranks, n_discs, packing, stands_for = case
        start = time.monotonic()
        found = simulated(program, ranks, gas(n_discs, packing, "one", 2 * STEPS), stands_for, 3600)
        print(f"{name}, {ranks} ranks: efficiency {float(found['efficiency']):.3f}, {float(found['messages']):.2f} messages "
              f"a rank and step ({time.monotonic() - start:.0f} s)", file=sys.stderr)
        return name, ranks, stands_for, found

    results = []
    with concurrent.futures.ThreadPoolExecutor(n_workers) as workers:
        for finished in concurrent.futures.as_completed([workers.submit(run, case) for case in chosen]):
            results = sorted([*results, finished.result()], key=lambda result: result[:2])
            with open(path, "w", encoding="utf-8", newline="") as file: # anew each time: an end before the end loses nothing
                table = csv.writer(file, lineterminator="\n")
                table.writerow(["case", "ranks", "stands_for", *fields, "ns_own", "ns_halo"])
                for name, ranks, stands_for, found in results:
                    table.writerow([name, ranks, stands_for] + [found[field] for field in fields] + [NS_OWN, NS_HALO])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", metavar="SIMULATED_CLUSTER")
    parser.add_argument("--record", action="store_true")
    parser.add_argument("--study", metavar="FILE")
    parser.add_argument("--largest", type=float, default=5.2e6, help="of the study: leave out what has more discs; 5e6 take 1.5 GB")
    parser.add_argument("--most-ranks", type=int, default=1024, help="of the study; 1024 take many minutes")
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
