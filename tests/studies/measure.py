#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measure what a disc-step costs, and write one CSV row per run (docs/understanding/performance.md
shows the medians).

  tests/studies/measure.py --program build/carrom --output rates.csv [--only NAME ...] [--rounds
  5]

All cases of a round run one after the other before the next round begins, so that a drift of the
machine's speed falls on all of them. Nothing here passes or fails. Needs nothing but Python and
mpirun.
"""

import argparse
import csv
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile

SETTINGS_FILE = os.path.join(
    os.path.dirname(__file__), "..", "..", "job_scripts", "mpi_settings.txt"
)
with open(SETTINGS_FILE, encoding="utf-8") as settings:
    MPI_SETTINGS = dict(
        line.split()[1].split("=") for line in settings if line.startswith("always ")
    )
# Threads wait as in a run on cores of its own, whatever the shell has set.
WAITS = ("OMP_WAIT_POLICY", "GOMP_SPINCOUNT")
ENVIRONMENT = {
    name: value for name, value in os.environ.items() if name not in WAITS
} | MPI_SETTINGS


def gas(n_discs, steps, packing=0.2, largest_speed=0.5, method="time-stepped"):
    """A gas of discs of radius 1 with speeds spread evenly up to `largest_speed` (half a radius
    unless said).
    """
    size = math.sqrt(n_discs * math.pi / packing)
    return (
        (
            f"[box]\nsize = {size!r}\n[discs]\ncount = {n_discs}\nradius = 1.0\nvelocities ="
            f" \"uniform\"\nspeed = {largest_speed / math.sqrt(3)!r}\n[time]\nsteps ="
            f" {steps}\nmethod = \"{method}\"\n"
        ),
        "toml",
    )


def fast(n_discs, steps):
    """The course program's generated scene: L = 20000, r = 1, speeds L/8 to L/4 per step."""
    return f"{n_discs}\n20000\n1\n{steps}\nperf\n", "in"


def exact(n_discs, packing, n_collisions):
    """A gas in the event-driven method, for about so many collisions of pairs (Enskog's rate)."""
    size = math.sqrt(n_discs * math.pi / packing)
    contact = (1 - 7 * packing / 16) / (1 - packing) ** 2
    per_step = n_discs * math.sqrt(2 / math.pi) * packing * contact
    steps = max(1, round(n_collisions / per_step))
    return (
        (
            f"[box]\nsize = {size!r}\n[discs]\ncount = {n_discs}\nradius = 1.0\nspeed = 1.0\n"
            f"[time]\nsteps = {steps}\nmethod = \"event-driven\"\n"
        ),
        "toml",
    )


EXACT_SIZES = {"1e4": (10_000, 4e6), "1e5": (100_000, 4e6), "1e6": (1_000_000, 1.2e7)}

# name: (scene, ranks, threads)
CASES = (
    {
        "gas 1e4": (gas(10_000, 4000), 1, 1),
        "gas 1e5": (gas(100_000, 512), 1, 1),
        "gas 1e6": (gas(1_000_000, 64), 1, 1),
        "gas 1e6, 2 threads": (gas(1_000_000, 64), 1, 2),
        "gas 1e6, 2 ranks": (gas(1_000_000, 64), 2, 1),
        "gas 1e7": (gas(10_000_000, 32), 1, 1),
        "fast 1e4": (fast(10_000, 64), 1, 1),
        "fast 6.4e4": (fast(64_000, 8), 1, 1),
    }
    | {
        f"exact {size}, packing {packing}": (exact(n_discs, packing, n_collisions), 1, 1)
        for size, (n_discs, n_collisions) in EXACT_SIZES.items()
        for packing in (0.1, 0.3, 0.5)
    }
    | {
        "exact 1e6, packing 0.3, 2 threads": (exact(1_000_000, 0.3, 1.2e7), 1, 2),
        "exact 1e6, packing 0.3, 2 ranks": (exact(1_000_000, 0.3, 1.2e7), 2, 1),
    }
)


def run(program, case, folder):
    (text, kind), ranks, threads = case
    scene, report = os.path.join(folder, f"scene.{kind}"), os.path.join(folder, "report.json")
    with open(scene, "w") as file:
        file.write(text)
    command = [program, "run", scene, "--threads", str(threads), "--quiet", "--report", report]
    if ranks > 1:
        command = ["mpirun", "-np", str(ranks)] + command
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, env=ENVIRONMENT)
    with open(report) as file:
        return json.load(file)


RESULTS = """
    ranks threads n_discs steps ns_per_disc_step pair_collisions wall_seconds
    peak_bytes_per_disc
""".split()


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--program", default="build/carrom")
    parser.add_argument("--output", default="rates.csv")
    parser.add_argument("--only", nargs="+", choices=CASES, default=list(CASES))
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()

    rates = {name: [] for name in options.only}
    collisions = {name: [] for name in options.only}
    with open(options.output, "w", newline="") as file, tempfile.TemporaryDirectory() as folder:
        table = csv.writer(file)
        table.writerow(["round", "case"] + RESULTS)
        for turn in range(options.rounds):
            for name in options.only:
                result = run(options.program, CASES[name], folder)
                rates[name].append(result["ns_per_disc_step"])
                table.writerow([turn, name] + [result[key] for key in RESULTS])
                file.flush()
                collisions[name].append(result["pair_collisions"] / result["wall_seconds"] / 1e6)
                print(
                    f"round {turn}  {name:36} {rates[name][-1]:10.2f} ns per disc-step",
                    file=sys.stderr,
                )
    print(
        "| case | ns per disc-step: median | least | most | million collisions per second"
        " |\n|---|---|---|---|---|"
    )
    for name, values in rates.items():
        print(
            f"| {name} | {statistics.median(values):.1f} | {min(values):.1f} | {max(values):.1f} "
            f"| {statistics.median(collisions[name]):.2f} |"
        )


if __name__ == "__main__":
    main()
