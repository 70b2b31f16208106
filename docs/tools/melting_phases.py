#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draws 128^2 discs in the liquid and in the solid, side by side: docs/data/validation/melting_phases.png.

  docs/tools/melting_phases.py CARROM PICTURE     some 2 core-minutes; needs the package of src/python

Both begin from a crystal. The colour is the real part of psi6 of each disc, turned by the mean.
"""
import argparse
import math

import matplotlib

matplotlib.use("Agg")
import carrom
import carrom.plot
import matplotlib.pyplot as plt
import numpy as np

SIDES = ("left", "right", "bottom", "top")


def last_frame(program, packing, steps=16_000):
    """The last frame of a run that begins from a crystal."""
    width = 128 * math.sqrt(math.pi / (2 * math.sqrt(3) * packing))
    scene = {
        "box": {"size": [width, width * math.sqrt(3) / 2]} | {side: {"kind": "periodic"} for side in SIDES},
        "discs": {"count": 128**2, "packing": packing, "generator": "triangular", "speed": 0.07, "seed": 1},
        "time": {"steps": steps, "method": "event-driven"},
        "output": {"trajectory": {"every_steps": steps, "fields": ["position", "psi6"]}},
    }
    return carrom.run(scene, program=program, threads=1).frames[-1]


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("program", metavar="CARROM")
    parser.add_argument("picture", metavar="PICTURE")
    options = parser.parse_args()
    figure, axes = plt.subplots(1, 2, figsize=(9.6, 4.2), layout="constrained")
    for ax, packing, name in zip(axes, (0.69, 0.73), ("liquid", "solid")):
        frame = last_frame(options.program, packing)
        psi6 = frame.psi6
        mean = psi6.mean()
        colour = (psi6 * np.conj(mean) / abs(mean)).real
        carrom.plot.frame(frame, colour=colour, label="Re psi6", cmap="coolwarm", limits=(-1, 1), bar=ax is axes[1], ax=ax)
        ax.set_title(f"{name}, packing {packing}: |mean of psi6| = {abs(mean):.2f}", fontsize="medium")
    figure.savefig(options.picture, dpi=100)


if __name__ == "__main__":
    main()
