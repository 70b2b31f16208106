#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What effects cost, against the same gas without: instructions, and time as interleaved ratios.

  tests/performance/effects.py STEP_SCENE [--repeats 9] [--packing 0.1 0.3] [--only gravity ...]

STEP_SCENE is the program of that name that is compiled with the tests (build/tests/step_scene).
Instructions are those that valgrind counts below Simulation::advance_towards, divided by those of
the plain gas; time is the processor time of a whole run ten times as long, plain and with the
effect in turns, and the median of their ratios with the quartiles. Prints a table of Markdown.
"""

import argparse
import math
import os
import resource
import statistics
import subprocess
import sys
import tempfile

from instructions import SETTINGS, counted


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


# Nearly smooth: rougher ones lose energy to their spins, and collide less often.
ROUGH = (
    '[effects.contact]\nkind = "rough"\nrestitution = 0.999\ntangential_restitution ='
    ' -0.99\nfriction = 0.5\n'
)
COUNT, SIZE, STEPS = 3000, 300, 300

# name: (method, lines that the scene has more, what the cost should stay below)
EFFECTS = {
    "restitution 0.999 of discs": (
        "event-driven",
        '[effects.contact]\nkind = "restitution"\nrestitution = 0.999\n',
        1.1,
    ),
    "restitution 0.999 of discs, time-stepped": (
        "time-stepped",
        '[effects.contact]\nkind = "restitution"\nrestitution = 0.999\n',
        1.1,
    ),
    "two walls of restitution 0.99": (
        "event-driven",
        "[box.left]\nrestitution = 0.99\n[box.right]\nrestitution = 0.99\n",
        1.1,
    ),
    "a thermal wall": ("event-driven", '[box.left]\nkind = "thermal"\ntemperature = 0.045\n', 1.1),
    "a thermal wall, time-stepped": (
        "time-stepped",
        '[box.left]\nkind = "thermal"\ntemperature = 0.045\n',
        1.1,
    ),
    "gravity": ("event-driven", "[effects.gravity]\ny = -0.0001\n", 1.15),
    "drag": ("event-driven", "[effects.drag]\nrate = 0.0001\n", 1.1),
    "gravity and drag": (
        "event-driven",
        "[effects.gravity]\ny = -0.0001\n[effects.drag]\nrate = 0.0001\n",
        1.15,
    ),
    "obstacles, 25 discs and 2 segments": (
        "event-driven",
        "[effects.obstacles]\ndiscs = "
        + str([[x, y, 2] for x in range(30, 300, 60) for y in range(30, 300, 60)])
        + "\nsegments = [[60, 0, 60, 150], [240, 150, 240, 300]]\n",
        None,
    ),
    "a moving wall": ("event-driven", '[box.right]\nkind = "moving"\nspeed = -0.0005\n', 1.1),
    "periodic sides": (
        "event-driven",
        "".join(
            f'[box.{side}]\nkind = "periodic"\n' for side in ("left", "right", "bottom", "top")
        ),
        1.1,
    ),
    "periodic sides, time-stepped": (
        "time-stepped",
        "".join(
            f'[box.{side}]\nkind = "periodic"\n' for side in ("left", "right", "bottom", "top")
        ),
        1.1,
    ),
    "discs that do not meet": ("event-driven", '[effects.contact]\nkind = "none"\n', None),
    "two radii and masses": ("event-driven", classes(2), 1.4),
    "two radii and masses, time-stepped": ("time-stepped", classes(2), 1.4),
    "each disc of a radius and a mass of its own": ("event-driven", classes(COUNT), 1.4),
    "each disc of a radius and a mass of its own, time-stepped": (
        "time-stepped",
        classes(COUNT),
        1.4,
    ),
    "rough discs": ("event-driven", ROUGH, 1.5),
    "rough discs, time-stepped": ("time-stepped", ROUGH, 1.5),
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
    run = subprocess.run(
        [program, scene],
        env={**os.environ, **SETTINGS},
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    if run.returncode != 0:
        sys.exit(f"{program} {scene} failed:\n{run.stderr}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return (after.ru_utime + after.ru_stime) - (before.ru_utime + before.ru_stime)


def ratios_of_times(program, plain, scene, repeats):
    ratios = []
    for _ in range(repeats):
        base = processor_seconds(program, plain)
        ratios.append(processor_seconds(program, scene) / base)
    return statistics.quantiles(ratios, n=4)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", metavar="STEP_SCENE")
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--packing", type=float, nargs="+", default=[0.1, 0.3])
    parser.add_argument("--only", nargs="+", help="effects whose name begins so")
    parser.add_argument(
        "--scale",
        type=int,
        default=1,
        help="times as many discs and as large a box, in fewer steps; not for radii and obstacles",
    )
    options = parser.parse_args()
    print(
        "| effect | packing | instructions | time: median | quartiles | should stay below"
        " |\n|---|---|---|---|---|---|"
    )
    with tempfile.TemporaryDirectory() as folder:
        plain_counts = {}

        def stored(name, text):
            path = os.path.join(folder, name)
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
            return path

        for name, (method, lines, bound) in EFFECTS.items():
            if options.only and not any(name.startswith(word) for word in options.only):
                continue
            for packing in options.packing:
                plain = stored("plain.toml", scene_text(packing, method, "", STEPS, options.scale))
                scene = stored(
                    "effect.toml", scene_text(packing, method, lines, STEPS, options.scale)
                )
                if (method, packing) not in plain_counts:
                    plain_counts[method, packing] = counted(options.program, plain)
                count = counted(options.program, scene) / plain_counts[method, packing]
                plain, scene = (
                    stored(name, scene_text(packing, method, more, 10 * STEPS, options.scale))
                    for name, more in (("plain.toml", ""), ("effect.toml", lines))
                )
                low, median, high = ratios_of_times(options.program, plain, scene, options.repeats)
                print(
                    f"| {name} | {packing} | {count:.3f} | {median:.2f} | {low:.2f} to {high:.2f} |"
                    f" {bound or ''} |",
                    flush=True,
                )
    return 0


if __name__ == "__main__":
    sys.exit(main())
