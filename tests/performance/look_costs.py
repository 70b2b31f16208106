#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Count what a look at all positions after each step costs beside one call for all steps.

  tests/performance/look_costs.py LOOK_COSTS             code 1 if a slow gas of 4000 discs takes
                                                         over 30 % more
  tests/performance/look_costs.py LOOK_COSTS --table     gases of many packings and speeds, at 1e4
                                                         discs: some ten minutes
  tests/performance/look_costs.py LOOK_COSTS --shapes    the slow gas with 1e4 discs on one and two
                                                         threads and on two ranks, which mpiexec or
                                                         the variable CARROM_MPIEXEC starts
  tests/performance/look_costs.py LOOK_COSTS --clock     the same by the clock: medians of seven
                                                         pairs of runs, some five minutes

valgrind counts (callgrind, without its cache model) what happens below `step_and_look` of the
program look_costs: 32 steps on one thread, after 64 others, with the averages that every run takes.
With fewer discs, what a call costs whatever their number counts more. On several threads or ranks
it counts what all of them do.
Without valgrind the test is left out, with code 77.
"""

import argparse
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from typing import NamedTuple

STEPS, MOST = 32, 1.3
TIMED_STEPS, PAIRS = 4000, 7
SIDES = ("left", "right", "bottom", "top")
METHODS = ("event-driven", "time-stepped")


class Shape(NamedTuple):
    """Ranks and threads of each."""

    ranks: int = 1
    threads: int = 1


class Counted(NamedTuple):
    """What one run has shown."""

    state_hash: str
    rate: float  # collisions of a disc in a step
    instructions: float  # for each disc and step


def scene_of(count: int, packing: float, speed: float, is_periodic: bool) -> str:
    """Return the scene in lengths of about a radius, at any packing."""
    size = (3.14159 * count / packing) ** 0.5
    sides = "".join(f'{side}.kind = "periodic"\n' for side in SIDES) if is_periodic else ""
    return (
        f"[box]\nsize = {size:.6g}\n{sides}[discs]\ncount = {count}\npacking = {packing}\n"
        f"speed = {speed}\nseed = 3210\n[time]\nsteps = 1\n"
    )


def collected(words: list, shape: Shape, options: tuple = ()) -> tuple:
    """Run a program under callgrind; return what it prints and the instructions of all ranks."""
    launcher = [os.environ.get("CARROM_MPIEXEC", "mpiexec"), "-n", str(shape.ranks)]
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run(
            [
                *(launcher if shape.ranks > 1 else []),
                "valgrind",
                "--tool=callgrind",
                f"--callgrind-out-file={folder}/out.%p",
                *options,
                *words,
            ],
            env={**os.environ, "OMP_NUM_THREADS": str(shape.threads), "GOMP_SPINCOUNT": "0"},
            capture_output=True,
            text=True,
            timeout=600,
            check=False,
        )
    found = re.findall(r"Collected : (\d+)", run.stderr)
    if run.returncode != 0 or len(found) != shape.ranks:
        sys.exit(f"{' '.join(words)} failed:\n{run.stderr}")
    return run.stdout.split(), sum(map(int, found))


def counted(program: str, scene: str, method: str, every: int, shape: Shape) -> Counted:
    """Return what a run with a look after each `every` steps takes; 0: with no look."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "scene.toml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(scene)

        def words(steps: int) -> list:
            return [program, path, str(steps), str(every), f"time.method={method}"]

        if shape == Shape():
            only = ("--collect-atstart=no", "--toggle-collect=step_and_look*")
            printed, instructions = collected(words(STEPS), shape, only)
        else:  # callgrind would leave out what other threads do
            printed, instructions = collected(words(STEPS), shape)
            instructions -= collected(words(0), shape)[1]
    state_hash, rate = printed
    count = int(re.search(r"count = (\d+)", scene).group(1))
    return Counted(state_hash, float(rate), instructions / STEPS / count)


def compare(program: str, scene: str, method: str, shape: Shape = Shape()) -> float:
    """Print and return the ratio of both runs, which must have the same state."""
    once, each = (counted(program, scene, method, every, shape) for every in (0, 1))
    ratio = each.instructions / once.instructions
    print(
        f"{method}: {once.rate:.3g} collisions a disc and step; {once.instructions:.0f} "
        f"instructions in one call, {each.instructions:.0f} with a look at each step: {ratio:.2f}"
    )
    if once.state_hash != each.state_hash:
        sys.exit("the two runs have different states")
    return ratio


def seconds(words: list, shape: Shape) -> float:
    """Return how long a program takes."""
    launcher = [os.environ.get("CARROM_MPIEXEC", "mpiexec"), "-n", str(shape.ranks)]
    begin = time.perf_counter()
    subprocess.run(
        [*(launcher if shape.ranks > 1 else []), *words],
        env={**os.environ, "OMP_NUM_THREADS": str(shape.threads)},
        stdout=subprocess.DEVNULL,
        check=True,
    )
    return time.perf_counter() - begin


def time_pairs(program: str, scene: str, method: str, shape: Shape) -> None:
    """Print the ratio of the times of runs with and without looks, which take turns."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "scene.toml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(scene)

        def taken(every: int) -> float:
            starts, whole = (
                seconds([program, path, str(steps), str(every), f"time.method={method}"], shape)
                for steps in (0, TIMED_STEPS)
            )
            return whole - starts

        pairs = [(taken(0), taken(1)) for _ in range(PAIRS)]
    ratios = sorted(each / once for once, each in pairs)
    once = statistics.median(once for once, _ in pairs)
    print(
        f"{method}: {once:.2f} s in one call; with a look at each step "
        f"{statistics.median(ratios):.2f} times as long ({ratios[1]:.2f} to {ratios[-2]:.2f})",
        flush=True,
    )


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", metavar="LOOK_COSTS")
    parser.add_argument("--table", action="store_true")
    parser.add_argument("--shapes", action="store_true")
    parser.add_argument("--clock", action="store_true")
    options = parser.parse_args()
    if not options.clock and not shutil.which("valgrind"):
        print("left out: there is no valgrind")
        return 77
    if options.shapes or options.clock:
        for is_periodic in (False, True):
            for shape in (Shape(), Shape(threads=2), Shape(ranks=2)):
                sides = "periodic sides" if is_periodic else "walls"
                print(f"{sides}, {shape.ranks} x {shape.threads}")
                scene = scene_of(10_000, 0.3, 0.1, is_periodic)
                for method in METHODS:
                    (time_pairs if options.clock else compare)(
                        options.program, scene, method, shape
                    )
        return 0
    if not options.table:
        ratios = []
        for is_periodic in (False, True):
            print("periodic sides" if is_periodic else "walls")
            scene = scene_of(4000, 0.3, 0.1, is_periodic)
            ratios += [compare(options.program, scene, method) for method in METHODS]
        return int(max(ratios) > MOST)
    for is_periodic in (False, True):
        for packing in (0.05, 0.3, 0.6):
            for speed in (0.03, 0.1, 0.3, 1):
                sides = "periodic sides" if is_periodic else "walls"
                print(f"{sides}, packing {packing}, speed {speed}")
                for method in METHODS:
                    compare(
                        options.program, scene_of(10_000, packing, speed, is_periodic), method
                    )
    return 0


sys.exit(main())
