# SPDX-License-Identifier: BSD-3-Clause
"""Write the fault table of docs/understanding/hard-cases.md from what tests have done.

    ctest --test-dir build -C long -L faults --output-junit faults.xml \\
        --test-output-size-passed 1000000
    python3 docs/tools/fault_table.py build build/faults.xml docs/understanding/hard-cases.md

Only tests that the XML file names get a row, with the outcome that it gives them. Trials are
counted by the tests themselves, those of damaged bytes in `trials.csv`.
"""

from __future__ import annotations

import csv
import re
import sys
import xml.etree.ElementTree as tree
from collections import Counter
from pathlib import Path

BEGIN, END = "<!-- faults: made by docs/tools/fault_table.py -->\n", "<!-- end of faults -->\n"
RUNS = r"(\d+) runs of the program"
PYTEST = r"(\d+) passed"
WATCH = r"Ran (\d+) tests"
FAULTS = {  # of a test: what it does, and how its output counts that
    "kill": ("kill -9 of a rank at a random moment", r"after (\d+) kills"),
    "kill_often": ("kill -9 of a rank at a random moment, more often", r"after (\d+) kills"),
    "nothing_lost": ("folders that cannot be listed, links, foreign files, gaps in a log", RUNS),
    "lost_places": ("a folder or a file that is moved, removed or replaced during a run", RUNS),
    "shared_places": ("two runs in one folder, links in the place of files", RUNS),
    "checkpoint_failure_all": ("full disks, short writes, no threads for a checkpoint", RUNS),
    "output_failure": ("outputs that cannot be written", RUNS),
    "destinations": ("outputs named as files of a run, of replicas, or of another kind", RUNS),
    "special_files": ("pipes and sockets in the place of files, texts nested without end", RUNS),
    "damaged_files": ("any range of a file's bytes overwritten, heaps on which HDF5 loops", RUNS),
    "sizes": ("radii from the tails of a distribution, and from narrow ones", RUNS),
    "machine_limits": ("limits and settings for which OpenMP or MPI ends a program", RUNS),
    "compare": ("wrong lines of students, numbers that no run has", RUNS),
    "python_sweeps": ("two sweeps in one folder, sweeps that are stopped", PYTEST),
    "python_forged": ("forged and damaged files, numbers kept in files of others", PYTEST),
    "watch": ("idle and wrong connections, clients that go, hostile files for the watch server", WATCH),
}
GROUPS = {  # tests whose names begin so: what they do together
    "one rank leaves: ": "one rank of three returns, or throws an error",
    "MPI ends before its session: ": "a program ends MPI before the library's session",
}
DAMAGED = ("every_byte_sample", "every_byte_bytes", "every_byte_bits")


def outcomes(junit: Path) -> dict[str, tuple[str, str]]:
    """The outcome and the output of each test."""
    found = {}
    for case in tree.parse(junit).getroot().iter("testcase"):
        if case.find("skipped") is not None:
            continue
        outcome = "held" if case.get("status") == "run" else "failed"
        found[case.get("name", "")] = (outcome, case.findtext("system-out") or "")
    return found


def rows_of_damage(folder: Path, test: str, outcome: str) -> list[list[str]]:
    counts: Counter[tuple[str, str]] = Counter()
    with open(folder / "tests/system/run" / test / "trials.csv", encoding="ascii") as file:
        for line in csv.DictReader(file):
            counts[line["file"], line["damage"]] += int(line["trials"])
    text = {"held": "none believed, none crashed"}.get(outcome, "some believed")
    return [
        [f"{name}: {damage}", str(count), text, f"ctest -C long -R {test}"]
        for (name, damage), count in sorted(counts.items())
    ]


def main() -> None:
    build, junit, page = (Path(word) for word in sys.argv[1:4])
    found = outcomes(junit)
    rows = [["fault", "answers or trials", "outcome", "command"], ["---"] * 4]
    for test, (what, count) in FAULTS.items():
        if test in found:
            outcome, output = found[test]
            trials = [int(number) for number in re.findall(count, output)]
            if count != WATCH:  # which is printed by each of its files
                trials = trials[:1]
            number = str(sum(trials)) if trials else "unknown"
            rows.append([what, number, outcome, f"ctest -C long -R '^{test}$'"])
    for begin, what in GROUPS.items():
        ends = [outcome for test, (outcome, _) in found.items() if test.startswith(begin)]
        if ends:
            outcome = "held" if set(ends) == {"held"} else "failed"
            command = f"ctest -R '^{begin.rstrip(': ')}'"
            rows.append([what, str(len(ends)), outcome, command])
    for test in DAMAGED:
        if test in found:
            rows += rows_of_damage(build, test, found[test][0])
    table = "".join(f"| {' | '.join(row)} |\n" for row in rows)
    text = page.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    page.write_text(before + BEGIN + table + END + rest.split(END)[1], encoding="utf-8")


if __name__ == "__main__":
    main()
