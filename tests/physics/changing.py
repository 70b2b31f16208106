#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How often a run says that it is still changing: in equilibrium, and where it is not.

  tests/physics/changing.py CARROM [--short] [--scene NAME] [--seeds N]

Prints CSV: for each scene the number of runs, and how many of them find that psi6, the local psi6,
one of the averages, or F_s of the correlations is still changing. `slow` counts runs that find too
few independent samples of either order, and `order` those with any doubt of order. In equilibrium
these are false alarms. Melting, freezing and ageing runs show the power of the tests.

The exit code is 1 where more than the share `most` of the runs gives a false alarm, or where fewer
than the share `least` of the others see what changes. Shares of the short study are widened by
what its few seeds can tell.
"""
import argparse
import json
import math
import os
import subprocess
import sys
import tempfile

from scatter import discs_text, speed_of

SIDES = """left = { kind = "periodic" }
right = { kind = "periodic" }
bottom = { kind = "periodic" }
top = { kind = "periodic" }
"""


def equilibrium(packing, discs, early, steps):
    """A gas or a liquid whose lattice has melted long before averages begin."""
    size = math.sqrt(discs * math.pi / packing)
    scene = f"""[box]
size = {size!r}
{SIDES}[discs]
count = {discs}
radius = 1
generator = "file"
file = "discs.txt"
[time]
method = "event-driven"
steps = {early + steps}
[output]
averages_from_step = {early}
[output.measurements]
quantities = ["psi6", "correlations"]
from_step = {early}
every_steps = 10
largest_distance = 3
"""
    return scene, lambda seed: discs_text(discs, size, speed_of(packing), seed)


def grown(packing, discs, steps, quantities, kinds=((1.0, 1.0),)):
    """A random gas that has grown to this packing; it is not in equilibrium. `kinds`: shares of
    the discs, and their radii."""
    area = sum(share * radius ** 2 for share, radius in kinds) * discs * math.pi
    species = "".join(f"[[discs.species]]\ncount = {round(share * discs)}\nradius = {radius}\n"
                      for share, radius in kinds)
    return f"""[box]
size = {math.sqrt(area / packing)!r}
{SIDES}[discs]
generator = "compressed"
speed = {speed_of(packing)!r}
{species}[time]
method = "event-driven"
steps = {steps}
""" + (f"[output.measurements]\nquantities = {json.dumps(quantities)}\nevery_steps = 8\n"
           if quantities else ""), None


def crystal(packing, steps):
    """A triangular lattice that melts."""
    return f"""[box]
size = [30, 29.44486]
{SIDES}[discs]
count = 1020
packing = {packing}
generator = "triangular"
speed = {0.45 * speed_of(packing)!r}
[time]
method = "event-driven"
steps = {steps}
""", None


# Scene and seeds; whether it is in equilibrium; the columns that must detect the change.
SCENES = {
    "gas 0.3": (equilibrium(0.3, 400, 400, 4000), 64, True, ()),
    "gas 0.5": (equilibrium(0.5, 400, 400, 4000), 64, True, ()),
    "liquid 0.62": (equilibrium(0.62, 400, 4000, 4000), 64, True, ()),
    "freezing 0.71": (grown(0.71, 4096, 5000, []), 16, False, ("order",)),
    "melting 0.69": (crystal(0.69, 2000), 16, False, ("order",)),
    "glass 0.785": (grown(0.785, 1000, 20000, ["correlations"], ((0.5, 1.0), (0.5, 1.4))), 16,
                    False, ("F_s",)),
}
SHORT = {"gas 0.5": 6, "melting 0.69": 4}
MOST, LEAST = 0.05, 0.7
COLUMNS = ("order", "psi6", "local_psi6", "slow", "averages", "F_s")


def report_of(program, scene, discs, seed):
    with tempfile.TemporaryDirectory() as folder:
        if discs:
            with open(os.path.join(folder, "discs.txt"), "w", encoding="utf-8") as file:
                file.write(discs(seed))
        path, result = os.path.join(folder, "scene.toml"), os.path.join(folder, "report.json")
        with open(path, "w", encoding="utf-8") as file:
            file.write(scene)
        seeds = [] if discs else ["--set", f"discs.seed={seed}"]
        subprocess.run([program, "run", path, *seeds, "--quiet", "--threads", "1", "--report",
                        result, "-o", os.path.join(folder, "run")],
                       check=True, stdout=subprocess.DEVNULL)
        with open(result, encoding="utf-8") as file:
            return json.load(file)


def is_changing(average):
    return (average or {}).get("without_error", "").startswith("still changing")


def found(report):
    """Which of the columns are still changing."""
    watched = report.get("watched", {})
    averages = [report["temperature"], report["pressure"], report["compressibility"],
                *report["pressure_tensor"].values(),
                *(one for one in report["averages"].values() if isinstance(one, dict))]
    orders = {"psi6": is_changing(watched.get("psi6")),
              "local_psi6": is_changing(watched.get("local_psi6")),
              "slow": "has only" in report.get("doubts", "")}
    return {"order": any(orders.values()), **orders,
            "averages": any(map(is_changing, averages)),
            "F_s": "F_s" in report.get("doubts", "")}


def is_right(runs, is_equilibrium, columns, wider):
    n = len(runs)
    if is_equilibrium:
        return all(sum(run[name] for run in runs) <= MOST * n + wider for name in COLUMNS)
    return sum(any(run[name] for name in columns) for run in runs) >= LEAST * n - wider


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--scene", action="append", help="one of the scenes; may be repeated")
    parser.add_argument("--seeds", type=int)
    options = parser.parse_args()
    failed = False
    print("scene,runs," + ",".join(COLUMNS))
    for name, ((scene, discs), n_seeds, is_equilibrium, columns) in SCENES.items():
        if (options.scene and name not in options.scene) or (options.short and name not in SHORT):
            continue
        n_seeds = options.seeds or (SHORT[name] if options.short else n_seeds)
        runs = [found(report_of(options.program, scene, discs, seed))
                for seed in range(1, n_seeds + 1)]
        counts = ",".join(str(sum(run[column] for run in runs)) for column in COLUMNS)
        print(f"{name},{n_seeds},{counts}", flush=True)
        failed |= not is_right(runs, is_equilibrium, columns, 1 if options.short else 0)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
