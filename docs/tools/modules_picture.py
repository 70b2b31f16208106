#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Draw the modules and what they link as an SVG, from the list that CMake writes when it configures.

    modules_picture.py BUILD/modules.txt                 prints the picture
    modules_picture.py BUILD/modules.txt --check FILE    exits with 1 if FILE is another picture

A line of the list is a module and, behind a colon, the modules that its target links. A module stands
one row above the highest of them. A line of the picture that would only repeat a way over other
modules is left out.
"""
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


def places(links, row, n_sweeps=20):
    """Centres in x; each module near the mean of what it is joined to, so that lines cross little."""
    rows = [sorted(name for name in row if row[name] == k) for k in range(max(row.values()) + 1)]
    joined = {name: list(others) for name, others in links.items()}
    for name, others in links.items():
        for other in others:
            joined[other].append(name)
    width = max(len(names) for names in rows) * (BOX[0] + GAP)
    x = {}

    def spread(names):
        for k, name in enumerate(names):
            x[name] = width * (k + 0.5) / len(names)

    for names in rows:
        spread(names)
    for _ in range(n_sweeps):
        for names in rows:
            names.sort(key=lambda name: (sum(x[one] for one in joined[name]) /
                                         max(1, len(joined[name])), name))
            spread(names)
    return x, width


def svg(links):
    row = rows_of(links)
    shown = direct(links, everything_below(links))
    x, width = places(shown, row)
    top = max(row.values())

    def y(name):
        return (top - row[name]) * ROW + 8

    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} '
             f'{top * ROW + BOX[1] + 16}" font-family="sans-serif" font-size="13">',
             '<rect width="100%" height="100%" fill="white"/>']
    for name in sorted(shown):
        for other in shown[name]:
            a, b = y(name) + BOX[1], y(other)
            lines.append(f'<path d="M{x[name]:.0f} {a} C{x[name]:.0f} {a + 26} {x[other]:.0f} '
                         f'{b - 26} {x[other]:.0f} {b}" fill="none" stroke="#888"/>')
    for name in sorted(links):
        lines.append(f'<rect x="{x[name] - BOX[0] / 2:.0f}" y="{y(name)}" width="{BOX[0]}" '
                     f'height="{BOX[1]}" rx="4" fill="#eef3f8" stroke="#345"/>')
        lines.append(f'<text x="{x[name]:.0f}" y="{y(name) + 17}" text-anchor="middle">{name}'
                     '</text>')
    return "\n".join(lines + ["</svg>"]) + "\n"


def main():
    picture = svg(read(sys.argv[1]))
    if len(sys.argv) < 4:
        sys.stdout.write(picture)
        return 0
    if Path(sys.argv[3]).read_text() == picture:
        return 0
    print(f"{sys.argv[3]} is not the picture of the modules as they are linked; try: python3 "
          f"docs/tools/modules_picture.py {sys.argv[1]} > {sys.argv[3]}")
    return 1


if __name__ == "__main__":
    sys.exit(main())
