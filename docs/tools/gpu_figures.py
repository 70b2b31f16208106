#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures a gas on CPUs and on a GPU, and draws time against N.

    gpu_figures.py measure PROGRAM TABLE.csv [--largest N] [--threads T] [--seconds S]
    gpu_figures.py plot TABLE.csv FOLDER

`measure` runs each kind of arithmetic for each N by PROGRAM, which was built with -DCARROM_CUDA=ON,
with and without --gpu, and checks that both give one state hash. `plot` draws a figure of each
precision: microseconds of a micro-step against N, with and without contraction.

The gas has packing 0.2, and its discs fly up to half a radius in a micro-step, as in the table of
docs/understanding/gpu.md. Each run is timed without its start. Runs are as long as they must be to take
some seconds.
"""

import argparse
import csv
import json
import math
import pathlib
import subprocess
import sys
import tempfile

SIZES = (1000, 2000, 4000, 8000, 16000, 32000, 64000, 100000, 1000000, 10000000)
PACKING = 0.2
RADIUS = 1.0
SPEED = 0.25  # root mean square, in radii per micro-step; the fastest of many are twice as fast
ARITHMETIC = (
    ("double", "stable", False),
    ("double", "naive", False),
    ("double", "naive", True),
    ("single", "naive", False),
    ("single", "naive", True),
)
COLUMNS = ("device", "precision", "arithmetic", "contraction", "n", "microseconds", "steps", "hash")


def scene(n, steps, precision, arithmetic, contraction):
    """Return the text of a scene whose step is one micro-step."""
    size = math.sqrt(n * math.pi * RADIUS**2 / PACKING)
    lines = [
        f"box.size = {size!r}",
        f"discs = {{ count = {n}, radius = {RADIUS}, speed = {SPEED}, velocities = 'uniform' }}",
        f"time.steps = {steps}",
        "time.method = 'time-stepped'",
        f"time.precision = '{precision}'",
        f"time.arithmetic = '{arithmetic}'",
    ]
    if contraction:
        lines.append("time.contraction = true")
    return "\n".join(lines) + "\n"


def run(program, text, words):
    """Return the report of a run."""
    with tempfile.TemporaryDirectory() as place:
        path, report = pathlib.Path(place, "gas.toml"), pathlib.Path(place, "report.json")
        path.write_text(text, encoding="utf-8")
        words = [program, "run", str(path), "--quiet", "--report", str(report), *words]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"{' '.join(words)}: code {done.returncode}\n{done.stderr}")
        return json.loads(report.read_text(encoding="utf-8"))


def measure(options):
    """Write a row for each run."""
    devices = {"CPU": ["--threads", str(options.threads)], "GPU": ["--gpu"]}
    with open(options.table, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(COLUMNS)
        for n in (n for n in SIZES if n <= options.largest):
            for arithmetic in ARITHMETIC:
                hashes = set()
                for device, words in devices.items():
                    short = run(options.program, scene(n, 64, *arithmetic), words)
                    hashes.add(short["state_hash"])
                    each = short["wall_seconds"] / 64
                    steps = 64 * max(2, min(1000, int(options.seconds / each / 64)))
                    report = run(options.program, scene(n, steps, *arithmetic), words)
                    row = [1e6 * report["wall_seconds"] / steps, steps, report["state_hash"]]
                    table.writerow([device, *arithmetic, n, *row])
                    file.flush()
                if len(hashes) > 1:
                    sys.exit(f"{n} discs, {arithmetic}: CPU and GPU give other bits")


def plot(options):
    """Draw a figure of each precision."""
    import matplotlib.pyplot as plt
    import plot_style

    plot_style.use()
    with open(options.table, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for precision in ("double", "single"):
        figure, axes = plt.subplots()
        for device in ("CPU", "GPU"):
            for _, arithmetic, contraction in (one for one in ARITHMETIC if one[0] == precision):
                points = [
                    (int(row["n"]), float(row["microseconds"]))
                    for row in rows
                    if row["device"] == device
                    and row["precision"] == precision
                    and row["arithmetic"] == arithmetic
                    and row["contraction"] == str(contraction)
                ]
                label = f"{device}, {arithmetic}{', contracted' if contraction else ''}"
                axes.loglog(*zip(*points), "o-" if device == "GPU" else "s--", label=label)
        axes.set_xlabel("number of discs N")
        axes.set_ylabel("microseconds of a micro-step")
        axes.set_title(f"{precision} precision")
        axes.legend()
        figure.savefig(pathlib.Path(options.folder) / f"gpu_{precision}.png")


def main():
    """Read the command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    commands = parser.add_subparsers(required=True)
    measuring = commands.add_parser("measure")
    measuring.add_argument("program")
    measuring.add_argument("table")
    measuring.add_argument("--largest", type=float, default=1e7, help="largest N")
    measuring.add_argument("--threads", type=int, default=1, help="of runs without a GPU")
    measuring.add_argument("--seconds", type=float, default=2, help="of each run")
    measuring.set_defaults(act=measure)
    plotting = commands.add_parser("plot")
    plotting.add_argument("table")
    plotting.add_argument("folder")
    plotting.set_defaults(act=plot)
    options = parser.parse_args()
    options.act(options)


if __name__ == "__main__":
    main()
