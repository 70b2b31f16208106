#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hold the speed-up of many threads, as block_spans.cpp counts it, to recorded values.

  tests/performance/block_spans.py BLOCK_SPANS              compare with block_spans.csv; code 1 if
                                                    a speed-up is more than 5 % lower
  tests/performance/block_spans.py BLOCK_SPANS --record      write block_spans.csv anew

The counts do not depend on the machine, nor on how fast anything is. Another compiler may round
the work of blocks otherwise, so that a cut moves by a cell and the slowest block takes some percent
more.
"""

import argparse
import csv
import os
import sys

from instructions import finished

TOLERANCE = 0.05
TABLE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "block_spans.csv")
DISCS, THREADS = "1e5", "32"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", metavar="BLOCK_SPANS")
    parser.add_argument("--record", action="store_true")
    options = parser.parse_args()
    text = finished([options.program, DISCS, THREADS]).stdout
    if options.record:
        with open(TABLE, "w", encoding="utf-8") as file:
            file.write(text)
    now = {row["scene"]: float(row["speed-up"]) for row in csv.DictReader(text.splitlines())}
    with open(TABLE, encoding="utf-8") as file:
        recorded = list(csv.DictReader(file))
    code = 0
    for row in recorded:
        before, after = float(row["speed-up"]), now[row["scene"]]
        print(f"{row['scene']}: speed-up {after} of {THREADS} threads, recorded {before}")
        if after < (1 - TOLERANCE) * before:
            code = 1
    return code


if __name__ == "__main__":
    sys.exit(main())
