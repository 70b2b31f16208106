#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Peak memory of a disc: what a run of three million takes beyond one of a thousand. Fails where a
method takes more than its bound on one rank, or more than a tenth beyond that on two and three.

  tests/performance/memory.py build/carrom [mpiexec]
"""

import json
import os
import subprocess
import sys
import tempfile

from measure import ENVIRONMENT, exact, gas

FEW, MANY = 1000, 3_000_000
# bytes: 93 and 106 when this was written; 103 and 134 before lists were given back
BOUNDS = {"time-stepped": 100, "event-driven": 112}


def scene(method, n_discs):
    if method == "time-stepped":
        return gas(n_discs, 4)[0]
    return exact(n_discs, 0.3, 0.3 * n_discs)[0]


def peak(program, launch, text, folder):
    """Bytes of all ranks together."""
    path, report = os.path.join(folder, "scene.toml"), os.path.join(folder, "report.json")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    command = [*launch, program, "run", path, "--threads", "1", "--quiet", "--report", report]
    subprocess.run(command, check=True, env=ENVIRONMENT)
    with open(report, encoding="utf-8") as file:
        result = json.load(file)
    return result["peak_bytes_per_disc"] * result["n_discs"]


def main():
    program, mpiexec = sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else "mpiexec"
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        for method, bound in BOUNDS.items():
            for n_ranks in (1, 2, 3):
                launch = [mpiexec, "-n", str(n_ranks)]
                few = peak(program, launch, scene(method, FEW), folder)
                many = peak(program, launch, scene(method, MANY), folder)
                per_disc = (many - few) / (MANY - FEW)
                failed |= per_disc > bound
                print(f"{method}, {n_ranks} ranks: {per_disc:.1f} bytes a disc of {bound:.1f}")
                if n_ranks == 1:
                    bound = 1.1 * per_disc
    return failed


if __name__ == "__main__":
    sys.exit(main())
