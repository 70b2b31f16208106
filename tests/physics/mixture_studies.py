#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hold mixtures to kinetic theory: prints a study as CSV.

  tests/physics/mixture_studies.py CARROM STUDY [--short]

materials  the ratio of the temperatures of two species that differ in restitution alone, while they
           cool together, against theory: both cool at one rate then. Theory takes Maxwell's
           velocities (Garzo and Dufty, Phys. Rev. E 60, 5706 (1999)), which are nearly right for
           discs that lose little. Its own error is given as a tenth of 1 - e of the species that
           loses most.

Discs have the diameter 1 and the mass 1. Exit codes and errors are those of
tests/physics/literature.py.
"""
import math
import os
import statistics
import subprocess
import tempfile

import literature

SCENE = """
[box]
size = {size}
{sides}
[discs]
speed = 0.5
seed = {seed}
species = [{{count = {count}, radius = 0.5}}, {{count = {count}, radius = 0.5}}]
[time]
steps = {steps}
[effects.contact]
kind = "restitution"
restitution = {mixed}
pairs = [{{species = [1, 1], restitution = {first}}}, {{species = [2, 2], restitution = {second}}}]
[output]
text = "every_step"
"""
SIDES = "\n".join(f'{side}.kind = "periodic"' for side in ("left", "right", "bottom", "top"))
PACKING = 0.05


def cooling(own, other, restitution):
    """The rate at which discs of kT `own` lose energy in collisions with as many of kT `other`,
    both of Maxwell's velocities, in units that drop out.
    """
    share = (1 + restitution) * own - (1 + restitution) ** 2 / 4 * (own + other)
    return math.sqrt(own + other) * share


def ratio_of_theory(first, mixed, second):
    """kT of the second species over that of the first one."""
    low, high = 0, 1
    for _ in range(60):
        middle = (low + high) / 2
        fast = (cooling(middle, middle, second) + cooling(middle, 1, mixed)) / middle
        if fast > cooling(1, 1, first) + cooling(1, middle, mixed):
            high = middle
        else:
            low = middle
    return low


def ratio_of_run(program, count, steps, numbers):
    """The mean ratio of kT over the second half of a run."""
    energies = {}
    size = math.sqrt(2 * count * math.pi / (4 * PACKING))
    with tempfile.TemporaryDirectory() as folder:
        scene = os.path.join(folder, "scene.toml")
        with open(scene, "w", encoding="utf-8") as file:
            file.write(SCENE.format(size=size, sides=SIDES, count=count, steps=steps, **numbers))
        with subprocess.Popen([program, "run", scene, "--quiet", "--threads", "1", "-o",
                               os.path.join(folder, "run")], stdout=subprocess.PIPE,
                              text=True) as running:
            for line in running.stdout:
                words = line.split()
                if words[0].isdigit() and 2 * int(words[0]) >= steps and int(words[0]) % 10 == 0:
                    both = energies.setdefault(int(words[0]), [0, 0])
                    both[int(words[1]) >= count] += float(words[4]) ** 2 + float(words[5]) ** 2
        if running.returncode != 0:
            raise subprocess.CalledProcessError(running.returncode, program)
    return statistics.fmean(second / first for first, second in energies.values())


def materials(program, is_short):
    for first, mixed, second, steps in ((0.99, 0.95, 0.9, 400), (0.95, 0.9, 0.7, 300),
                                        (0.95, 0.9, 0.5, 240))[:1 if is_short else None]:
        ratios = [ratio_of_run(program, 500 if is_short else 4000, steps,
                               {"first": first, "mixed": mixed, "second": second, "seed": seed})
                  for seed in range(4 if is_short else 8)]
        known = ratio_of_theory(first, mixed, second)
        yield {"restitution_1": first, "restitution_12": mixed, "restitution_2": second,
               "discs": 1000 if is_short else 8000, "ratio": statistics.fmean(ratios),
               "ratio_error": statistics.stdev(ratios) / math.sqrt(len(ratios)),
               "ratio_known": known, "ratio_known_error": 0.1 * (1 - second) * known}


if __name__ == "__main__":
    literature.main(__doc__, {"materials": (materials, 0.05, 0.01)})
