#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hold what a program counts on several ranks to recorded values.

  tests/performance/costs.py insertion INSERTION_COSTS MPIEXEC     compare with insertion_costs.csv
  tests/performance/costs.py output OUTPUT_COSTS MPIEXEC           compare with output_costs.csv

--record writes the table anew. Names and hashes must be the recorded ones, and no count may be
larger than its recorded value: code 1 otherwise. The counts do not depend on the machine.
"""

import argparse
import csv
import os
import subprocess
import sys
import tempfile

from instructions import SETTINGS

FOLDER = os.path.dirname(os.path.abspath(__file__))
# ranks and arguments of the runs of each program
CASES = {
    "insertion": [
        (n_ranks, ["1e5", packing, threads])
        for packing in ("0.3", "0.5")
        for n_ranks, threads in ((1, "1"), (1, "2"), (3, "1"))
    ],
    "output": [(n_ranks, ["2e5", "."]) for n_ranks in (1, 4, 16)],
}
TEXTS = ("output", "hash")


def rows_of(program, mpiexec, cases):
    """What the runs print, joined to one table."""
    rows = []
    env = {**os.environ, **SETTINGS, "OMPI_MCA_rmaps_base_oversubscribe": "1"}
    del env["OMP_NUM_THREADS"]
    with tempfile.TemporaryDirectory() as folder:
        for n_ranks, arguments in cases:
            command = [mpiexec, "-n", str(n_ranks), program, *arguments]
            run = subprocess.run(
                command,
                cwd=folder,
                env=env,
                capture_output=True,
                text=True,
                timeout=120,
                check=False,
            )
            if run.returncode != 0:
                sys.exit(f"{' '.join(command)} failed:\n{run.stderr}")
            rows += csv.DictReader(run.stdout.splitlines())
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("name", choices=CASES)
    parser.add_argument("program", metavar="PROGRAM")
    parser.add_argument("mpiexec", metavar="MPIEXEC")
    parser.add_argument("--record", action="store_true")
    options = parser.parse_args()
    path = os.path.join(FOLDER, f"{options.name}_costs.csv")
    now = rows_of(os.path.abspath(options.program), options.mpiexec, CASES[options.name])
    if options.record:
        with open(path, "w", encoding="utf-8", newline="") as file:
            table = csv.DictWriter(file, now[0].keys(), lineterminator="\n")
            table.writeheader()
            table.writerows(now)
    with open(path, encoding="utf-8") as file:
        recorded = list(csv.DictReader(file))
    code = 0
    for before, after in zip(recorded, now, strict=True):
        print(", ".join(f"{key} {value}" for key, value in after.items()))
        for key, value in before.items():
            is_right = after[key] == value if key in TEXTS else float(after[key]) <= float(value)
            if not is_right:
                print(f"  {key} was {value}")
                code = 1
    return code


if __name__ == "__main__":
    sys.exit(main())
