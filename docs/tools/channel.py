#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Flows between thermal walls held to Enskog's viscosity: docs/validation/channel.csv.

  docs/tools/channel.py CARROM FOLDER     a core-minute; needs numpy and h5py

Couette: walls slide against each other, and the stress over the slope of the mean velocity is the
viscosity. Poiseuille: gravity drives the gas along walls at rest; the mean velocity has the curvature
n m g / viscosity. Slope, curvature, density and temperature are those of the middle seven tenths of
the channel, where walls are not felt. The stress is that of the whole box times H / (H - 2 r), because the layers of a radius at
the walls carry it by collisions with walls, which the pressure tensor leaves out. Errors are those of
ten parts of a run.
"""
import csv
import math
import os
import pathlib
import sys
import tempfile

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "src/python"))
LENGTH, SIZE, TEMPERATURE, PARTS = 120, 40, 0.01, 10


def enskog_viscosity(packing):
    """Gass, J. Chem. Phys. 54, 1898 (1971), m = kT = diameter = 1."""
    chi, bn = (1 - 7 * packing / 16) / (1 - packing) ** 2, 2 * packing
    return 1.022 / (2 * math.sqrt(math.pi)) * (1 / chi + bn + 0.8729 * chi * bn**2)


def scene_of(packing, sliding, gravity, steps):
    wall = {"kind": "thermal", "temperature": TEMPERATURE}
    scene = {
        "box": {"size": [LENGTH, SIZE], "left": {"kind": "periodic"}, "right": {"kind": "periodic"},
                "bottom": wall | {"velocity": -sliding}, "top": wall | {"velocity": sliding}},
        "discs": {"count": round(packing * LENGTH * SIZE * 4 / math.pi), "radius": 0.5,
                  "temperature": TEMPERATURE},
        "time": {"steps": steps, "method": "event-driven"},
        "output": {"averages_from_step": steps // 10,
                   "trajectory": {"every_steps": 50, "fields": ["position", "velocity"]}},
    }
    if gravity:
        scene["effects"] = {"gravity": {"x": gravity}}
    return scene


def middle_of(frames, degree):
    """Of frames: the last coefficient of the polynomial for vx, kT and density in the middle."""
    y = numpy.concatenate([frame.x[:, 1] for frame in frames]) - SIZE / 2
    v = numpy.concatenate([frame.v for frame in frames])
    inside = abs(y) < 0.35 * SIZE
    y, v = y[inside], v[inside]
    fit = numpy.polynomial.Polynomial.fit(y, v[:, 0], degree).convert()
    kt = (numpy.var(v[:, 0] - fit(y)) + numpy.var(v[:, 1])) / 2
    return fit.coef[degree], kt, len(y) / len(frames) / (0.7 * LENGTH * SIZE)


def measured(kind, packing, carrom, folder):
    thermal = math.sqrt(TEMPERATURE)
    sliding, gravity = (0.5 * thermal, 0) if kind == "couette" else (0, 0.005 * TEMPERATURE)
    run = carrom.run(scene_of(packing, sliding, gravity, 40_000), folder=folder)
    frames = list(run.frames)[80:]
    degree = 1 if kind == "couette" else 2
    parts = [middle_of(frames[k::1][: len(frames) // PARTS], degree)
             for k in range(0, len(frames) - len(frames) // PARTS + 1, len(frames) // PARTS)]
    coefficient, kt, density = numpy.mean(parts, axis=0)
    error = numpy.std([part[0] for part in parts], ddof=1) / math.sqrt(len(parts)) / abs(coefficient)
    if kind == "couette":
        stress = run.report["pressure_tensor"]["xy"]
        viscosity = -stress["value"] * SIZE / (SIZE - 1) / coefficient
        error = math.hypot(error, stress["error"] / stress["value"])
    else:
        viscosity = -density * gravity / (2 * coefficient)
    viscosity /= math.sqrt(kt)
    expected = enskog_viscosity(density * math.pi / 4)
    return (kind, density * math.pi / 4, kt / TEMPERATURE, viscosity, error * viscosity, expected,
            viscosity / expected)


def main():
    program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])
    os.environ["CARROM"] = str(program)
    import carrom  # pylint: disable=import-outside-toplevel

    with open(folder / "channel.csv", "w", encoding="utf-8", newline="") as file, \
            tempfile.TemporaryDirectory() as runs:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow("flow packing kT_over_walls viscosity error enskog ratio".split())
        for kind in ("couette", "poiseuille"):
            for packing in (0.1, 0.2, 0.3):
                row = measured(kind, packing, carrom, f"{runs}/{kind}_{packing}")
                writer.writerow([row[0], *(f"{value:.4g}" for value in row[1:])])
                file.flush()
                print(*row, flush=True)


if __name__ == "__main__":
    main()
