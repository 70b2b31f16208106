#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measure what it takes to compile the program: core-seconds of each target, as CSV.

  tests/studies/compile_times.py --output docs/data/performance/compile_times.csv
      --page docs/understanding/performance.md [--sources]

Configures a build of the program alone in a folder of its own, and runs its compile commands one
after the other, without a compiler cache: minutes. What counts is the time of the processor, which
a busy machine changes less than time on the clock. --page writes the table between the markers of
that page, and --sources prints the time of each source. The machine and the compiler stand in the
last row. Words behind `--` go to CMake.
"""

import argparse
import collections
import csv
import json
import os
import pathlib
import platform
import re
import shlex
import subprocess
import sys
import tempfile

TOP = pathlib.Path(__file__).resolve().parents[2]
# Targets that are compiled besides the program: the library for others, and the test of its
# headers.
BESIDE = {"library", "libcarrom_verify_interface_header_sets"}
BEGIN, END = "<!-- compile -->", "<!-- end of compile -->"


def commands_of(build, words):
    """[(target, source, command)] of the program, precompiled headers first."""
    subprocess.run(
        ["cmake", "-S", TOP, "-B", build, "-DCMAKE_UNITY_BUILD=ON", "-DCARROM_TESTS=OFF",
         "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", "-DCMAKE_CXX_COMPILER_LAUNCHER=", *words],
        check=True, stdout=subprocess.DEVNULL)
    found = []
    for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
        target = re.search(r"CMakeFiles/(?:carrom_)?(\w+)\.dir/", entry["command"]).group(1)
        if target not in BESIDE:
            found.append((target, entry["file"], entry["command"], entry["directory"]))
    return sorted(found, key=lambda one: "cmake_pch" not in one[1])


def core_seconds(command, folder):
    process = subprocess.Popen(shlex.split(command), cwd=folder)
    _, status, used = os.wait4(process.pid, 0)
    if status != 0:
        sys.exit(f"code {os.waitstatus_to_exitcode(status)}: {command}")
    return used.ru_utime + used.ru_stime


def processor():
    try:
        found = re.search(r"^model name\s*:\s*(.*)$", pathlib.Path("/proc/cpuinfo").read_text(),
                          re.M)
    except OSError:
        found = None
    return found.group(1).strip() if found else platform.machine()


def measured(commands, prints_sources):
    """{target: [seconds of each source]}"""
    seconds = collections.defaultdict(list)
    for target, source, command, folder in commands:
        seconds[target].append(core_seconds(command, folder))
        if prints_sources:
            print(f"{seconds[target][-1]:7.2f} {target} {source}", flush=True)
    return seconds


def rows_of(seconds):
    rows = [
        {"target": target, "sources": len(times), "core_seconds": f"{sum(times):.1f}"}
        for target, times in seconds.items()
    ]
    rows.sort(key=lambda row: -float(row["core_seconds"]))
    compiler = subprocess.run(["c++", "--version"], capture_output=True, text=True, check=False)
    rows.append(
        {
            "target": f"all ({processor()}; {compiler.stdout.splitlines()[0]})",
            "sources": sum(map(len, seconds.values())),
            "core_seconds": f"{sum(map(sum, seconds.values())):.1f}",
        }
    )
    return rows


def write_page(page, rows):
    text = page.read_text(encoding="utf-8")
    if BEGIN not in text or END not in text:
        sys.exit(f"{page} has no markers '{BEGIN}' and '{END}'")
    lines = ["| target | sources | core-seconds |", "|---|---|---|"]
    lines += [f"| {r['target']} | {r['sources']} | {r['core_seconds']} |" for r in rows]
    head, tail = text[: text.index(BEGIN) + len(BEGIN)], text[text.index(END) :]
    page.write_text("\n".join([head, *lines, tail]), encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--output", type=pathlib.Path)
    parser.add_argument("--page", type=pathlib.Path)
    parser.add_argument("--sources", action="store_true")
    parser.add_argument("cmake", nargs="*", metavar="-- WORD", help="words for CMake")
    options = parser.parse_args()
    os.environ["CCACHE_DISABLE"] = "1"
    with tempfile.TemporaryDirectory() as build:
        commands = commands_of(pathlib.Path(build), options.cmake)
        rows = rows_of(measured(commands, options.sources))
    with open(options.output, "w", encoding="utf-8") if options.output else sys.stdout as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    if options.page:
        write_page(options.page, rows)


if __name__ == "__main__":
    main()
