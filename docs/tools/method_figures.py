#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draw the figures of docs/understanding/method.md into docs/pictures.

  docs/tools/method_figures.py [--output docs/pictures]

Everything drawn is computed here: places at random with a fixed seed, the chain of
docs/examples/three_strips.toml, and rods on a line that collide by the event-driven method.
Needs the Python environment of docs/tools/README.md.
"""
import argparse
import pathlib
import random

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.patches import Circle, FancyArrowPatch, Rectangle

import three_strips

STRIP = ["#4477aa", "#ccbb44", "#228833"]
OWN, RING, HALO, UNSEEN = "#dbe7f3", "#f5e9b8", "#ececec", "white"
KEPT, STRUCK = "#228833", "#cc3311"


def save(figure, folder, name):
    figure.savefig(folder / name, metadata={"Date": None})
    plt.close(figure)


def random_places(n, size, radius, seed):
    source, places = random.Random(seed), []
    while len(places) < n:
        x, y = (source.uniform(radius, size - radius) for _ in range(2))
        if all((x - a) ** 2 + (y - b) ** 2 > 4.4 * radius**2 for a, b in places):
            places.append((x, y))
    return places


def strips_and_halos(folder):
    size, radius, reach, cuts = 12.0, 0.32, 1.3, (4.0, 8.0)
    figure, axes = plt.subplots(figsize=(6.4, 5.2), layout="constrained")
    for low, high in ((cuts[0] - reach, cuts[0]), (cuts[1], cuts[1] + reach)):
        axes.add_patch(Rectangle((low, 0), high - low, size, color="#e8e8e8", linewidth=0))
    for x, y in random_places(75, size, radius, 4):
        strip = sum(x >= cut for cut in cuts)
        is_halo = strip != 1 and cuts[0] - reach <= x <= cuts[1] + reach
        axes.add_patch(Circle((x, y), radius, facecolor=STRIP[strip], alpha=1 if strip == 1 or is_halo else 0.35,
                              edgecolor="black", linewidth=1.3 if is_halo else 0))
    for cut in cuts:
        axes.axvline(cut, color="black", linewidth=1.5)
    for rank, middle in enumerate((2, 6, 10)):
        axes.text(middle, size + 0.25, f"rank {rank}", ha="center")
    for x in (cuts[0] - reach, cuts[1]):
        axes.annotate("", (x, -0.45), (x + reach, -0.45), arrowprops={"arrowstyle": "<->"}, annotation_clip=False)
        axes.text(x + reach / 2, -1.15, "reach", ha="center", fontsize=9)
    axes.text(6, -1.15, "grey: halo of rank 1", ha="center", fontsize=9)
    axes.set(xlim=(0, size), ylim=(0, size), aspect="equal", xticks=[], yticks=[])
    save(figure, folder, "strips_and_halos.svg")


def domains_and_halos(folder):
    """Seven ranks in groups of two, two and three; the halo of the middle rank of the last group."""
    size, radius, depth, cuts = 12.0, 0.32, 1.3, (3.4, 6.8)
    groups, chosen = ((6.9,), (4.6,), (3.6, 7.9)), 5
    colours = [STRIP[k] for k in (1, 0, 0, 2, 2, 1, 0)]  # neighbours differ
    domains = []
    for strip, across in enumerate(groups):
        x = ((0.0,) + cuts + (size,))[strip : strip + 2]
        ys = (0.0,) + across + (size,)
        domains += [(x[0], x[1], low, high) for low, high in zip(ys, ys[1:])]

    def owner(x, y):
        return next(k for k, (a, b, c, d) in enumerate(domains) if a <= x < b and c <= y < d)

    labels = [(a + 0.9, c + 0.25) for a, _, c, _ in domains]

    def hides_label(x, y):
        return any(abs(x - a) < 0.65 + radius and -radius - 0.1 < y - b < 0.35 + radius for a, b in labels)

    figure, axes = plt.subplots(figsize=(6.4, 5.2), layout="constrained")
    left, right, low, high = domains[chosen]
    axes.add_patch(Rectangle((left - depth, low - depth), size - left + depth, high - low + 2 * depth, color="#e8e8e8", linewidth=0))
    axes.add_patch(Rectangle((left, low), right - left, high - low, color="white", linewidth=0))
    for x, y in random_places(85, size, radius, 4):
        if hides_label(x, y):
            continue
        rank = owner(x, y)
        is_halo = rank != chosen and x >= left - depth and low - depth <= y <= high + depth
        axes.add_patch(Circle((x, y), radius, facecolor=colours[rank], alpha=1 if rank == chosen or is_halo else 0.35,
                              edgecolor="black", linewidth=1.3 if is_halo else 0))
    for rank, (a, b, c, d) in enumerate(domains):
        axes.add_patch(Rectangle((a, c), b - a, d - c, fill=False, linewidth=1.5, edgecolor="black"))
        axes.text(*labels[rank], f"rank {rank}", ha="center", fontsize=9)
    axes.text(size / 2, -1.0, f"grey: halo of rank {chosen}", ha="center", fontsize=9)
    axes.set(xlim=(0, size), ylim=(0, size), aspect="equal", xticks=[], yticks=[])
    save(figure, folder, "domains_and_halos.svg")


def conflict_chain(folder):
    radius, discs = three_strips.read_scene()
    ordered = three_strips.candidates(radius, discs)
    kept = three_strips.walk(ordered)
    decided, _ = three_strips.play(discs, ordered)
    figure, axes = plt.subplots(figsize=(7.6, 3.4), layout="constrained")
    for number, disc in enumerate(discs):
        axes.add_patch(Circle(disc[:2], radius, facecolor=STRIP[three_strips.owner(disc)], edgecolor="black"))
        axes.text(disc[0], disc[1], str(number), ha="center", va="center", color="white", fontweight="bold")
        axes.annotate("", (disc[0] + disc[2] * 0.8, 2.42), (disc[0], 2.42), arrowprops={"arrowstyle": "->"})
    for candidate in ordered:
        time, p, q = candidate
        is_kept = candidate in kept
        colour = KEPT if is_kept else STRUCK
        axes.add_patch(FancyArrowPatch((discs[p][0], 3.4), (discs[q][0], 3.4), connectionstyle="arc3,rad=-0.6", arrowstyle="-",
                                       color=colour, linewidth=2, linestyle="-" if is_kept else "--"))
        middle = (discs[p][0] + discs[q][0]) / 2
        when = f"message {decided[candidate]}" if decided[candidate] else "at once"
        axes.text(middle, 3.78, f"t = {time:g}\n{'kept' if is_kept else 'struck'}\n{when}", ha="center", va="bottom", color=colour, fontsize=9)
    for cut in three_strips.CUTS:
        axes.axvline(cut, ymax=0.52, color="black", linewidth=1.5, zorder=0)  # behind the discs and their numbers
    for rank, middle in enumerate((1, 3, 5)):
        axes.text(middle, 1.95, f"rank {rank}", ha="center")
    axes.set(xlim=(0, 6), ylim=(1.8, 4.6), aspect="equal", xticks=[], yticks=[])
    save(figure, folder, "conflict_chain.svg")


def rods(places, velocities, length, end):
    """Paths of equal rods on a line, [(time, place), ...] each, and the contacts (time, rod, rod + 1)."""
    places, velocities = list(places), list(velocities)
    paths, contacts, now = [[(0.0, x)] for x in places], [], 0.0
    while True:
        first = None
        for k in range(len(places) - 1):
            closing = velocities[k] - velocities[k + 1]
            if closing <= 1e-12:
                continue
            time = now + max(0.0, places[k + 1] - places[k] - length) / closing
            if first is None or time < first[0]:
                first = (time, k)
        if first is None or first[0] > end:
            break
        time, k = first
        places = [x + v * (time - now) for x, v in zip(places, velocities)]
        velocities[k], velocities[k + 1] = velocities[k + 1], velocities[k]
        now = time
        for other in (k, k + 1):
            paths[other].append((time, places[other]))
        contacts.append((time, k))
    for path, x, v in zip(paths, places, velocities):
        path.append((end, x + v * (end - now)))
    return paths, contacts


def block_window(folder):
    source = random.Random(3)
    length, end, fastest = 0.2, 1.0, 0.5
    reach = length + 2 * fastest * end
    places, x = [], -5.6
    while x < 5.6:
        places.append(x)
        x += length + source.uniform(0.03, 0.3)
    velocities = [source.uniform(-fastest, fastest) for _ in places]
    paths, contacts = rods(places, velocities, length, end)
    block = 1.2
    figure, axes = plt.subplots(figsize=(8.4, 4.2), layout="constrained")
    for low, high, colour in ((-block, block, OWN), (-block - reach, -block, RING), (block, block + reach, RING),
                              (-block - 2 * reach, -block - reach, HALO), (block + reach, block + 2 * reach, HALO)):
        axes.add_patch(Rectangle((low, 0), high - low, end, color=colour, linewidth=0, zorder=0))
    ring = [k for k, place in enumerate(places) if block < place < block + reach]
    chosen = max(ring, key=lambda k: sum(k in (rod, rod + 1) for _, rod in contacts))
    for number, path in enumerate(paths):
        is_seen = abs(places[number]) < block + 2 * reach
        colour = "#cc3311" if number == chosen else "black" if is_seen else "0.75"
        axes.plot([x for _, x in path], [t for t, _ in path], color=colour, linewidth=2.4 if number == chosen else 0.9)
    for time, k in contacts:
        place = [x for t, x in paths[k] if t == time][0] + length / 2
        axes.plot([place], [time], "o", color="black", markersize=3)
    times = [time for time, k in contacts if chosen in (k, k + 1)]
    beside = axes.secondary_yaxis("right")  # where no line of a disc runs through the numbers
    beside.set_yticks(times, [f"{time:.2f}" for time in times], color="#cc3311")
    beside.tick_params(color="#cc3311")
    for middle, text in ((0, "own"), (-block - reach / 2, "ring"), (block + reach / 2, "ring"), (-block - 1.5 * reach, "rest of the halo"),
                         (block + 1.5 * reach, "rest of the halo")):
        axes.text(middle, end + 0.03, text, ha="center", fontsize=10)
    axes.annotate("", (block, -0.06), (block + reach, -0.06), arrowprops={"arrowstyle": "<->"}, annotation_clip=False)
    axes.text(block + reach / 2, -0.15, "one reach", ha="center", fontsize=9)
    axes.text(-block - reach / 2, -0.15, "red: a ring disc, and the times of its event history", ha="center", fontsize=9, color="#cc3311")
    axes.set(xlim=(-block - 2 * reach - 0.4, block + 2 * reach + 0.4), ylim=(0, end), xticks=[], yticks=[0, end], yticklabels=["s", "end"], ylabel="time")
    save(figure, folder, "block_window.svg")


def unseen_blow(folder):
    """The scene of tests/mpi/event_driven/simpler_rule_test.cpp for a halo of two reaches."""
    speed, halo, edge = 0.0625, 2, 6.0
    reach = 1 + 2 * 1.08 * speed
    striker = edge + halo * reach + 0.0078125
    row = [striker - 1.03125 - (halo - k) for k in range(halo + 1)]
    figure, (before, after) = plt.subplots(2, 1, figsize=(7.2, 3.9), layout="constrained")
    for axes, title in ((before, "what the block sees at the window's start"), (after, "the truth: the blow passes through the row at once")):
        for low, high, colour, text in ((4.4, edge, OWN, "own"), (edge, edge + reach, RING, "ring"), (edge + reach, edge + halo * reach, HALO, "rest of the halo"),
                                        (edge + halo * reach, 10, UNSEEN, "not seen")):
            axes.add_patch(Rectangle((low, -1), high - low, 2, facecolor=colour, linewidth=0))
            axes.text((low + high) / 2, -0.9, text, ha="center", fontsize=9)
        axes.axvline(edge, color="black", linewidth=1.5)
        axes.axvline(edge + halo * reach, color="0.5", linewidth=1, linestyle="--")
        axes.set(xlim=(4.4, 10), ylim=(-1, 0.85), aspect="equal", xticks=[], yticks=[])
        axes.set_title(title, fontsize=10)
    for place in row:
        before.add_patch(Circle((place, 0), 0.5, facecolor=STRIP[0], edgecolor="black"))
        after.add_patch(Circle((place, 0), 0.5, facecolor=STRIP[0], edgecolor="black"))
    before.add_patch(Circle((striker, 0), 0.5, facecolor="white", edgecolor="0.5", linestyle="--"))
    after.add_patch(Circle((striker - 0.03125, 0), 0.5, facecolor=STRIP[1], edgecolor="black"))
    for left, right in zip(row, row[1:] + [striker - 0.03125]):
        after.plot([(left + right) / 2], [0], "*", color=STRUCK, markersize=11)
    after.annotate("", (row[0] - 0.95, 0), (row[0] - 0.2, 0), arrowprops={"arrowstyle": "->", "linewidth": 2, "color": STRUCK})
    before.annotate("", (striker - 0.42, 0), (striker + 0.4, 0), arrowprops={"arrowstyle": "->", "color": "0.5"})
    save(figure, folder, "unseen_blow.svg")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--output", type=pathlib.Path, default=three_strips.FOLDER / "pictures")
    options = parser.parse_args()
    plt.rcParams.update({"svg.hashsalt": "carrom", "svg.fonttype": "path"})
    for draw in (strips_and_halos, domains_and_halos, conflict_chain, block_window, unseen_blow):
        draw(options.output)


if __name__ == "__main__":
    main()
