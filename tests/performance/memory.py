#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Peak memory of a disc: what a run of a million takes beyond one of a thousand, on one rank and
thread. Fails where a method takes more than its bound.

  tests/performance/memory.py build/carrom
"""

import json
import os
import subprocess
import sys
import tempfile

from measure import ENVIRONMENT, exact, gas

MILLION = 1_000_000
# bytes: 96 and 107 when this was written; 103 and 134 before lists were given back
BOUNDS = {"time-stepped": 100, "event-driven": 112}


def scene(method, n_discs):
    if method == "time-stepped":
        return gas(n_discs, 16)[0]
    return exact(n_discs, 0.3, 0.6 * n_discs)[0]


def peak(program, text, folder):
    """Bytes."""
    path, report = os.path.join(folder, "scene.toml"), os.path.join(folder, "report.json")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    command = [program, "run", path, "--threads", "1", "--quiet", "--report", report]
    subprocess.run(command, check=True, env=ENVIRONMENT)
    with open(report, encoding="utf-8") as file:
        result = json.load(file)
    return result["peak_bytes_per_disc"] * result["n_discs"]


def main():
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        for method, bound in BOUNDS.items():
            few = peak(sys.argv[1], scene(method, 1000), folder)
            many = peak(sys.argv[1], scene(method, MILLION), folder)
            per_disc = (many - few) / (MILLION - 1000)
            failed |= per_disc > bound
            print(f"{method}: {per_disc:.1f} bytes a disc, at most {bound}")
    return failed


if __name__ == "__main__":
    sys.exit(main())
