#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hold gases and billiards in boxes that are no rectangles to what is known: prints a study as CSV.

  tests/physics/shapes.py CARROM STUDY [--short]

wall       the pressure on the wall of a round box over density and kT in its middle, against the
           compressibility factor of that density
stadium    points in Bunimovich's stadium, from a small square: chi^2 over degrees of freedom of
           their numbers in 27 parts, against 1 of even places

Discs have the diameter 1 and the mass 1. Exit codes and errors are those of
tests/physics/literature.py: a number is held to four joint standard errors.
"""
import csv
import math
import os
import subprocess
import tempfile

import literature


def run(program, settings, names=()):
    """What a scene with these keys prints, and tables of it."""
    with tempfile.TemporaryDirectory() as folder:
        scene = os.path.join(folder, "scene.toml")
        with open(scene, "w", encoding="utf-8") as file:
            file.writelines(f"{key} = {value}\n" for key, value in settings.items())
        ended = subprocess.run([program, "run", scene, "--threads", "1", "-o",
                                os.path.join(folder, "run")], check=True, capture_output=True,
                               text=True)
        tables = []
        for name in names:
            path = os.path.join(folder, "run", "measurements", f"{name}.csv")
            with open(path, encoding="utf-8") as file:
                rows = csv.DictReader(line for line in file if not line.startswith("#"))
                tables.append([{key: float(value) for key, value in row.items()} for row in rows])
        return ended.stdout, tables


def wall(program, is_short):
    """A disc's centre presses a circle of the radius R - r, so the force is over that circle.

    A bent wall presses by a surface tension over the radius more than a flat one. What is known is
    given an error of a tenth of a diameter over the radius for that.
    """
    kt, count, cells, samples = 0.01, 800 if is_short else 3000, 24, 100
    blocks = 8 if is_short else 40
    for packing in (0.3,) if is_short else (0.1, 0.2, 0.3):
        radius = math.sqrt(count / (4 * packing))
        _, (forces, fields) = run(program, {
            "box.size": 2 * radius, "box.shape": '"round"', "discs.count": count,
            "discs.radius": 0.5, "discs.temperature": kt, "time.steps": 1000 + 2000 * blocks,
            "output.measurements.quantities": '["obstacle_forces", "profiles"]',
            "output.measurements.every_steps": 20, "output.measurements.from_step": 1000,
            "output.measurements.profile_columns": cells, "output.measurements.profile_rows": cells,
            "output.measurements.profile_samples": samples},
            ("obstacle_forces_history", "profiles"))
        densities, pressures = [], []
        for k in range(blocks):
            block = fields[k * cells**2:(k + 1) * cells**2]
            middle = [row["density"] for row in block
                      if math.hypot(row["x"] - radius, row["y"] - radius) < 0.6 * radius]
            densities.append(sum(middle) / len(middle))
            push = [row["push"] for row in forces[k * samples:(k + 1) * samples]]
            pressures.append(sum(push) / len(push) / (2 * math.pi * (radius - 0.5)))
        density, spread = literature.mean(densities)
        pressure, error = literature.mean(pressures)
        found, covered = pressure / (density * kt), density * math.pi / 4
        flat, below = (literature.factor(n * math.pi / 4) for n in (density, density - spread))
        bent = flat * covered / (2 * (radius - 0.5))
        yield {"packing": packing, "packing_in_middle": covered, "Z": found,
               "Z_error": found * math.hypot(error / pressure, spread / density),
               "Z_known": flat + bent, "Z_known_error": math.hypot(flat - below, 0.1 * bent)}


def part_of(x, y):
    """One of 25 squares in the middle, or one of two half circles."""
    if not 25 <= x < 75:
        return 25 if x < 25 else 26
    return 5 * int((x - 25) / 10) + min(4, int(y / 10))


def stadium(program, is_short):
    """Points that fly to and fro between the straight walls stay there long: evenness is late."""
    count, seeds = (1000, 6) if is_short else (2_000, 16)
    areas = [100] * 25 + [math.pi * 25**2 / 2] * 2
    for steps in (1000,):
        values = []
        for seed in range(1, seeds + 1):
            printed, _ = run(program, {
                "box.size": [100, 50], "box.shape": '"stadium"', "discs.count": count,
                "discs.radius": 0, "discs.speed": 1, "discs.region": [30, 20, 31, 21],
                "discs.seed": seed, "time.steps": steps, "output.text": '"ends"',
                "effects.contact.kind": '"none"'})
            numbers = [0] * 27
            for line in printed.splitlines():
                words = line.split()
                if words[:1] == [str(steps)] and len(words) >= 6:
                    numbers[part_of(float(words[2]), float(words[3]))] += 1
            even = [sum(numbers) * area / sum(areas) for area in areas]
            values.append(sum((n - e) ** 2 / e for n, e in zip(numbers, even)) / 26)
        value, error = literature.mean(values)
        yield {"points": count, "steps": steps, "chi2": value, "chi2_error": error, "chi2_known": 1,
               "chi2_known_error": math.sqrt(2 / 26 / seeds)}


# For each study: the function that makes the rows, and the largest relative errors that are allowed
# in a short and in the whole study.
STUDIES = {"wall": (wall, 0.05, 0.01), "stadium": (stadium, 0.5, 0.2)}

if __name__ == "__main__":
    literature.main(__doc__, STUDIES)
