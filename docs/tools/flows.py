#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Run scenes of driven discs, and draw discs beside a profile and what theory says of it.

  build/python/bin/python docs/tools/flows.py build/carrom [NAME ...] [--output docs/pictures]

NAME is heated, shear, sheared, channel, belt, polydisperse or active. Together they take three
minutes.
"""
import os
import pathlib
import sys
import tempfile

import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

TOP = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "src/python"))
import carrom
from effects import options_of, shrink

WIDTH, DOTS = 9.6, 100 # inches, and dots in an inch
BLUE, RED, GREY = "#0060b0", "#c03020", "#888888"


def contact_value(packing):
    return (1 - 7 * packing / 16) / (1 - packing) ** 2


def enskog(packing, kt):
    """Viscosity of discs of diameter and mass 1: Gass, J. Chem. Phys. 54, 1898 (1971)."""
    chi, bn = contact_value(packing), 2 * packing
    return 0.511 * np.sqrt(kt / np.pi) * (1 / chi + bn + 0.8729 * chi * bn ** 2)


def run(name, folder, steps, quantities=(), **settings):
    """The scene of inputs/ with frames of these steps."""
    measurements = {f"output__measurements__{key}": value for key, value in settings.items()}
    if quantities:
        measurements["output__measurements__quantities"] = list(quantities)
    if "psi6" in quantities:
        measurements["output__trajectory__fields"] = ["position", "velocity", "neighbours"]
    return carrom.run(TOP / "inputs" / f"{name}.toml", steps=steps[-1], folder=folder / name,
                      progress=False, output__trajectory__every_steps=steps[0], **measurements)


def layers(run, steps, n, height, width=1):
    """Mean vx in layers over frames of these steps."""
    frames = [frame for frame in run.frames if frame.step in steps]
    y = np.concatenate([frame.x[:, 1] for frame in frames])
    vx = np.concatenate([frame.v[:, 0] for frame in frames])
    edges = np.linspace(0, height, n + 1)
    number = np.histogram(y, edges)[0]
    mean = np.histogram(y, edges, weights=vx)[0] / number
    return (edges[1:] + edges[:-1]) / 2, mean, number / (len(frames) * width * height / n)


def beside(ratio=(1.25, 1), height=4.4):
    figure = plt.figure(figsize=(WIDTH, height), layout="constrained")
    figure.get_layout_engine().set(wspace=0.06)
    return figure, *figure.subplots(1, 2, width_ratios=ratio)


def below(height):
    figure = plt.figure(figsize=(WIDTH, height), layout="constrained")
    parts = figure.subfigures(2, 1, height_ratios=(1, 0.95))
    return figure, parts[0].subplots(), parts[1]


def heated(folder):
    """kT about the mean falls to where kicks and collisions balance."""
    result = run("heated", folder, [500, 2000], ["thermo"], every_steps=10)
    figure, discs, right = beside()
    carrom.plot.frame(result, 2000, ax=discs, view=(0, 0, 100, 100))
    thermo = result.tables["thermo"]
    right.plot(thermo["step"], thermo["temperature"], color=BLUE, label="run")
    size, count, packing, e = 400, 10_000, 0.05, 0.8
    sigma = 2 * np.sqrt(packing * size**2 / (count * np.pi))
    loss = (1 - e**2) * count / size**2 * sigma * contact_value(packing) * np.sqrt(np.pi)
    right.axhline((0.006 / loss) ** (2 / 3), color="black", linewidth=1, linestyle="--",
                  label="kinetic theory of thin gases")
    steps = np.linspace(0, 2000, 200)
    right.plot(steps, 0.5 / (1 + loss * np.sqrt(0.5) / 2 * steps) ** 2, color=GREY,
               label="without kicks (Haff's law)")
    right.set(xlabel="step", ylabel="kT", ylim=(0, None))
    right.legend()
    return figure


def shear(folder):
    """The step of the velocity spreads."""
    result = run("shear", folder, [100, 600])
    figure, discs, right = beside()
    carrom.plot.frame(result, 600, ax=discs, view=(0, 100, 100, 200), colour="vx")
    for step, colour in ((0, GREY), (100, "#6090d0"), (300, BLUE), (600, RED)):
        y, mean, _ = layers(result, [step], 60, 300)
        right.plot(mean, y, color=colour, label=f"step {step}")
    right.set(xlabel="mean vx", ylabel="y", ylim=(0, 300))
    right.legend()
    return figure


def sheared(folder):
    """Over the whole box, with discs drawn four times as large, because it is thin."""
    result = run("sheared", folder, [200, 10_000])
    figure, discs, right = beside()
    last = result.frames.at(10_000)
    marks = discs.scatter(*last.x.T, s=9, c=last.v[:, 0], cmap="coolwarm", vmin=-0.5, vmax=0.5,
                          linewidths=0)
    discs.set(xlim=(0, 396.3), ylim=(0, 396.3), aspect="equal", xlabel="x", ylabel="y",
              title="step 10000, discs drawn four times as large")
    figure.colorbar(marks, ax=discs, label="velocity along x (lengths per step)", shrink=0.9)
    y, mean, _ = layers(result, range(2000, 10_001), 20, 396.3)
    right.plot(mean, y, "o", color=BLUE, markersize=5, label="steps 2000 to 10000")
    ends = np.array([0, 396.3])
    right.plot(0.0021774 * (ends - 396.3 / 2), ends, color="black", linewidth=1,
               label="rate (y - Ly/2)")
    right.set(xlabel="mean vx", ylabel="y", ylim=(0, 396.3))
    right.legend()
    return figure


def channel(folder):
    """A parabola with Enskog's curvature, through the maximum of the measured profile."""
    result = run("channel", folder, [50, 10_000])
    figure, discs, lower = below(6.2)
    carrom.plot.frame(result, 10_000, ax=discs, colour="vx", fastest=0.3)
    left, right = lower.subplots(1, 2)
    y, mean, density = layers(result, range(4000, 10_001), 40, 40, 160)
    left.plot(y, mean, "o", color=BLUE, markersize=4, label="steps 4000 to 10000")
    inside = abs(y - 20) < 14
    n = np.mean(density[inside])
    kt = np.mean([np.var(frame.v[abs(frame.x[:, 1] - 20) < 14, 1]) for frame in result.frames
                  if frame.step >= 4000])
    bend = n * 7e-5 / enskog(n * np.pi / 4, kt)
    top = np.mean(mean[inside] + bend / 2 * (y[inside] - 20) ** 2)
    left.plot(y, top - bend / 2 * (y - 20) ** 2, color="black", linewidth=1,
              label="curvature of Enskog's viscosity")
    left.set(xlabel="y", ylabel="mean vx", ylim=(0, None))
    left.legend(loc="lower center")
    right.plot(y, density, "o", color=RED, markersize=4)
    right.set(xlabel="y", ylabel="discs per area", ylim=(0, None))
    return figure


