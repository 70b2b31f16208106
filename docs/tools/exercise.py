#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The exercises of docs/classroom.md: `python3 docs/tools/exercise.py 1` (to 5).

Each one prints the commands that it runs, then a table. `--short` takes seconds, `--check` ends
with code 1 if the result is not the expected one. CARROM names the program, MPIRUN the launcher.
Only Python's own library is used.
"""

import argparse
import csv
import json
import math
import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
SCENES = TOP / "inputs" / "classroom"
RADIUS = math.sqrt(0.3 * 100**2 / 1000 / math.pi)  # of gas.toml


def program():
    named = os.environ.get("CARROM") or shutil.which("carrom") or TOP / "build" / "carrom"
    if not shutil.which(named):
        sys.exit("no program carrom: build it, or set CARROM to its path")
    return str(named)


def launcher():
    return os.environ.get("MPIRUN") or shutil.which("mpiexec") or "mpirun"


def carrom(*words, ranks=1):
    """Run the program and return what it prints."""
    command = [*([launcher(), "-n", str(ranks)] if ranks > 1 else []), program(), *map(str, words)]
    shown = [
        os.path.relpath(word) if word.startswith("/") and os.path.exists(word) else word
        for word in command
    ]
    print("+", shlex.join(shown), flush=True)
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        sys.exit(f"this command ended with code {done.returncode}; its message is above")
    return done.stdout


def set_up_mpi():
    """Three ranks run on two cores, too: ask the MPI library for what the tests ask it for.

    A variable that the user has set is kept.
    """
    for line in (TOP / "job_scripts" / "mpi_settings.txt").read_text().splitlines():
        if line and not line.startswith("#"):
            name, _, value = line.split(None, 1)[1].partition("=")
            os.environ.setdefault(name, value)


def report(*words, ranks=1):
    carrom("run", *words, "--quiet", "--report", "report.json", ranks=ranks)
    return json.loads(Path("report.json").read_text(encoding="ascii"))


def lines(text):
    """The lines of discs by step: {step: [(x, y, vx, vy), ...]}."""
    steps = {}
    for line in text.splitlines():
        words = line.split()
        steps.setdefault(int(words[0]), []).append(tuple(map(float, words[2:6])))
    return steps


def lost_collisions(_):
    """1: the share of collisions that the time-stepped method loses, against the step."""
    gas, steps = SCENES / "gas.toml", ("--steps", 400)
    exact = report(gas, *steps, "--set", "time.method=event-driven")["averages"][
        "collision_frequency"
    ]["value"]
    print(f"event-driven: {exact:.4f} collisions per disc and step")
    lost = {}
    for k in (1, 2, 4, 8, 16, 32):
        found = report(gas, *steps, "--set", f"time.micro_steps={k}")["averages"][
            "collision_frequency"
        ]["value"]
        lost[k] = 1 - found / exact
        print(
            f"K = {k:2}: {exact / k:.4f} collisions per disc and micro-step, "
            f"{100 * lost[k]:5.1f} % lost"
        )
    is_halved = all(0.4 * lost[k] < lost[2 * k] < 0.9 * lost[k] for k in (1, 2, 4, 8))
    return is_halved and 0.2 < lost[1] < 0.45 and lost[16] < 0.07


def slow_factor(_):
    """2: SLOW_FACTOR divides velocities and multiplies steps: it is `time.micro_steps`."""
    slow = lines(carrom("run", SCENES / "slow.in", "--quiet"))[32]
    parts = lines(carrom("run", SCENES / "fast.in", "--quiet", "--set", "time.micro_steps=4"))[8]
    whole = lines(carrom("run", SCENES / "fast.in", "--quiet"))[8]

    def same(a, b):
        return sum(p[:2] == q[:2] for p, q in zip(a, b, strict=True))

    print(
        f"velocities / 4 and 32 steps: {same(slow, parts)} of 60 discs "
        "are where K = 4 has them after 8 steps"
    )
    print(f"                             {same(slow, whole)} of 60 discs are where K = 1 has them")
    return same(slow, parts) == 60 and same(slow, whole) < 20


def float_and_double(is_short):
    """3: how fast roundings grow: runs that differ in precision, or in syncs, only."""
    words = (
        SCENES / "gas.toml",
        "--quiet",
        "--steps",
        40 if is_short else 120,
        "--set",
        "output.text=every_step",
        "--set",
        "time.method=event-driven",
        "--set",
        "discs.speed=1.4",
    )
    double = lines(carrom("run", *words))
    single = lines(carrom("run", *words, "--set", "time.precision=single"))
    other = lines(carrom("run", *words, "--set", "time.micro_steps=16"))

    def distances(run):
        return [
            math.sqrt(
                sum(
                    (p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2
                    for p, q in zip(run[s], double[s], strict=True)
                )
                / 1000
            )
            / (2 * RADIUS)
            for s in sorted(double)
        ]

    apart = {"float and double": distances(single), "double, other syncs": distances(other)}
    reached = {}
    for name, distance in apart.items():
        reached[name] = next((s for s, d in enumerate(distance) if d > 0.1), None)
        shown = ", ".join(f"{distance[s]:.0e}" for s in range(0, len(distance), 5)[:9])
        print(
            f"{name}: {shown} diameters after 0, 5, 10, ... steps; "
            f"above 0.1 from step {reached[name]}"
        )
    first, second = reached.values()
    return first is not None and first < 20 and second is not None and 1.5 * first < second < 40


def strips_and_halo(is_short):
    """4: what strips would lose without a halo; with one the bits do not depend on them."""
    steps = 100 if is_short else 400
    words = (SCENES / "gas.toml", "--steps", steps, "--set", "time.method=event-driven")
    hashes = {ranks: report(*words, ranks=ranks)["state_hash"] for ranks in (1, 2, 3)}
    for ranks, state in hashes.items():
        print(f"{ranks} ranks: state hash {state}")
    shutil.rmtree("halo", ignore_errors=True)
    carrom(
        "run",
        *words,
        "-o",
        "halo",
        "--quiet",
        "--set",
        "output.collisions=true",
        "--set",
        "output.trajectory.every_steps=1",
    )
    frames = lines(carrom("convert", "halo/trajectory.h5", "--to", "text"))
    pairs = [
        row
        for row in csv.DictReader(
            carrom("convert", "halo/collisions.h5", "--to", "csv").splitlines()
        )
        if int(row["q"]) >= 0
    ]
    is_good = len(set(hashes.values())) == 1
    for strips in (2, 4, 8):
        cut = sum(is_cut(frames, row, strips) for row in pairs)
        expected = (strips - 1) * 4 * RADIUS / math.pi / 100
        print(
            f"{strips} strips: {100 * cut / len(pairs):.2f} % of {len(pairs)} pairs are in two; "
            f"2 (strips - 1) sigma / (pi L) = {100 * expected:.2f} %"
        )
        is_good &= abs(cut / len(pairs) / expected - 1) < (0.3 if is_short else 0.15)
    return is_good


def is_cut(frames, row, strips):
    """Whether a pair touched across a cut. Discs are moved on from the frame before."""
    step, time = int(row["step"]) - 1, float(row["time"])
    places = []
    for name in ("p", "q"):
        x, _, vx, _ = frames[step][int(row[name])]
        places.append(x + vx * (time - step))
    return int(places[0] * strips / 100) != int(places[1] * strips / 100)


def conflicts_across_a_boundary(_):
    """5: a chain of conflicts decides at its right end what happened at its left end."""
    kept = {}
    for name in ("chain", "chain_cut"):
        for ranks in (1, 3):
            shutil.rmtree("chain", ignore_errors=True)
            carrom(
                "run",
                SCENES / f"{name}.in",
                "-o",
                "chain",
                "--set",
                "output.collisions=true",
                "--quiet",
                "--output",
                "lines",
                ranks=ranks,
            )
            rows = csv.DictReader(
                carrom("convert", "chain/collisions.h5", "--to", "csv").splitlines()
            )
            kept[name, ranks] = [(int(row["p"]), int(row["q"])) for row in rows]
        print(f"{name}: on 1 and on 3 ranks these collide: {kept[name, 1]}")
    return kept["chain", 1] == kept["chain", 3] == [(i, i + 1) for i in range(0, 12, 2)] and kept[
        "chain_cut", 1
    ] == kept["chain_cut", 3] == [(i, i + 1) for i in range(1, 11, 2)]


EXERCISES = (
    lost_collisions,
    slow_factor,
    float_and_double,
    strips_and_halo,
    conflicts_across_a_boundary,
)


def main():
    parser = argparse.ArgumentParser(description="Run an exercise of docs/classroom.md.")
    parser.add_argument("number", type=int, choices=range(1, 6))
    parser.add_argument("--short", action="store_true", help="seconds instead of up to a minute")
    parser.add_argument("--check", action="store_true", help="code 1 if the result is another one")
    wanted = parser.parse_args()
    exercise = EXERCISES[wanted.number - 1]
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    set_up_mpi()
    print(exercise.__doc__)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        is_expected = exercise(wanted.short)
        os.chdir(TOP)
    print("as expected" if is_expected else "NOT as expected; see docs/classroom.md")
    return 1 if wanted.check and not is_expected else 0


if __name__ == "__main__":
    sys.exit(main())
