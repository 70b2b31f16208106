#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hold the flow out of a silo to Beverloo's law in a plane, W = C (D - k d)^1.5.

  tests/physics/silo.py CARROM

Rough discs of two sizes, with the mean diameter d, fill a silo with a flat floor and leave it
through an opening of the width D in its middle. Their contacts last from sync to sync. Prints CSV:
for each opening the discs that leave in a step, as mean and standard error over the seeds, and what
the fitted law gives. W^(2/3) is a straight line in D, whose slope is C^(2/3) and whose zero is k d.
The last line has k and C in units of d and sqrt(g / d), and the exponent that fits best for
k = 1.5, with standard errors from leaving out one seed at a time.

The code is 1 where k is more than three standard errors outside 1 to 2 (Beverloo, Leniger and van
de Velde, Chem. Eng. Sci. 15, 260 (1961)), the exponent as many from 1.5, a flow from the law, or
where these errors exceed 0.4, 0.1 and 5 %. Openings of four diameters clog.

The flow is that from the step at which a fifth of the discs have left to that at which a half have.
"""
import argparse
import json
import math
import os
import random
import statistics
import subprocess
import sys
import tempfile

from rough_heaps import G, RADII, discs_and_time, effects, surface, write_discs

FRICTION = 0.5
DIAMETER = 2
WIDTH, HEIGHT, FLOOR = 80, 150, 6
COLUMNS, ROWS = 35, 60
OPENINGS, SEEDS = (8, 10, 12, 14), range(1, 4)  # openings in diameters
FIRST, LAST = 0.2, 0.5  # shares that have left
STRETCH, MOST_STEPS = 40, 4000


def scene_of(count, opening):
    rubs = surface(FRICTION)
    left, right = ((WIDTH + side * opening * DIAMETER) / 2 for side in (-1, 1))
    return f"""[box]
size = [{WIDTH}, {HEIGHT}]
bottom.kind = "open"
[box.left]
{rubs}
[box.right]
{rubs}
{discs_and_time(count, MOST_STEPS, sync_every=2)}
{effects(FRICTION, speed=0.05)}
[effects.obstacles]
{rubs}
segments = [[0, {FLOOR}, {left}, {FLOOR}], [{right}, {FLOOR}, {WIDTH}, {FLOOR}]]
"""


def start_of(seed):
    """A shaken lattice, with as many small discs as large ones."""
    draw = random.Random(seed)
    places = [(1.3 + 2.25 * (column + row % 2 / 2) + draw.uniform(-0.02, 0.02),
               FLOOR + 1.2 + 2.24 * row + draw.uniform(-0.02, 0.02))
              for row in range(ROWS) for column in range(COLUMNS - row % 2)]
    draw.shuffle(places)
    return [(x, y, RADII[2 * k // len(places)]) for k, (x, y) in enumerate(places)]


def flow(program, opening, seed):
    """Discs that leave in a step."""
    with tempfile.TemporaryDirectory() as folder:
        discs = start_of(seed)
        count = len(discs)
        write_discs(os.path.join(folder, "discs.txt"), discs)
        scene, run = os.path.join(folder, "scene.toml"), os.path.join(folder, "run")
        with open(scene, "w", encoding="utf-8") as file:
            file.write(scene_of(count, opening))
        times, left = [0], [0]
        command = [program, "run", scene, "-o", run]
        while left[-1] < LAST * count:
            if times[-1] >= MOST_STEPS:
                raise SystemExit(f"an opening of {opening} diameters has clogged (seed {seed})")
            times.append(times[-1] + STRETCH)
            subprocess.run([*command, "--steps", str(times[-1]), "--quiet", "--threads", "1"],
                           check=True)
            command = [program, "run", "-o", run, "--resume"]
            with open(os.path.join(run, "report.json"), encoding="utf-8") as file:
                left.append(sum(json.load(file)["departed"]))
        first, last = (time_of(share * count, times, left) for share in (FIRST, LAST))
        return (LAST - FIRST) * count / (last - first)


def time_of(number, times, left):
    """When so many discs had left, between the two nearest counts."""
    k = next(k for k, n in enumerate(left) if n >= number)
    share = (number - left[k - 1]) / (left[k] - left[k - 1])
    return times[k - 1] + share * (times[k] - times[k - 1])


def line(xs, ys):
    """Slope and zero of the straight line of least squares."""
    mean_x, mean_y = statistics.fmean(xs), statistics.fmean(ys)
    slope = (sum((x - mean_x) * (y - mean_y) for x, y in zip(xs, ys)) /
             sum((x - mean_x) ** 2 for x in xs))
    return slope, mean_x - mean_y / slope


def law(flows):
    """k, C in units of sqrt(g / d), and the exponent for k = 1.5."""
    means = {opening: statistics.fmean(values) for opening, values in flows.items()}
    slope, k = line(list(means), [w ** (2 / 3) for w in means.values()])
    exponent, _ = line([math.log(opening - 1.5) for opening in means],
                       [math.log(w) for w in means.values()])
    return k, slope ** 1.5 / math.sqrt(G / DIAMETER), exponent


def errors_of_law(flows):
    """Standard errors, from leaving out one seed at a time."""
    without = [law({opening: values[:k] + values[k + 1:] for opening, values in flows.items()})
               for k in range(len(SEEDS))]
    return [math.sqrt((len(SEEDS) - 1) * statistics.pvariance(values)) for values in zip(*without)]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", metavar="CARROM")
    options = parser.parse_args()
    flows = {opening: [flow(options.program, opening, seed) for seed in SEEDS]
             for opening in OPENINGS}
    k, prefactor, exponent = law(flows)
    errors = errors_of_law(flows)
    is_right = (max(1 - k, k - 2) <= 3 * errors[0] <= 1.2 and
                abs(exponent - 1.5) <= 3 * errors[2] <= 0.3)
    print("opening,flow,flow_error,law")
    for opening, values in flows.items():
        mean = statistics.fmean(values)
        error = statistics.stdev(values) / math.sqrt(len(values))
        expected = prefactor * math.sqrt(G / DIAMETER) * (opening - k) ** 1.5
        is_right = is_right and abs(mean - expected) <= 3 * error <= 0.15 * mean
        print(f"{opening},{mean:.4f},{error:.4f},{expected:.4f}")
    print("k {:.2f} +- {:.2f}, C {:.3f} +- {:.3f}, exponent {:.3f} +- {:.3f}".format(
        *(number for pair in zip((k, prefactor, exponent), errors) for number in pair)),
        file=sys.stderr)
    return 0 if is_right else 1


if __name__ == "__main__":
    sys.exit(main())
