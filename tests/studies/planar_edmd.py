#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Build the event-driven code EDMD for discs in a plane, as a peer to be timed against.

  git clone https://github.com/FSmallenburg/EDMD && tests/studies/planar_edmd.py EDMD PROGRAM

EDMD (Smallenburg, Eur. Phys. J. E 45, 22 (2022)) moves spheres. Two of its variants are changed on
the way: `Cell` looks for partners in cells, and `Multi` keeps lists of neighbours, which is faster
in dense boxes. Both get one layer of cells, no velocity across it, and no search above or below.
(Its third variant, `Single`, computes times that are no numbers in such a box.) The PROGRAM reads
init.sph from its folder. `PROGRAM N` makes N collisions and prints their number and the seconds
that they took. It was made with commit 2d0c862; where the source does not have a line that is
replaced, this says which and builds nothing. Nothing of EDMD is kept in this project.
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile

CELLS = 2200  # cells along a side, enough for 1e6 discs at a packing of 0.17
# Each row: text to replace, its replacement, and how often the text occurs. First the changes of
# both variants: two components of velocity at kT = 1, no output on the way, and the time that a
# number of collisions takes.
BOTH = [
    ("p->vz = imsq * random_gaussian();", "p->vz = 0;", 1),
    ("double fac = sqrt(3.0 /", "double fac = sqrt(2.0 /", 1),
    ("createevent(simtime + writeinterval, NULL, NULL, 100);", "", 1),
    ("int main()\n", "#include <time.h>\nint main(int n_words, char** words)\n", 1),
    (
        "    while (simtime <= maxtime)",
        "    struct timespec begin, end;\n"
        "    const unsigned wanted = n_words > 1 ? (unsigned)strtoul(words[1], NULL, 10) : 0;\n"
        "    clock_gettime(CLOCK_MONOTONIC, &begin);\n"
        "    while (colcounter < wanted)",
        1,
    ),
    (
        "    simtime = maxtime;",
        "    clock_gettime(CLOCK_MONOTONIC, &end);\n"
        '    printf("collisions %u seconds %.6f\\n", colcounter,\n'
        "           end.tv_sec - begin.tv_sec + 1e-9 * (end.tv_nsec - begin.tv_nsec));\n"
        "    return 0;",
        1,
    ),
]
# Then the changes of each variant: a box of one layer, and partners only in that layer.
CHANGES = {
    "Cell": [
        ("#define MAXCEL 75", f"#define MAXCEL {CELLS}", 1),
        ("celllist[MAXCEL][MAXCEL][MAXCEL]", "celllist[MAXCEL][MAXCEL][1]", 1),
        ("cz = (int)(zsize - 0.0001) ;", "cz = 1;", 1),
        ("cz *= 0.9;", "", 1),
        (" || part->cellz == 0", "", 1),
        (" || part->cellz == cz - 1", "", 1),
        (" || p->cellz == 0", "", 1),
        (" || p->cellz == cz - 1", "", 1),
        ("for ( dz = -1; dz < 2; dz++)", "for (dz = 0; dz < 1; dz++)", 1),
        ("for ( dz = cellz-1; dz < cellz+2; dz++)", "for (dz = cellz; dz <= cellz; dz++)", 1),
        ("int zmin = cellz-1;", "int zmin = cellz;", 1),
        ("int zmax = cellz+1;", "int zmax = cellz;", 1),
    ],
    "Multi": [
        ("cz = (int)(zsize - 0.0001) / shellsize;", "cz = 1;", 1),
        ("cz *= 0.9;", "", 1),
        (" || cellz == 0", "", 1),
        (" || cellz == cz - 1", "", 1),
        (
            "for (cdz = cellz - 1; cdz < cellz + 2; cdz++)",
            "for (cdz = cellz; cdz <= cellz; cdz++)",
            1,
        ),
    ],
}
NEIGHBOURS = "#define MAXNEIGH 24"  # in Multi; a large disc among small ones has more neighbours
COMPILER = ["gcc", "-Ofast", "-funroll-loops", "-march=native"]  # as in EDMD's own Makefile


def planar(source, variant):
    changes = BOTH + CHANGES[variant]
    wrong = [f"{old!r} is there {source.count(old)} times, not {n}"
             for old, _, n in changes if source.count(old) != n]  # fmt: skip
    if wrong:
        sys.exit(f"md{variant}.c is not the one that is expected:\n" + "\n".join(wrong))
    for old, new, _ in changes:
        source = source.replace(old, new)
    return source


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("source", type=pathlib.Path, help="a clone of EDMD")
    parser.add_argument("program", type=pathlib.Path, help="what to build")
    parser.add_argument("--variant", choices=sorted(CHANGES), default="Cell")
    parser.add_argument("--neighbours", type=int, help="room for neighbours, in Multi")
    parser.add_argument("--flags", nargs="*", default=[], help="more of them for the compiler")
    options = parser.parse_args()
    variant = options.source / options.variant
    source = (variant / f"md{options.variant}.c").read_text(encoding="utf-8")
    text = planar(source, options.variant)
    if options.neighbours:
        assert NEIGHBOURS in text, f"there is no {NEIGHBOURS!r}"
        text = text.replace(NEIGHBOURS, f"#define MAXNEIGH {options.neighbours}")
    with tempfile.TemporaryDirectory() as folder:
        changed = pathlib.Path(folder) / "planar.c"
        changed.write_text(text, encoding="utf-8")
        flags = [*options.flags, f"-I{variant}"]
        words = [*COMPILER, *flags, str(changed), "-o", options.program, "-lm"]
        subprocess.run(words, check=True)


if __name__ == "__main__":
    main()
