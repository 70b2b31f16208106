#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Work out the example of docs/understanding/method.md, section 7.4, and put its table there.

  docs/tools/three_strips.py [--program build/carrom] [--page docs/understanding/method.md]

Walks the sorted candidates of docs/examples/three_strips.toml, and plays the messages of three
ranks. Fails if the two differ. With --program it also runs the scene on three ranks ($MPIEXEC, else
mpiexec, starts them) and compares with the log of its collisions; that needs h5py.
"""
import argparse
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import tomllib

FOLDER = pathlib.Path(__file__).resolve().parent.parent
SCENE = FOLDER / "examples" / "three_strips.toml"
CUTS = (2.0, 4.0)


def read_scene():
    with open(SCENE, "rb") as file:
        scene = tomllib.load(file)
    return scene["discs"]["radius"], [tuple(map(float, row)) for row in scene["discs"]["list"]]


def contact_time(p, q, sigma):
    """Section 4.1 for two discs whose states are of time 0."""
    dx, dy, wx, wy = q[0] - p[0], q[1] - p[1], q[2] - p[2], q[3] - p[3]
    b = dx * wx + dy * wy
    reach, cross = math.hypot(wx, wy) * sigma, abs(dx * wy - dy * wx)
    disc = (reach - cross) * (reach + cross)
    if b >= 0 or disc <= 0:
        return None
    gap = math.hypot(dx, dy) - sigma
    return gap * (gap + 2 * sigma) / (-b + math.sqrt(disc))


def candidates(radius, discs):
    """(time, p, q) of one step in the total order. No disc comes to a wall."""
    found = []
    for p, first in enumerate(discs):
        for q in range(p + 1, len(discs)):
            time = contact_time(first, discs[q], 2 * radius)
            if time is not None and time <= 1:
                found.append((time, p, q))
    return sorted(found)


def walk(ordered):
    taken, kept = set(), []
    for candidate in ordered:
        if taken.isdisjoint(candidate[1:]):
            kept.append(candidate)
            taken.update(candidate[1:])
    return kept


def owner(disc):
    return sum(disc[0] >= cut for cut in CUTS)


class Rank:
    """What one rank knows: the candidates of its own discs."""

    def __init__(self, number, discs, ordered):
        self.own = {k for k, disc in enumerate(discs) if owner(disc) == number}
        self.undecided = [c for c in ordered if self.own & set(c[1:])]
        self.kept, self.taken = [], set()
        self.walk_own()

    def is_shared(self, candidate):
        return not self.own.issuperset(candidate[1:])

    def walk_own(self):
        """Section 7.1: keeps what depends on no other rank, strikes its rivals."""
        waiting, left = set(), []
        for candidate in self.undecided:
            pair = set(candidate[1:])
            if pair & self.taken:
                continue
            if self.is_shared(candidate) or pair & waiting:
                left.append(candidate)
                waiting |= pair
            else:
                self.kept.append(candidate)
                self.taken |= pair
        self.undecided = left

    def message(self):
        """Which shared candidates are left, and whether each comes first for the own disc."""
        seen, said = set(), {}
        for candidate in self.undecided:
            own = self.own & set(candidate[1:])
            if self.is_shared(candidate):
                said[candidate] = not own & seen
            seen |= own
        return said

    def hear(self, mine, others):
        for candidate, is_first in mine.items():
            if candidate not in others:
                self.undecided.remove(candidate)
            elif is_first and others[candidate]:
                self.undecided.remove(candidate)
                self.kept.append(candidate)
                self.taken |= set(candidate[1:])
        self.walk_own()


def play(discs, ordered):
    """The message round (0: none) in which each candidate is decided, and those kept."""
    ranks = [Rank(number, discs, ordered) for number in range(len(CUTS) + 1)]
    decided, rounds = {}, 0

    def note():
        for candidate in ordered:
            if not any(candidate in rank.undecided for rank in ranks):
                decided.setdefault(candidate, rounds)

    note()
    while any(rank.undecided for rank in ranks):
        rounds += 1
        said = [rank.message() for rank in ranks]
        for number, rank in enumerate(ranks):
            others = {}
            for beside in (number - 1, number + 1):
                if 0 <= beside < len(ranks):
                    others |= said[beside]
            rank.hear(said[number], others)
        note()
    return decided, sorted({candidate for rank in ranks for candidate in rank.kept})


def logged(program):
    """(time, p, q) of the pairs that a run on three ranks has collided."""
    import h5py

    with tempfile.TemporaryDirectory() as folder:
        command = [os.environ.get("MPIEXEC", "mpiexec"), "-n", "3", program, "run", str(SCENE), "-o", f"{folder}/run", "--set", "output.collisions=true"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        with h5py.File(f"{folder}/run/collisions.h5") as file:
            log = file["carrom/collisions"]
            return list(zip(*(log[name][:].tolist() for name in ("time", "p", "q"))))


def table(discs, ordered, kept, decided):
    lines = ["| time | pair | ranks | verdict | decided |", "|---|---|---|---|---|"]
    for candidate in ordered:
        time, p, q = candidate
        ranks = sorted({owner(discs[p]), owner(discs[q])})
        when = f"after message {decided[candidate]}" if decided[candidate] else "at once"
        lines.append(f"| {time:g} | ({p},{q}) | {' and '.join(map(str, ranks))} | {'kept' if candidate in kept else 'struck'} | {when} |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program")
    parser.add_argument("--page", type=pathlib.Path, default=FOLDER / "understanding" / "method.md")
    options = parser.parse_args()
    radius, discs = read_scene()
    ordered = candidates(radius, discs)
    kept = walk(ordered)
    decided, kept_by_ranks = play(discs, ordered)
    if kept != kept_by_ranks:
        sys.exit(f"the ranks keep {kept_by_ranks}, the sorted walk {kept}")
    if options.program and logged(options.program) != kept:
        sys.exit(f"the program's log is {logged(options.program)}, the sorted walk keeps {kept}")
    text = options.page.read_text(encoding="utf-8")
    begin, end = "<!-- three strips -->", "<!-- end of three strips -->"
    first, last = text.index(begin) + len(begin), text.index(end)
    options.page.write_text(text[:first] + "\n" + table(discs, ordered, kept, decided) + "\n" + text[last:], encoding="utf-8")


if __name__ == "__main__":
    main()
