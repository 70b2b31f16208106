#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hold granular temperatures over an oscillating floor to a law of kinetic theory, as CSV.

  tests/physics/shaken.py CARROM

In the limit kT >> <U^2>, U being the floor's velocity, what the floor gives and collisions take
leave kT = (4 sqrt(2) / pi) <U^2> / (N_w d (1 - e^2)) for discs of the diameter d, N_w of them on a
length (Kumaran, Phys. Rev. E 57, 5660 (1998)). The scene is inputs/vibrated.toml.
"""
import json
import math
import os
import subprocess
import sys
import tempfile

SCENE = os.path.join(os.path.dirname(__file__), "..", "..", "inputs", "vibrated.toml")
WIDTH = 400
MEAN_SQUARE = (0.5 * 2 * math.pi / 62.831853) ** 2 / 2
CASES = [(400, 0.995), (400, 0.99), (400, 0.98), (400, 0.95), (800, 0.99)]


def temperature(program, discs, restitution):
    """Value and standard error of a run's average."""
    with tempfile.TemporaryDirectory() as folder:
        result = os.path.join(folder, "report.json")
        subprocess.run([program, "run", SCENE, "--quiet", "--threads", "1", "--report", result,
                        "--set", "output.averages_from_step=80000",
                        "--set", f"discs.count={discs}",
                        "--set", f"effects.contact.restitution={restitution}"],
                       check=True, stderr=subprocess.DEVNULL)
        with open(result, encoding="utf-8") as file:
            found = json.load(file)["temperature"]
    return found["value"], found["error"]


def main():
    """One line for each number of discs and restitution."""
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    print("discs,restitution,kT_over_U2,kT,kT_error,kT_law,ratio,ratio_error")
    for discs, restitution in CASES:
        value, error = temperature(sys.argv[1], discs, restitution)
        law = 4 * math.sqrt(2) / math.pi * MEAN_SQUARE / (discs / WIDTH * (1 - restitution ** 2))
        print(f"{discs},{restitution},{value / MEAN_SQUARE:.1f},{value:.5f},{error:.5f},{law:.5f},"
              f"{value / law:.3f},{error / law:.3f}", flush=True)


if __name__ == "__main__":
    main()
