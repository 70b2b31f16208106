#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measure how fast checkpoints are written, beside what `dd conv=fdatasync` of the same size
reaches on the same disk.

  tests/studies/measure_checkpoints.py --program build/carrom --folder /scratch/me
      --shapes 1x1 1x2 2x1 2x2 --output docs/data/performance/checkpoints.csv

In each round dd and the program take turns, so that a disk that others use too treats both alike;
the ratio of a round is what counts, and the median of the rounds is told. A shape is ranks x
threads. Each run stores two checkpoints and keeps one; the time is the phase `output`, which is all
that the step loop waits for. Needs Python, dd and mpirun, and twice a checkpoint's room.
"""

import argparse
import csv
import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

from measure import ENVIRONMENT

CHECKPOINTS = 2
COLUMNS = ("discs", "ranks_x_threads", "checkpoint_MB_per_s", "dd_MB_per_s", "ratio_median",
           "ratio_least", "ratio_most")


def checkpoint_rate(program, n_discs, shape, folder):
    """Bytes of a checkpoint, and bytes per second."""
    report, kept = os.path.join(folder, "report.json"), os.path.join(folder, "kept")
    scene = os.path.join(folder, "scene.toml")
    with open(scene, "w") as file:
        file.write(
            f"[box]\nsize = {(n_discs * 10.0) ** 0.5!r}\n[discs]\ncount = {n_discs}\nradius ="
            f" 0.5\ngenerator = \"lattice\"\nspeed = 0.01\n[time]\nsteps = {CHECKPOINTS}\nmethod ="
            f" \"time-stepped\"\n[output]\nfolder = \"{kept}\"\n[output.checkpoint]\n"
            "every_steps = 1\nkeep = 1\n"
        )
    n_ranks, n_threads = shape.split("x")
    subprocess.run(
        [
            "mpirun",
            "-np",
            n_ranks,
            program,
            "run",
            scene,
            "--threads",
            n_threads,
            "--quiet",
            "--report",
            report,
        ],
        check=True,
        env=ENVIRONMENT,
    )
    checkpoints = os.path.join(kept, "checkpoints")
    size = os.path.getsize(os.path.join(checkpoints, os.listdir(checkpoints)[0]))
    shutil.rmtree(kept)
    with open(report) as file:
        seconds = json.load(file)["phase_seconds"]["output"]
    return size, CHECKPOINTS * size / seconds


def dd_rate(size, folder):
    """Bytes per second of as many plain writes of that size."""
    path = os.path.join(folder, "plain")
    seconds = 0.0
    for _ in range(CHECKPOINTS):
        start = time.perf_counter()
        subprocess.run(
            [
                "dd",
                "if=/dev/zero",
                f"of={path}",
                "bs=1M",
                f"count={size >> 20}",
                "conv=fdatasync",
                "status=none",
            ],
            check=True,
        )
        seconds += time.perf_counter() - start
        os.unlink(path)
    return CHECKPOINTS * size / seconds


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--program", default="build/carrom")
    parser.add_argument("--folder", default=".", help="on the disk to be measured")
    parser.add_argument("--discs", type=int, default=10_000_000)
    parser.add_argument("--shapes", nargs="+", default=["1x1", "2x1"], metavar="RANKSxTHREADS")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--output", default="/dev/stdout", metavar="CSV")
    options = parser.parse_args()
    program = os.path.abspath(options.program)

    rates = {shape: [] for shape in options.shapes}
    with tempfile.TemporaryDirectory(dir=options.folder) as folder:
        for turn in range(options.rounds):
            for shape, found in rates.items():
                size, rate = checkpoint_rate(program, options.discs, shape, folder)
                plain = dd_rate(size, folder)
                found.append((rate, plain, rate / plain))
                print(
                    f"round {turn}  {shape}  {size / 1e6:.0f} MB  {rate / 1e6:.0f} MB/s, dd"
                    f" {plain / 1e6:.0f} MB/s, ratio {rate / plain:.2f}",
                    file=sys.stderr,
                )
    with open(options.output, "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(COLUMNS)
        for shape, found in rates.items():
            rate, plain, ratios = zip(*found)
            megabytes = (f"{statistics.median(rates) / 1e6:.0f}" for rates in (rate, plain))
            numbers = (statistics.median(ratios), min(ratios), max(ratios))
            table.writerow([options.discs, shape.replace("x", " x "), *megabytes,
                            *(f"{number:.2f}" for number in numbers)])


if __name__ == "__main__":
    main()
