#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Make the tables of docs/data/validation anew, from what the long studies print.

  tests/physics/tables.py [--build build] [--folder docs/data/validation] [--only bulk ...]

Runs tests of BUILD/tests/physics_mpi_test, each on one rank with one thread, one after the other:
a quarter of an hour in all. A test that fails ends the script and leaves its table as it was.
"""
import argparse
import csv
import os
import pathlib
import re
import subprocess
import sys

SETTINGS = {
    "OMP_NUM_THREADS": "1",
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "CARROM_TEST_SECONDS": "7200",
}


def rows_of(program, name):
    """The rows of numbers that a test prints; `a +- b` falls into two of them."""
    print(f"physics: {name}", file=sys.stderr)
    name = f"physics: {name}".replace(",", "\\,")
    run = subprocess.run([program, name], env=os.environ | SETTINGS, capture_output=True,
                         text=True, check=False)
    if run.returncode != 0 or "No test cases matched" in run.stdout:
        sys.exit(f"{program} '{name}' ended with code {run.returncode}:\n{run.stdout}{run.stderr}")
    lines = re.findall(r"^\| (\d.*) \|$", run.stdout, re.M)
    return [re.split(r" *\| *| \+- ", line) for line in lines]


def speeds(program):
    """Kolmogorov's distance and the kurtosis, by the number of discs."""
    distances = {row[0]: row[2] for row in
                 rows_of(program, "speeds have the microcanonical distribution, long")}
    name = "the kurtosis of speeds is that of finitely many discs, long"
    return [[row[0], distances.get(row[0], ""), *row[1:]] for row in rows_of(program, name)]


def relaxation(program):
    """The kurtosis and Boltzmann's, of a dense and of a thin gas."""
    name = "the course program's speeds relax to Maxwell's"
    dense, thin = rows_of(program, name), rows_of(program, name + ", long")
    return [[*first, *second[1:]] for first, second in zip(dense, thin, strict=True)]


TABLES = {
    "two_discs": (
        "packing,pair_rate,pair_rate_measured,pair_rate_error,wall_rate,wall_rate_measured,"
        "wall_rate_error",
        lambda program: rows_of(program, "two discs collide as often as they must, long"),
    ),
    "two_pressures": (
        "discs,packing,Z_walls,Z_walls_error,Z_walls_and_pairs,Z_walls_and_pairs_error,difference",
        lambda program: rows_of(program, "both estimators of the pressure agree, long"),
    ),
    "bulk": (
        "packing,discs,Z,Z_error,Z_known,nu_sigma,nu_sigma_error,nu_sigma_known",
        lambda program: rows_of(program, "pressure and collision frequency without walls, long"),
    ),
    "speeds": ("discs,D_sqrt_n,kurtosis,kurtosis_error,kurtosis_known", speeds),
    "relaxation": (
        "collisions_per_disc,kurtosis_dense,kurtosis_dense_boltzmann,kurtosis_thin,"
        "kurtosis_thin_boltzmann",
        relaxation,
    ),
}


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("build"))
    parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path("docs/data/validation"))
    parser.add_argument("--only", nargs="+", choices=TABLES, default=list(TABLES))
    options = parser.parse_args()
    program = str((options.build / "tests/physics_mpi_test").resolve())
    for name in options.only:
        heading, make = TABLES[name]
        rows = make(program)
        if not rows or any(len(row) != len(heading.split(",")) for row in rows):
            sys.exit(f"the tests print other rows than {name}.csv has: {rows}")
        with open(options.folder / f"{name}.csv", "w", encoding="utf-8", newline="") as file:
            file.write(heading + "\n")
            csv.writer(file, lineterminator="\n").writerows(rows)


if __name__ == "__main__":
    main()
