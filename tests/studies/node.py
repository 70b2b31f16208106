#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measure what a whole node does: how near one run on all cores comes to separate runs on each.

  tests/studies/node.py CARROM [--seconds 120] [--csv FILE] [--mpiexec mpiexec]

It needs nothing but the program, and an mpiexec for more than one rank. A case is a method, a kind
of sides, a number of discs and of steps. For each it runs, one after another,

  separate   as many runs of one thread at once as there are cores: what the machine can do
  1xN        one rank of N threads
  Nx1        N ranks of one thread
  (N/4)x4    and (N/2)x2, where that is another shape

and prints a line each: collisions, or disc-steps of the time-stepped method, in millions a second
of the steps alone; the share of what separate runs reach; the seconds of set-up, which come beside;
and the phases in percent of the steps. Lines "bound" run 1xN with OMP_PROC_BIND=close.

Cases come in the order of what they tell. One that would end after the given seconds, by the time
that those before it took, is named at the end and left out. Each figure is of one run, so repeat
the command to see how far the machine scatters. Discs of separate runs are a million at most, for
the sake of memory.
"""
import argparse
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

SCENE = """[box]
size = {size!r}
left.kind = "{kind}"
right.kind = "{kind}"
bottom.kind = "{kind}"
top.kind = "{kind}"
[discs]
count = {discs}
radius = 1
speed = {speed}
[time]
steps = {steps}
method = "{method}"
[output]
averages_from_step = {steps}
"""
PI = 3.141592653589793
PACKING = {"event-driven": 0.3, "time-stepped": 0.2}
# In the gas of the time-stepped method speeds are some third of a radius in a step, in the slow one
# a hundredth.
SPEED = {"gas": 0.35, "slow gas": 0.01}
# Method, speeds, sides, discs, steps.
CASES = [
    ("event-driven", "gas", "periodic", 1e6, 10), ("event-driven", "gas", "wall", 1e6, 10),
    ("time-stepped", "slow gas", "periodic", 1e6, 40),
    ("time-stepped", "slow gas", "wall", 1e6, 40),
    ("event-driven", "gas", "periodic", 1e5, 100), ("event-driven", "gas", "wall", 1e5, 100),
    ("time-stepped", "gas", "periodic", 1e6, 10), ("time-stepped", "gas", "wall", 1e6, 10),
    ("time-stepped", "slow gas", "periodic", 1e5, 100),
    ("time-stepped", "slow gas", "wall", 1e5, 100),
    ("event-driven", "gas", "periodic", 1e6, 100), ("event-driven", "gas", "wall", 1e6, 100),
    ("event-driven", "gas", "periodic", 1e7, 10), ("time-stepped", "gas", "wall", 1e7, 10),
]
MOST_SEPARATE = 1e6
WORK_OF_PHASES = ("redistribute", "search", "resolve", "conflicts", "move", "exchange", "wait",
                  "sync")
COLUMNS = ["method", "gas", "sides", "discs", "steps", "shape", "millions_a_second",
           "share_of_separate", "seconds", "set_up", *WORK_OF_PHASES]


def shapes_of(cores, has_mpi):
    """Ranks and threads of each shape, without repeats."""
    shapes = [(1, cores)]
    if has_mpi:
        shapes += [(cores, 1)] + [(cores // n, n) for n in (4, 2) if cores > n and cores % n == 0]
    return list(dict.fromkeys(shapes))


class Node:
    """Runs of the program on this machine, in a folder of their own."""

    def __init__(self, options, folder):
        self.program = str(pathlib.Path(options.program).resolve())
        self.mpiexec = shutil.which(options.mpiexec)
        self.cores = len(os.sched_getaffinity(0))
        self.folder = pathlib.Path(folder)

    def write(self, case, discs):
        """The scene of a case for so many discs."""
        method, gas, kind, _, steps = case
        scene = self.folder / f"scene_{discs:.0f}.toml"
        scene.write_text(SCENE.format(size=(discs * PI / PACKING[method]) ** 0.5, kind=kind,
                                      discs=round(discs), speed=SPEED[gas], steps=steps,
                                      method=method), encoding="utf-8")
        return scene

    def start(self, scene, report, ranks, threads, **variables):
        """A run that has begun."""
        words = [self.program, "run", str(scene), "--quiet", "--threads", str(threads),
                 "--report", str(report)]
        if ranks > 1:
            words = [self.mpiexec, "-n", str(ranks), *words]
        return subprocess.Popen(words, cwd=self.folder, env=os.environ | variables,
                                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)

    def reports(self, scene, count, ranks, threads, **variables):
        """What so many runs at once report."""
        files = [self.folder / f"report_{k}.json" for k in range(count)]
        runs = [self.start(scene, file, ranks, threads, **variables) for file in files]
        for run in runs:
            _, said = run.communicate()
            if run.returncode != 0:
                sys.exit(f"{' '.join(run.args)} ended with code {run.returncode}:\n{said}")
        return [json.loads(file.read_text(encoding="utf-8")) for file in files]

    def measure(self, case, shape):
        """A row of the table, without the share of separate runs."""
        method, gas, kind, discs, steps = case
        name, count, ranks, threads, variables = shape
        if count > 1:
            discs = min(discs, MOST_SEPARATE)
        reports = self.reports(self.write(case, discs), count, ranks, threads, **variables)
        rate = sum(work_of(report) / report["wall_seconds"] for report in reports) / 1e6
        phases = reports[0]["phase_seconds"]
        # Times of phases are sums over ranks, or those of the slowest rank, so they are given in
        # percent of their own sum.
        total = sum(phases[phase] for phase in WORK_OF_PHASES) or 1
        return {"method": method, "gas": gas, "sides": kind, "discs": f"{discs:.0e}",
                "steps": steps, "shape": name, "millions_a_second": rate,
                "seconds": max(report["wall_seconds"] for report in reports),
                "set_up": max(report["phase_seconds"]["set-up"] for report in reports),
                **{phase: 100 * phases[phase] / total for phase in WORK_OF_PHASES}}


def work_of(report):
    """Collisions of pairs, or disc-steps of the method that has no other measure."""
    if report["method"] == "event-driven":
        return report["pair_collisions"]
    return report["n_discs"] * report["steps"] * report["micro_steps"]


def line_of(row):
    """A row for the eye; phases below a percent are left out."""
    phases = ", ".join(f"{phase} {row[phase]:.0f}" for phase in WORK_OF_PHASES if row[phase] >= 1)
    return (f"{row['method']:<13}{row['gas']:<9}{row['sides']:<9}{row['discs']:>7}"
            f"{row['steps']:>6} {row['shape']:<9}{row['millions_a_second']:>9.2f}"
            f"{row['share_of_separate']:>6.2f}"
            f"{row['seconds']:>8.2f}{row['set_up']:>7.2f}  {phases}")


def measure_all(node, seconds):
    """Rows of the cases that the time allows, and the others."""
    begin, longest, rows, left = time.monotonic(), {}, [], []
    bound = {"OMP_PROC_BIND": "close", "OMP_PLACES": "cores"}
    for case in CASES:
        method, gas, _, discs, steps = case
        expected = longest.get((method, gas), 0) * discs * steps
        if time.monotonic() - begin + expected > seconds:
            left.append(case)
            continue
        shapes = [("separate", node.cores, 1, 1, {})]
        for ranks, threads in shapes_of(node.cores, node.mpiexec):
            shapes.append((f"{ranks}x{threads}", 1, ranks, threads, {}))
        shapes.append(("bound", 1, 1, node.cores, bound))
        first = time.monotonic()
        can = None
        for shape in shapes:
            row = node.measure(case, shape)
            can = can or row["millions_a_second"]
            row["share_of_separate"] = row["millions_a_second"] / can
            print(line_of(row), flush=True)
            rows.append(row)
        longest[method, gas] = (time.monotonic() - first) / (discs * steps)
    return rows, left


def main():
    """Print the table, and write it if a file is named."""
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--seconds", type=float, default=120)
    parser.add_argument("--csv", help="for the rows")
    parser.add_argument("--mpiexec", default=os.environ.get("CARROM_MPIEXEC", "mpiexec"))
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        node = Node(options, folder)
        print(f"{node.cores} cores; {'with' if node.mpiexec else 'no'} mpiexec")
        print(f"{'method':<13}{'gas':<9}{'sides':<9}{'discs':>7}{'steps':>6} {'shape':<9}"
              f"{'10^6/s':>9}{'share':>6}{'seconds':>8}{'set-up':>7}  phases, percent")
        rows, left = measure_all(node, options.seconds)
    for case in left:
        print("left out, no time:", *case)
    if options.csv:
        with open(options.csv, "w", newline="", encoding="utf-8") as file:
            table = csv.DictWriter(file, COLUMNS)
            table.writeheader()
            table.writerows(rows)


if __name__ == "__main__":
    main()