def belt(folder):
    """Discs by their spin; the flow and the density of the last quarter of the run."""
    result = run("belt", folder, [20, 2000])
    figure, discs, lower = below(6.2)
    carrom.plot.frame(result.folder, 2000, ax=discs, colour="spin", fastest=0.2)
    left, right = lower.subplots(1, 2)
    y, mean, density = layers(result, range(1500, 2001), 30, 30, 120)
    left.plot(y, mean, "o-", color=BLUE, markersize=4)
    left.axhline(0, color=GREY, linewidth=0.8)
    left.set(xlabel="y", ylabel="mean vx (the belt: 0.5)")
    right.plot(y, density, "o-", color=RED, markersize=4)
    right.set(xlabel="y", ylabel="discs per area", ylim=(0, None))
    return figure


def polydisperse(folder):
    """Radii of a compressed packing, and the distribution that they follow."""
    result = run("polydisperse", folder, [200, 200], ["psi6"], every_steps=20)
    figure, discs, right = beside()
    frame = result.frames.at(200)
    carrom.plot.frame(result, 200, ax=discs, colour=frame.neighbours, limits=(3.5, 8.5),
                      cmap=matplotlib.colormaps["coolwarm"].resampled(5),
                      label="neighbours (radical tessellation)")
    radii = frame.radius / np.mean(frame.radius)
    right.hist(radii, 30, density=True, color="#a0c0e0", label="discs")
    s = np.sqrt(np.log(1 + 0.23**2))
    x = np.linspace(0.4, 2.1, 300)
    right.plot(x, np.exp(-(np.log(x) + s**2 / 2) ** 2 / (2 * s**2)) / (x * s * np.sqrt(2 * np.pi)),
               color="black", linewidth=1, label="lognormal, 23 %")
    right.set(xlabel="radius over the mean", ylabel="density of probability")
    right.legend()
    return figure


def active(folder):
    """Clusters whose discs push inwards, and how the density of cells spreads."""
    result = run("active", folder, [500, 6000])
    figure, discs, right = beside()
    carrom.plot.frame(result, 6000, ax=discs, colour="direction")
    for step, colour in ((0, GREY), (2000, "#6090d0"), (6000, BLUE)):
        shown = [frame for frame in result.frames if step - 1500 < frame.step <= step]
        counts = np.concatenate([np.histogram2d(*frame.x.T, bins=(12, 10),
                                                range=((0, 62), (0, 54)))[0].ravel()
                                 for frame in shown])
        packing = counts * np.pi * 0.50044**2 / (62 * 54 / 120)
        right.hist(packing, np.linspace(0, 1, 21), density=True, histtype="step", color=colour,
                   label=f"step {step}")
    right.set(xlabel="packing of a cell of 5 by 5 diameters", ylabel="density of probability")
    right.legend()
    return figure


def save_figures(text, pictures):
    """Saves the figures that functions of a folder return, by the words of the command line. `text`
    is the tool's own. Names are those of the files.
    """
    options = options_of(text)
    os.environ["CARROM"] = str(options.program.resolve())
    plt.rcParams["font.size"] = 10
    with tempfile.TemporaryDirectory() as folder:
        for name in options.names or pictures:
            picture = pathlib.Path(folder) / f"{name}.png"
            pictures[name](pathlib.Path(folder)).savefig(picture, dpi=DOTS)
            plt.close("all")
            shrink(picture, options.output / f"{name}.png", most_bytes=120_000)


PICTURES = {one.__name__: one for one in
            (heated, shear, sheared, channel, belt, polydisperse, active)}


if __name__ == "__main__":
    save_figures(__doc__, PICTURES)
