#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hold claimed errors to the scatter between runs that differ by their seed alone.

  tests/physics/scatter.py CARROM [--short]

Prints CSV: for each packing and average the mean, the scatter between seeds, the claimed error
(the root of the mean of its squares) and scatter over claim. The exit code is 1 where that is
outside 0.75 to 1.3, widened in the short study by what 16 seeds can tell, or where more than a
third of the seeds have no error.

The scatter of n runs is itself uncertain by 1 / sqrt(2 (n - 1)): 13 % for 32 seeds. The claim for
independent blocks is 5 % too large on average. So one of 20 right errors would be below 0.75 with
32 seeds. With the study's 128 seeds that is one of some 3000. `--seeds 32` is for packing 0.7,
where a seed takes 45 core-seconds.

Runs end before an average is known that well only if they are much longer than the memory of the
discs. So steps grow with the packing.
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

# Packing: discs, steps before averages begin, averaged steps, each of about a collision per disc,
# and steps from sample to sample.
LONG = {0.3: (400, 400, 8000, 4), 0.5: (400, 400, 8000, 4), 0.62: (400, 4000, 16000, 4),
        0.65: (400, 4000, 16000, 4), 0.69: (400, 20000, 200000, 100), 0.7: (400, 20000, 200000, 20)}
SHORT = {0.5: (100, 100, 2000, 4)}

SCENE = """[box]
size = {size!r}
left = {{ kind = "periodic" }}
right = {{ kind = "periodic" }}
bottom = {{ kind = "periodic" }}
top = {{ kind = "periodic" }}
[discs]
count = {discs}
radius = 1
generator = "file"
file = "discs.txt"
[time]
method = "event-driven"
steps = {steps}
[output]
averages_from_step = {early}
[output.measurements]
quantities = ["psi6", "diffusion", "radial_distribution", "structure_factor"]
from_step = {early}
every_steps = {every}
correlation_steps = {window}
bins = 24
largest_distance = 6
largest_wavenumber = 3
"""


def average(*path):
    """A function that takes value and error of an average from a report."""
    def of(report):
        for name in path:
            report = report[name]
        return report["value"], report["error"]
    return of


def measured(table, name, row=0):
    """The same of a row of a table."""
    def of(report):
        columns = report["measurements"][table]
        return columns[name][row], columns[f"{name}_error"][row]
    return of


QUANTITIES = {
    "Z": average("compressibility"),
    "P_xy": average("pressure_tensor", "xy"),
    "collision rate": average("averages", "collision_frequency"),
    "mean speed": average("averages", "mean_speed"),
    "kurtosis": average("averages", "speed_kurtosis"),
    "psi6": measured("psi6", "psi6"),
    "D": measured("diffusion", "D"),
    # g at contact, between the first two shells and in the second one; S of long and short waves;
    # velocities a sample later, and squares of displacements after five samples.
    "g(2.0)": measured("radial_distribution", "g", 8),
    "g(3.0)": measured("radial_distribution", "g", 12),
    "g(4.0)": measured("radial_distribution", "g", 16),
    "S(0.3)": measured("structure_factor", "S", 2),
    "S(1.3)": measured("structure_factor", "S", 10),
    "VACF": measured("velocity_autocorrelation", "velocities", 1),
    "MSD": measured("velocity_autocorrelation", "squares", 5),
}


def speed_of(packing):
    """One collision of each disc in a step, by Henderson's Z (Mol. Phys. 30, 971 (1975))."""
    factor = (1 + packing ** 2 / 8) / (1 - packing) ** 2
    return 2 * math.sqrt(math.pi / 8) / (factor - 1)


def discs_text(discs, size, speed, seed):
    """A square lattice with Gaussian velocities of exactly this root mean square, and no drift."""
    numbers = random.Random(seed)
    side = math.isqrt(discs)
    velocities = [[numbers.gauss(0, 1) for _ in range(discs)] for _ in range(2)]
    for along in velocities:
        drift = statistics.fmean(along)
        along[:] = [v - drift for v in along]
    scale = speed / math.sqrt(sum(v * v for along in velocities for v in along) / discs)
    rows = []
    for k in range(discs):
        x, y = ((place + 0.5) * size / side for place in divmod(k, side))
        rows.append(f"{k} {x!r} {y!r} {velocities[0][k] * scale!r} {velocities[1][k] * scale!r}")
    return "\n".join(rows) + "\n"


def report_of(program, scene, discs):
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "discs.txt"), "w", encoding="utf-8") as file:
            file.write(discs)
        path, result = os.path.join(folder, "scene.toml"), os.path.join(folder, "report.json")
        with open(path, "w", encoding="utf-8") as file:
            file.write(scene)
        subprocess.run([program, "run", path, "--quiet", "--threads", "1", "--report", result,
                        "-o", os.path.join(folder, "run")],
                       check=True, stdout=subprocess.DEVNULL)
        with open(result, encoding="utf-8") as file:
            return json.load(file)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--packing", type=float, action="append",
                        help="one of the long study's packings alone; may be repeated")
    parser.add_argument("--seeds", type=int, help="other than 16 and 128")
    options = parser.parse_args()
    n_seeds = options.seeds or (16 if options.short else 128)
    gases = SHORT if options.short else LONG
    wider = 1 + 3 / math.sqrt(2 * (n_seeds - 1)) if options.short else 1
    failed = False
    print("packing,average,mean,scatter,claimed,scatter_over_claimed,without_error")
    for packing, (discs, early, steps, every) in gases.items():
        if options.packing and packing not in options.packing:
            continue
        size = math.sqrt(discs * math.pi / packing)
        scene = SCENE.format(size=size, discs=discs, early=early, steps=early + steps, every=every,
                              window=10 * every)
        reports = [report_of(options.program, scene,
                             discs_text(discs, size, speed_of(packing), seed))
                   for seed in range(1, n_seeds + 1)]
        for name, quantity in QUANTITIES.items():
            pairs = [quantity(report) for report in reports]
            errors = [error for _, error in pairs if error is not None]
            scatter = statistics.stdev(value for value, _ in pairs)
            claimed = math.sqrt(statistics.fmean(e * e for e in errors)) if errors else math.nan
            ratio = scatter / claimed
            missing = n_seeds - len(errors)
            print(f"{packing},{name},{statistics.fmean(v for v, _ in pairs):.6g},{scatter:.3g},"
                  f"{claimed:.3g},{ratio:.2f},{missing}", flush=True)
            failed |= not 0.75 / wider < ratio < 1.3 * wider or 3 * missing > n_seeds
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
