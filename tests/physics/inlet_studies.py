#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hold inlets to theory: prints a study as CSV.

  tests/physics/inlet_studies.py CARROM STUDY [--short]

activity  hard discs before a wall, in equilibrium with an ideal gas that an inlet lets in: their
          packing far from all sides, by the density z of that gas. Theory: z / n = exp(mu), with
          the excess chemical potential mu of scaled particles, -log(1 - eta) + (3 eta - 2 eta^2) /
          (1 - eta)^2 (Helfand, Frisch and Lebowitz, J. Chem. Phys. 34, 1037 (1961)). Its own error
          is given as a tenth of eta^2.

Discs have the diameter 1 and the mass 1. Exit codes and errors are those of
tests/physics/literature.py.
"""
import csv
import io
import math
import os
import statistics
import subprocess
import tempfile

import literature

WIDTH, HEIGHT, FAR = 44, 34, 7  # places closer than this to a side are left out
KT = 0.04
SCENE = """
[box]
size = [{width}, {height}]
left = {{ kind = "open", inlet = {{ rate = {rate}, temperature = {kt} }} }}
[discs]
count = {count}
radius = 0.5
speed = 0.3
seed = {seed}
[time]
steps = {steps}
[effects.inlets]
seed = {seed}
[output.trajectory]
every_steps = 50
fields = ["position"]
precision = "double"
"""


def excess(eta):
    return -math.log(1 - eta) + (3 * eta - 2 * eta ** 2) / (1 - eta) ** 2


def activity_of(eta):
    return 4 * eta / math.pi * math.exp(excess(eta))


def packing_of_run(program, activity, eta, steps, seed):
    """The mean far from all sides, over the last four fifths of a run."""
    rate = activity * math.sqrt(KT / (2 * math.pi)) * (HEIGHT - 1)
    count = round(1.3 * eta * 4 / math.pi * WIDTH * HEIGHT)
    with tempfile.TemporaryDirectory() as folder:
        scene = os.path.join(folder, "scene.toml")
        with open(scene, "w", encoding="utf-8") as file:
            file.write(SCENE.format(width=WIDTH, height=HEIGHT, rate=rate, kt=KT, count=count,
                                    seed=seed, steps=steps))
        out = os.path.join(folder, "run")
        subprocess.run([program, "run", scene, "--quiet", "--threads", "1", "-o", out], check=True)
        text = subprocess.run([program, "convert", os.path.join(out, "trajectory.h5"), "--to",
                               "csv"], check=True, stdout=subprocess.PIPE, text=True).stdout
    numbers = {}
    for row in csv.DictReader(io.StringIO(text)):
        step, x, y = int(row["step"]), float(row["x"]), float(row["y"])
        if 5 * step >= steps:
            numbers.setdefault(step, 0)
            numbers[step] += FAR < x < WIDTH - FAR and FAR < y < HEIGHT - FAR
    area = (WIDTH - 2 * FAR) * (HEIGHT - 2 * FAR)
    return statistics.fmean(numbers.values()) * math.pi / 4 / area


def activity(program, is_short):
    for eta in (0.1, 0.2, 0.3, 0.4)[:1 if is_short else None]:
        found = [packing_of_run(program, activity_of(eta), eta, 6000 if is_short else 20000, seed)
                 for seed in range(4 if is_short else 8)]
        yield {"activity": activity_of(eta), "packing": statistics.fmean(found),
               "packing_error": statistics.stdev(found) / math.sqrt(len(found)),
               "packing_known": eta, "packing_known_error": 0.1 * eta ** 2}


if __name__ == "__main__":
    literature.main(__doc__, {"activity": (activity, 0.05, 0.02)})
