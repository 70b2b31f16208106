#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Check that measured numbers on pages have a source, so that a reader can repeat them.

    numbers.py SOURCE_FOLDER

The pages are those of words.py. A section, from one heading to the next, needs a source if its text
has a number with a unit of time, speed or memory, a percentage, or an error behind plus or minus.
Its source is one of these:

  - a block of code, which shows the command; tests run it and compare what it prints,
  - the name of a file in docs/data or tests, or of a tool in docs/tools,
  - a part between markers `<!-- NAME -->` and `<!-- end of NAME -->`, which a command writes,
  - a machine and a date, as in "an AMD EPYC, November 2026", in the section or in the page's head.

It prints each section without a source, and exits with 1 if there is one.
"""
import re
import sys
from pathlib import Path

from words import pages, readable

UNITS = ("s|ms|µs|ns|seconds?|minutes?|min|hours|core-minutes|core-seconds|million|GB/s|MB/s|bytes|"
         "kB|MB|GB|instructions|times as (?:long|fast|slow|large)")
MEASURED = re.compile(rf"(?<![\w.])\d[\d,.]*\s*(?:%|(?:{UNITS})\b)|(?:±|\+-)\s*\d", re.M)
FILE = r"\b(?:docs/tools|data|tests)/|\w\.(?:csv|json|py|cpp)\b|\bctest\b"
SOURCE = re.compile(rf"^ *```|{FILE}|<!-- end of", re.M)
MACHINE = re.compile(r"\b(?:EPYC|Xeon|Debian|Ubuntu|QEMU)\b")
DATE = re.compile(r"\b20\d\d\b")

# Sections whose numbers are not measured: limits, keys of a scene, sizes of what is stored, and
# what follows from a formula beside it.
DEFINED = {
    "docs/how-to/field.md: How often kicks act",
    "docs/lessons/effects.md: Restitution: a gas cools and clusters",
    "docs/lessons/method-and-step.md: Try yourself",
    "docs/reference/effects.md: Rules of effects",
    "docs/reference/exit-codes.md: Exit codes",
    "docs/reference/formats.md: Parallel file systems",
    "docs/reference/library.md: Scenes",
    "docs/understanding/accuracy.md: Letting the program choose",
    "docs/understanding/architecture.md: Classes of users and of the code",
    "docs/understanding/pressure.md: Energy that jumps at syncs",
}


def sections(text):
    """(line, title, text) of each part of a page from one heading to the next."""
    start, title, lines, is_code = 1, "", [], False
    for number, line in enumerate(text.splitlines(), 1):
        is_code ^= line.lstrip().startswith("```")
        if line.startswith("#") and not is_code:
            yield start, title, "\n".join(lines)
            start, title, lines = number, line.strip("# "), []
        lines.append(line)
    yield start, title, "\n".join(lines)


def has_machine_and_date(text):
    return bool(MACHINE.search(text) and DATE.search(text))


def findings_in(name, text):
    """Each section that has a measured number and no source, and how many sections have numbers."""
    n_sections = 0
    findings = []
    parts = list(sections(text))
    is_dated = any(has_machine_and_date(part) for _, _, part in parts[:2])  # the page's head
    for start, title, part in parts:
        measured = MEASURED.search(readable(part))
        n_sections += measured is not None
        has_source = SOURCE.search(part) or is_dated or has_machine_and_date(part)
        if measured and not has_source and f"{name}: {title}" not in DEFINED:
            number = " ".join(measured.group().split())
            findings.append(f"{name}:{start}: '{title}' has {number} and no source; try: name a "
                            "file, a command, or a machine and a date")
    return findings, n_sections


def main(top):
    findings, n_sections = [], 0
    names = pages(top)
    for name in names:
        new_findings, found = findings_in(name, (top / name).read_text(encoding="utf-8"))
        findings += new_findings
        n_sections += found
    if n_sections < 40:
        findings.append(f"only {n_sections} sections with numbers found: a wrong folder?")
    print(*findings, sep="\n")
    print(f"{len(names)} pages, {n_sections} sections with measured numbers")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
