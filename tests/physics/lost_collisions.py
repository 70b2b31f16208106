#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hold the estimate of lost collisions to event-driven runs of the same gas, as CSV.

  tests/physics/lost_collisions.py CARROM
"""
import json
import math
import os
import subprocess
import sys
import tempfile

N_DISCS = 2000
# eta: collisions per disc and time in units of sqrt(kT) / diameter (Enskog)
RATES = {0.02: 0.0932, 0.1: 0.5329, 0.3: 2.4005, 0.5: 7.0076}
SIDES = "".join(f'{side}.kind = "periodic"\n' for side in ("left", "right", "bottom", "top"))


def report(program, eta, per_step, method):
    """Of a periodic gas whose discs collide 30 times each; the first third is left out."""
    steps = round(30 / per_step)
    with tempfile.TemporaryDirectory() as folder:
        scene = os.path.join(folder, "gas.toml")
        with open(scene, "w", encoding="utf-8") as file:
            file.write(f"[box]\nsize = {math.sqrt(N_DISCS * math.pi / eta)}\n{SIDES}"
                       f"[discs]\ncount = {N_DISCS}\nradius = 1\n"
                       f"speed = {per_step * 2 * math.sqrt(2) / RATES[eta]}\n"
                       f"[time]\nsteps = {steps}\nmethod = \"{method}\"\n"
                       f"[output]\naverages_from_step = {steps // 3}\n")
        result = os.path.join(folder, "report.json")
        subprocess.run([program, "run", scene, "--quiet", "--threads", "1", "--report", result],
                       check=True, stderr=subprocess.DEVNULL)
        with open(result, encoding="utf-8") as file:
            return json.load(file)


def main():
    """One line for each density and length of a step."""
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    print("eta,collisions_per_disc_and_step,lost,estimate,pressure_error,pressure_estimate")
    for eta in RATES:
        for per_step in (1 / 4, 1 / 16, 1 / 64, 1 / 256):
            exact = report(sys.argv[1], eta, per_step, "event-driven")
            found = report(sys.argv[1], eta, per_step, "time-stepped")
            lost = 1 - (found["averages"]["collision_frequency"]["value"] /
                        exact["averages"]["collision_frequency"]["value"])
            pressure = found["pressure"]["value"] / exact["pressure"]["value"] - 1
            estimate = found["lost_collisions"]
            print(f"{eta},{per_step},{lost:.4f},{estimate['share']:.4f},{pressure:.4f},"
                  f"{estimate['pressure_error']:.4f}", flush=True)


if __name__ == "__main__":
    main()
