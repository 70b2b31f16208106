#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Print what quantities take of a run, in instructions and memory:
docs/data/performance/quantities.csv.

  tests/studies/quantity_costs.py CARROM [QUANTITY ...]

A gas at a packing of 0.3 in a periodic box, or for quantities of walls between walls, runs on one
thread with the event-driven method. Each disc collides once in a step on average. Shares are those
of a run of 1e5 discs: the instructions of its steps are counted without quantities. What a quantity
adds for each disc and step is counted with 1000 discs, because it does not depend on their number.
There profiles have one cell, so that as many collisions lie across its edge as lie across edges of
the default grid among 1e5 discs. valgrind counts the instructions of steps and of samples, but not
those of the start. `per_collision` is the share where a sample is taken after each collision of a
disc, and `per_ten`, the default, where it is taken after ten. There are so many samples that
correlations have most of their lags. `megabytes` is what the largest memory of a run of 1e5 discs
grows by, with a sample after each of 40 steps. It takes some ten minutes.
"""
import argparse
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "performance"))
from instructions import SETTINGS

FEW, MANY = 1000, 100_000
PLAIN_STEPS, SAMPLES = 10, 40
SCENE = """[box]
size = {size}
left.kind = "periodic"
right.kind = "periodic"
bottom.kind = "{kind}"
top.kind = "{kind}"
[discs]
count = {discs}
packing = 0.3
speed = {speed}
[time]
steps = {steps}
method = "event-driven"
"""
MEASURED = """[output.measurements]
quantities = ["{name}"]
every_steps = {every}
from_step = 1
"""
SETTINGS_OF = {"profiles": "profile_columns = 1\nprofile_rows = 1\n"}
QUANTITIES = ("wall_pressure", "wall_exchange", "velocities", "density", "displacement",
              "diffusion", "pressure", "thermo", "radial_distribution", "profiles",
              "correlations", "transport")


def write_scene(path, discs, steps, kind, name, every):
    """A gas of a radius of 1 that measures a quantity, or nothing."""
    scene = SCENE.format(size=math.sqrt(discs * math.pi / 0.3), discs=discs, kind=kind,
                         speed=2 * math.sqrt(math.pi / 8) / 1.063, steps=steps)
    if name:
        scene += MEASURED.format(name=name, every=every)
    with open(path, "w", encoding="utf-8") as file:
        file.write(scene)


def megabytes(program, kind, name=""):
    """The largest memory of a run of many discs."""
    with tempfile.TemporaryDirectory() as folder:
        write_scene(f"{folder}/scene.toml", MANY, SAMPLES, kind, name, 1)
        pid = os.spawnvpe(os.P_NOWAIT, program, [program, "run", f"{folder}/scene.toml", "--quiet",
                                                 "--threads", "1", "-o", f"{folder}/run"],
                          os.environ | SETTINGS)
        _, status, usage = os.wait4(pid, 0)
    if status != 0:
        sys.exit(f"a run with {name or 'no quantity'} failed")
    return usage.ru_maxrss / 1000 # it is in kB


def instructions(program, discs, steps, kind, name="", every=1):
    """Of all steps and samples of a run, for each disc and step."""
    with tempfile.TemporaryDirectory() as folder:
        write_scene(f"{folder}/scene.toml", discs, steps, kind, name, every)
        if name in SETTINGS_OF:
            with open(f"{folder}/scene.toml", "a", encoding="utf-8") as file:
                file.write(SETTINGS_OF[name])
        command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null",
                   "--collect-atstart=no", "--toggle-collect=carrom::EngineBase*::advance_towards*",
                   "--toggle-collect=carrom::Sampler::act*", program, "run",
                   f"{folder}/scene.toml", "--quiet", "--threads", "1", "-o", f"{folder}/run"]
        result = subprocess.run(command, check=True, capture_output=True, text=True, timeout=1200,
                                env=os.environ | SETTINGS)
    return int(re.search(r"Collected : (\d+)", result.stderr)[1]) / (discs * steps)


def main():
    """Print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("program", metavar="CARROM", help="the program, as built")
    parser.add_argument("names", metavar="QUANTITY", nargs="*", default=QUANTITIES,
                        help="all of the table, if none is named")
    options = parser.parse_args()
    program, names = options.program, options.names
    kinds = {name: "wall" if name.startswith("wall") else "periodic" for name in names}
    whole = {kind: (instructions(program, MANY, PLAIN_STEPS, kind), megabytes(program, kind))
             for kind in set(kinds.values())}
    plain = {(kind, every): instructions(program, FEW, every * SAMPLES, kind)
             for kind in whole for every in (1, 10)}
    print("quantity,per_collision,per_ten,megabytes")
    for name, kind in kinds.items():
        count, memory = whole[kind]
        added = [instructions(program, FEW, every * SAMPLES, kind, name, every) - plain[kind, every]
                 for every in (1, 10)]
        print(f"{name},{added[0] / count:.3f},{added[1] / count:.3f},"
              f"{max(0, megabytes(program, kind, name) - memory):.1f}", flush=True)


if __name__ == "__main__":
    main()
