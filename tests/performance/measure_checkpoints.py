#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measure how fast checkpoints are written, beside what `dd conv=fdatasync` of the same size
reaches on the same disk.

  tests/performance/measure_checkpoints.py --program build/carrom --folder /scratch/me --discs
  10000000 --shapes 1x1 2x1

In each round dd and the program take turns, so that a disk that others use too treats both alike;
the ratio of a round is what counts, and the median of the rounds is told. A shape is ranks x
threads. Each run stores two checkpoints and keeps one; the time is the phase `output`, which is all
that the step loop waits for. Needs Python, dd and mpirun, and twice a checkpoint's room.
"""

import argparse
import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

from measure import MPI_SETTINGS

CHECKPOINTS = 2


def checkpoint_rate(program, n_discs, shape, folder):
    """Bytes of a checkpoint, and bytes per second."""
    report, kept = os.path.join(folder, "report.json"), os.path.join(folder, "kept")
    scene = os.path.join(folder, "scene.toml")
    with open(scene, "w") as file:
        file.write(
            f"[box]\nsize = {(n_discs * 10.0) ** 0.5!r}\n[discs]\ncount = {n_discs}\nradius ="
            f" 0.5\ngenerator = \"lattice\"\nspeed = 0.01\n[time]\nsteps = {CHECKPOINTS}\nmethod ="
            f" \"time-stepped\"\n[output.checkpoint]\nfolder = \"{kept}\"\nevery_steps = 1\nkeep"
            " = 1\n"
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
        env=os.environ | MPI_SETTINGS,
    )
    size = os.path.getsize(os.path.join(kept, os.listdir(kept)[0]))
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
    print(
        "| discs | ranks x threads | checkpoint, MB/s | dd, MB/s | ratio: median | least | most"
        " |\n|---|---|---|---|---|---|---|"
    )
    for shape, found in rates.items():
        rate, plain, ratios = zip(*found)
        print(
            f"| {options.discs:.0e} | {shape} | {statistics.median(rate) / 1e6:.0f} |"
            f" {statistics.median(plain) / 1e6:.0f} | {statistics.median(ratios):.2f} |"
            f" {min(ratios):.2f} | {max(ratios):.2f} |"
        )


if __name__ == "__main__":
    main()
