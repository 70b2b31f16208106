#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draw the modules and what they link as an SVG, from the list that CMake writes when it configures.

    modules_picture.py BUILD/modules.txt                 prints the picture
    modules_picture.py BUILD/modules.txt --check FILE    exits with 1 if FILE is another picture

A line of the list is a module and, behind a colon, the modules that its target links. A module stands
one row above the highest of them. A line of the picture that would only repeat a way over other
modules is left out.
"""
import argparse
import sys
from pathlib import Path

BOX, ROW, GAP = (112, 26), 66, 18


def read(path):
    links = {}
    for line in Path(path).read_text().splitlines():
        name, others = line.split(":")
        links[name] = sorted(set(others.split()))
    return links


def everything_below(links):
    """Each module's links, and theirs, and so on."""
    below = {}

    def of(name):
        if name not in below:
            below[name] = set(links[name]).union(*(of(other) for other in links[name]))
        return below[name]

    for name in links:
        of(name)
    return below


def rows_of(links):
    row = {}

    def of(name):
        if name not in row:
            row[name] = 1 + max((of(other) for other in links[name]), default=-1)
        return row[name]

    for name in links:
        of(name)
    return row


def direct(links, below):
    """Links that no other link of the module implies."""
    return {name: [one for one in others
                   if not any(one in below[other] for other in others)]
            for name, others in links.items()}


def with_bends(shown, row):
    """The rows of the picture and the ways through them.

    A line to a module that is not in the next row has a bend, (from, to, row), in each row between,
    so that it passes beside the boxes and not behind them.
    """
    rows = [sorted(name for name in row if row[name] == k) for k in range(max(row.values()) + 1)]
    ways = []
    for name in sorted(shown):
        for other in shown[name]:
            bends = [(name, other, k) for k in range(row[name] - 1, row[other], -1)]
            for bend in bends:
                rows[bend[2]].append(bend)
            ways.append([name, *bends, other])
    return rows, ways


def places(rows, ways, n_sweeps=20):
    """Centres in x; each module near the mean of what it is joined to, so that lines cross little."""
    joined = {name: [] for names in rows for name in names}
    for way in ways:
        for one, next_one in zip(way, way[1:]):
            joined[one].append(next_one)
            joined[next_one].append(one)

    def room(name):
        return GAP + (BOX[0] if isinstance(name, str) else 0)

    width = max(sum(map(room, names)) for names in rows)
    x = {}

    def spread(names):
        spare, left = (width - sum(map(room, names))) / len(names), 0
        for name in names:
            x[name] = left + (room(name) + spare) / 2
            left += room(name) + spare

    for names in rows:
        spread(names)
    for _ in range(n_sweeps):
        for names in rows:
            names.sort(key=lambda name: (sum(x[one] for one in joined[name]) /
                                         max(1, len(joined[name])), str(name)))
            spread(names)
    return x, width


def svg(links):
    row = rows_of(links)
    rows, ways = with_bends(direct(links, everything_below(links)), row)
    x, width = places(rows, ways)
    top = max(row.values())

    def y(name):
        return (top - (row[name] if isinstance(name, str) else name[2])) * ROW + 8

    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} '
             f'{top * ROW + BOX[1] + 16}" font-family="sans-serif" font-size="13">',
             '<rect width="100%" height="100%" fill="white"/>']
    for way in ways:
        path = f"M{x[way[0]]:.0f} {y(way[0])}"
        for one, next_one in zip(way, way[1:]):
            a, b = y(one) + BOX[1], y(next_one)
            path += (f" V{a} C{x[one]:.0f} {a + 26} {x[next_one]:.0f} {b - 26} "
                     f"{x[next_one]:.0f} {b}")
        lines.append(f'<path d="{path}" fill="none" stroke="#888"/>')
    for name in sorted(links):
        lines.append(f'<rect x="{x[name] - BOX[0] / 2:.0f}" y="{y(name)}" width="{BOX[0]}" '
                     f'height="{BOX[1]}" rx="4" fill="#eef3f8" stroke="#345"/>')
        lines.append(f'<text x="{x[name]:.0f}" y="{y(name) + 17}" text-anchor="middle">{name}'
                     '</text>')
    return "\n".join(lines + ["</svg>"]) + "\n"


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("modules", help="the list that CMake has written")
    parser.add_argument("--check", metavar="FILE")
    options = parser.parse_args()
    picture = svg(read(options.modules))
    if not options.check:
        sys.stdout.write(picture)
        return 0
    if Path(options.check).read_text() == picture:
        return 0
    print(f"{options.check} is not the picture of the modules as they are linked; try: "
          f"docs/tools/modules_picture.py {options.modules} > {options.check}")
    return 1


if __name__ == "__main__":
    sys.exit(main())
