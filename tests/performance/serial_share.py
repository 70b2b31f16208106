#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Count which share of a rank's instructions one thread carries out while the others wait.

  tests/performance/serial_share.py STEP_SCENE MPIEXEC                print the shares; code 1 if
                                                                      one is 10 % above CASES
  tests/performance/serial_share.py STEP_SCENE MPIEXEC --functions    and functions behind them

valgrind counts (callgrind, without its cache model) what the first thread of a rank carries out
below EngineBase::advance_towards. Serial is what it does outside of parallel regions and of calls
of MPI, in which ranks wait for each other. The share is that divided by the instructions of a rank
with one thread. So n threads are at most 1 / (share + 1 / n) times as fast as one. What a region
lets a single thread do does not count as serial.
"""

import argparse
import collections
import os
import re
import shutil
import subprocess
import sys
import tempfile

from instructions import SETTINGS

TOLERANCE = 0.1
DISCS_OF_RANK = 100000
SCENE = """[box]
size = {size}
[discs]
count = {discs}
radius = 1
speed = 0.3
[time]
steps = 16
method = "{method}"
[output]
averages_from_step = 16
[box.left]
kind = "{kind}"
[box.right]
kind = "{kind}"
"""
# name, method, packing, kind of the left and the right side, ranks, recorded share
CASES = [
    ("time-stepped, 1 rank", "time-stepped", 0.2, "wall", 1, 0.0005),
    ("event-driven, 1 rank", "event-driven", 0.2, "wall", 1, 0.0007),
    ("time-stepped, 2 ranks", "time-stepped", 0.2, "wall", 2, 0.0020),
    ("event-driven, 2 ranks", "event-driven", 0.2, "wall", 2, 0.0010),
    ("time-stepped, 2 ranks, periodic", "time-stepped", 0.2, "periodic", 2, 0.0027),
    ("event-driven, 2 ranks, periodic", "event-driven", 0.2, "periodic", 2, 0.0015),
]
ADVANCE = "carrom::EngineBase*::advance_towards*"


def counts_of(path):
    """What a file of callgrind has: instructions by function, and calls as a list of (function,
    called function, instructions with all that it calls)."""
    own, calls = collections.Counter(), []
    function = called = ""
    is_call = False
    with open(path, encoding="utf-8", errors="replace") as file:
        for line in file:
            if line.startswith("fn="):
                function = line[3:].strip()
            elif line.startswith("cfn="):
                called = line[4:].strip()
            elif line.startswith("calls="):
                is_call = True
            elif line[:1].isdigit() and function:
                cost = int(line.split()[1])
                if is_call:
                    calls.append((function, called, cost))
                else:
                    own[function] += cost
                is_call = False
    return own, calls


def is_outside(name):
    """Whether a call leaves the serial part of a rank."""
    return name.startswith(("GOMP_parallel", "MPI_", "PMPI_"))


def run(program, mpiexec, scene, n_ranks, n_threads, folder):
    """Runs step_scene, and returns the instructions of all ranks, without MPI, and those outside of
    parallel regions, by function."""
    for name in os.listdir(folder):
        if name.startswith("out"):
            os.remove(os.path.join(folder, name))
    command = [mpiexec, "-n", str(n_ranks), "valgrind", "--tool=callgrind", "--compress-pos=no",
               "--compress-strings=no", f"--callgrind-out-file={folder}/out.%p",
               "--collect-atstart=no", f"--toggle-collect={ADVANCE}", program, scene,
               str(n_threads)]
    env = {**os.environ, **SETTINGS, "OMPI_MCA_rmaps_base_oversubscribe": "1"}
    done = subprocess.run(command, env=env, capture_output=True, text=True, timeout=1800,
                          check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} failed:\n{done.stderr}")
    total = in_mpi = in_parallel = 0
    serial = collections.Counter()
    for name in os.listdir(folder):
        if not name.startswith("out"):
            continue
        own, calls = counts_of(os.path.join(folder, name))
        total += sum(own.values())
        for caller, called, cost in calls:
            if is_outside(caller):
                continue
            if called.startswith("GOMP_parallel"):
                in_parallel += cost
            elif is_outside(called):
                in_mpi += cost
        serial.update(serial_functions(own, calls))
    return total - in_mpi, total - in_mpi - in_parallel, serial


def serial_functions(own, calls):
    """Instructions of functions that are reached from the steps without entering a parallel region
    or MPI. What a function does in both is counted here as a whole."""
    reached, edges = set(), collections.defaultdict(set)
    for caller, called, _ in calls:
        if not is_outside(called) and "._omp_fn" not in called:
            edges[caller].add(called)
    waiting = [name for name in own if re.search("advance_towards", name)]
    while waiting:
        name = waiting.pop()
        if name not in reached:
            reached.add(name)
            waiting.extend(edges[name])
    return {name: own[name] for name in reached}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", metavar="STEP_SCENE")
    parser.add_argument("mpiexec", metavar="MPIEXEC")
    parser.add_argument("--functions", action="store_true")
    parser.add_argument("--only", default="", help="cases whose names have this text")
    options = parser.parse_args()
    if not shutil.which("valgrind"):
        print("left out: there is no valgrind")
        return 77
    code = 0
    with tempfile.TemporaryDirectory() as folder:
        for name, method, packing, kind, n_ranks, recorded in CASES:
            if options.only not in name:
                continue
            discs = DISCS_OF_RANK * n_ranks
            scene = os.path.join(folder, "scene.toml")
            with open(scene, "w", encoding="utf-8") as file:
                file.write(SCENE.format(size=(discs * 3.141592653589793 / packing) ** 0.5,
                                        discs=discs, method=method, kind=kind))
            alone, _, _ = run(options.program, options.mpiexec, scene, n_ranks, 1, folder)
            _, serial, functions = run(options.program, options.mpiexec, scene, n_ranks, 2, folder)
            share = serial / alone
            code = code or int(share > (1 + TOLERANCE) * recorded)
            print(f"{name}: {serial / n_ranks:.0f} of {alone / n_ranks:.0f} instructions of a rank"
                  f" are serial, {100 * share:.2f} %", flush=True)
            for function, cost in functions.most_common(16) if options.functions else []:
                print(f"  {100 * cost / alone:.3f} % {function[:150]}")
    return code


if __name__ == "__main__":
    sys.exit(main())
