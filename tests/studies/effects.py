#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What effects cost, against the same gas without: instructions, and time as interleaved ratios.

  tests/studies/effects.py STEP_SCENE --repeats 9 --output docs/data/performance/effects.csv

STEP_SCENE is the program of that name that is compiled with the tests (build/tests/step_scene).
Instructions are those that valgrind counts below DiscSystem::advance_towards, divided by those of
the plain gas. With --repeats N there is time, too: the processor time of a whole run ten times as
long, plain and with the effect in turns, and the median of their ratios with the quartiles. That
needs an idle machine.
"""

import argparse
import csv
import itertools
import math
import os
import pathlib
import resource
import statistics
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "performance"))
from instructions import counted, run_scene


def classes(kinds):
    """The discs' tables for as many kinds as named: radii spread from 0.8 to 1.2 of the mean in
    equal numbers, masses as areas are.
    """

    def lines(packing):
        spread = [0.8 + 0.4 * k / (kinds - 1) for k in range(kinds)]
        mean = SIZE * math.sqrt(packing / (math.pi * COUNT * sum(s * s for s in spread) / kinds))
        return "".join(
            f"[[discs.species]]\ncount = {COUNT // kinds}\nradius = {s * mean}\nmass = {s * s}\n"
            for s in spread
        )

    return lines


# Nearly smooth discs, because rougher discs lose energy to their spins and collide less often.
ROUGH = (
    '[effects.contact]\nkind = "rough"\nrestitution = 0.999\ntangential_restitution ='
    ' -0.99\nfriction = 0.5\n'
)
COUNT, SIZE, STEPS = 3000, 300, 300

# factors of the number of discs and of the area of the box, with fewer steps: only discs near the
# sides have images, so the cost depends on the size of the box
SCALES = {"periodic sides": (1, 33)}
COLUMNS = ("effect", "method", "packing", "discs", "instructions_ratio")
TIME_COLUMNS = ("time_ratio", "time_lower_quartile", "time_upper_quartile")

# name: (method, lines that the scene has more)
EFFECTS = {
    "restitution 0.999 of discs": (
        "event-driven",
        '[effects.contact]\nkind = "restitution"\nrestitution = 0.999\n',
    ),
    "restitution 0.999 of discs, time-stepped": (
        "time-stepped",
        '[effects.contact]\nkind = "restitution"\nrestitution = 0.999\n',
    ),
    "two walls of restitution 0.99": (
        "event-driven",
        "[box.left]\nrestitution = 0.99\n[box.right]\nrestitution = 0.99\n",
    ),
    "a thermal wall": ("event-driven", '[box.left]\nkind = "thermal"\ntemperature = 0.045\n'),
    "a thermal wall, time-stepped": (
        "time-stepped",
        '[box.left]\nkind = "thermal"\ntemperature = 0.045\n',
    ),
    "gravity": ("event-driven", "[effects.gravity]\ny = -0.0001\n"),
    "drag": ("event-driven", "[effects.drag]\nrate = 0.0001\n"),
    "gravity and drag": (
        "event-driven",
        "[effects.gravity]\ny = -0.0001\n[effects.drag]\nrate = 0.0001\n",
    ),
    "obstacles, 25 discs and 2 segments": (
        "event-driven",
        "[effects.obstacles]\ndiscs = "
        + str([[x, y, 2] for x in range(30, 300, 60) for y in range(30, 300, 60)])
        + "\nsegments = [[60, 0, 60, 150], [240, 150, 240, 300]]\n",
    ),
    "a moving wall": ("event-driven", '[box.right]\nkind = "moving"\nspeed = -0.0005\n'),
    "periodic sides": (
        "event-driven",
        "".join(
            f'[box.{side}]\nkind = "periodic"\n' for side in ("left", "right", "bottom", "top")
        ),
    ),
    "periodic sides, time-stepped": (
        "time-stepped",
        "".join(
            f'[box.{side}]\nkind = "periodic"\n' for side in ("left", "right", "bottom", "top")
        ),
    ),
    "discs that do not meet": ("event-driven", '[effects.contact]\nkind = "none"\n'),
    "two radii and masses": ("event-driven", classes(2)),
    "two radii and masses, time-stepped": ("time-stepped", classes(2)),
    "each disc of a radius and a mass of its own": ("event-driven", classes(COUNT)),
    "each disc of a radius and a mass of its own, time-stepped": (
        "time-stepped",
        classes(COUNT),
    ),
    "rough discs": ("event-driven", ROUGH),
    "rough discs, time-stepped": ("time-stepped", ROUGH),
}


def scene_text(packing, method, lines, steps=STEPS, scale=1):
    """`lines` may be a function of the packing; it names the discs then. `scale`: how many times as
    many discs, in fewer steps.
    """
    discs = "" if callable(lines) else f"count = {scale * COUNT}\npacking = {packing}\n"
    return (
        f"[discs]\nspeed = 0.3\n{discs}[time]\nsteps = {max(1, steps // scale)}\nsync_every ="
        f" 32\nmethod = \"{method}\"\n[box]\nsize ="
        f" {SIZE * math.sqrt(scale)!r}\n{lines(packing) if callable(lines) else lines}"
    )


def processor_seconds(program, scene):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run_scene(program, scene)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return (after.ru_utime + after.ru_stime) - (before.ru_utime + before.ru_stime)


def ratios_of_times(program, plain, scene, repeats):
    ratios = []
    for _ in range(repeats):
        base = processor_seconds(program, plain)
        ratios.append(processor_seconds(program, scene) / base)
    return statistics.quantiles(ratios, n=4)


class Comparison:
    """Of scenes with an effect and the same gases without, in a folder for scenes."""

    def __init__(self, program, folder, repeats):
        self.program, self.folder, self.repeats = program, folder, repeats
        self.plain_counts = {}

    def stored(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    def count(self, gas, lines):
        packing, method, scale = gas
        text = scene_text(packing, method, lines, STEPS, scale)
        return counted(self.program, self.stored("scene.toml", text))

    def row(self, name, gas, lines):
        """The ratios, as COLUMNS and TIME_COLUMNS say."""
        packing, method, scale = gas
        if gas not in self.plain_counts:
            self.plain_counts[gas] = self.count(gas, "")
        ratio = self.count(gas, lines) / self.plain_counts[gas]
        row = [name.split(", time-stepped")[0], method, packing, scale * COUNT, f"{ratio:.3f}"]
        if self.repeats:
            plain, scene = (
                self.stored(file, scene_text(packing, method, more, 10 * STEPS, scale))
                for file, more in (("plain.toml", ""), ("effect.toml", lines))
            )
            low, median, high = ratios_of_times(self.program, plain, scene, self.repeats)
            row += [f"{median:.2f}", f"{low:.2f}", f"{high:.2f}"]
        return row


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("program", metavar="STEP_SCENE")
    parser.add_argument("--output", default="/dev/stdout", metavar="CSV")
    parser.add_argument("--repeats", type=int, default=0, help="of runs whose time is taken")
    parser.add_argument("--packing", type=float, nargs="+", default=[0.1, 0.3])
    parser.add_argument("--only", nargs="+", default=[""], help="effects whose name begins so")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, open(
        options.output, "w", encoding="utf-8", newline=""
    ) as file:
        comparison = Comparison(options.program, folder, options.repeats)
        table = csv.writer(file, lineterminator="\n")
        table.writerow(COLUMNS + (TIME_COLUMNS if options.repeats else ()))
        for name, (method, lines) in EFFECTS.items():
            if not name.startswith(tuple(options.only)):
                continue
            scales = SCALES.get(name.split(", time-stepped")[0], (1,))
            for packing, scale in itertools.product(options.packing, scales):
                table.writerow(comparison.row(name, (packing, method, scale), lines))
                file.flush()
    return 0


if __name__ == "__main__":
    sys.exit(main())
