#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hold the sharing of work among ranks, as rank_loads.cpp counts it, to recorded values.

  tests/performance/rank_loads.py RANK_LOADS MPIEXEC              compare with rank_loads.csv
  tests/performance/rank_loads.py RANK_LOADS MPIEXEC --record      write rank_loads.csv anew

The code is 1 if a halo is more than 5 % larger, if the busiest rank has more than 1.15 times the
mean work, or if the hashes of a scene differ. The counts do not depend on the machine, nor on how
fast anything is. Another compiler may round weights otherwise, so that a cut moves a little.
"""

import argparse
import csv
import os
import sys

from instructions import finished

TOLERANCE = 0.05
MOST_UNEVEN = 1.15
TABLE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "rank_loads.csv")
DISCS, RANKS = "2e4", "16"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", metavar="RANK_LOADS")
    parser.add_argument("mpiexec", metavar="MPIEXEC", nargs="+")
    parser.add_argument("--record", action="store_true")
    options = parser.parse_args()
    os.environ["OMP_NUM_THREADS"] = "1"
    text = finished([*options.mpiexec, "-n", RANKS, options.program, DISCS]).stdout
    if options.record:
        with open(TABLE, "w", encoding="utf-8") as file:
            file.write(text)
    now = list(csv.DictReader(text.splitlines()))
    with open(TABLE, encoding="utf-8") as file:
        recorded = list(csv.DictReader(file))
    code = 0
    hashes = {}
    for before, after in zip(recorded, now, strict=True):
        halo, uneven = float(after["halo over own"]), float(after["busiest over mean"])
        print(
            f"{after['scene']}, {after['across']} across: halo over own {halo}, recorded"
            f" {before['halo over own']}; busiest over mean {uneven}, at most {MOST_UNEVEN}"
        )
        if halo > (1 + TOLERANCE) * float(before["halo over own"]) or uneven > MOST_UNEVEN:
            code = 1
        if hashes.setdefault(after["scene"], after["state hash"]) != after["state hash"]:
            print("  another state than with whole strips")
            code = 1
    return code


if __name__ == "__main__":
    sys.exit(main())
