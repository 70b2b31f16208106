#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Run scenes in boxes that are no rectangles, and draw them.

  build/python/bin/python docs/tools/shapes.py build/carrom [NAME ...] [--output docs/pictures]

NAME is round, stadium or drum. Together they take some two minutes.
"""
import matplotlib.pyplot as plt
import numpy as np

from flows import BLUE, GREY, TOP, WIDTH, carrom, run, save_figures


def round_box(folder):
    """Discs by their speed, and the density by the distance from the centre."""
    result = run("round", folder, [20, 2000])
    figure = plt.figure(figsize=(WIDTH, 4.3), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=[1, 1.05])
    carrom.plot.frame(result, 2000, ax=left, bar=False)
    far = np.concatenate([np.hypot(*(frame.x - 50).T) for frame in result.frames[20:]])
    edges = np.append(np.linspace(0, 40, 9), np.linspace(40.2, 50, 50))
    area = np.pi * np.diff(edges**2) * len(result.frames[20:])
    right.plot((edges[1:] + edges[:-1]) / 2, np.histogram(far, edges)[0] / area, "o-", color=BLUE,
               markersize=3)
    right.axvline(50 - result.report["radius"], color=GREY, linewidth=0.8)
    right.set(xlabel="distance from the centre", ylabel="discs per area", ylim=(0, None), xlim=(30, 50))
    return figure


def stadium(folder):
    """Points at two steps, and those of a circle beside them."""
    result = run("stadium", folder, [50, 2000])
    circle = carrom.run(TOP / "inputs" / "stadium.toml", folder=folder / "circle", steps=2000,
                        progress=False, output__trajectory__every_steps=50, box__size=50,
                        box__shape="round", discs__region=[10, 24, 11, 25],
                        discs__streams=[{"region": [0, 0, 50, 50], "velocity": [0.8, 0.6]}])
    figure = plt.figure(figsize=(WIDTH, 4.6), layout="constrained")
    axes = figure.subplots(2, 2, width_ratios=[2, 1])
    for row, step in zip(axes, (100, 2000)):
        for ax, one in zip(row, (result, circle)):
            carrom.plot.frame(one, step, ax=ax, bar=False, colour="vx", magnify=3e6)
            ax.set_title(f"step {step}")
    return figure


def drum(folder):
    """The discs at the start and at the end, by spin."""
    result = run("drum", folder, [10, 1500])
    figure = plt.figure(figsize=(WIDTH, 4.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    carrom.plot.frame(result, 0, ax=left, colour="spin", fastest=0.2, bar=False)
    carrom.plot.frame(result, 1500, ax=right, colour="spin", fastest=0.2, bar=False)
    return figure


PICTURES = {"round": round_box, "stadium": stadium, "drum": drum}


if __name__ == "__main__":
    save_figures(__doc__, PICTURES)
