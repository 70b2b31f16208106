#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hold the number of instructions of fixed scenes to recorded values: what a step costs, whatever
the machine's mood.

  tests/performance/instructions.py STEP_SCENE BUILD    compare with instructions.csv;
                                                        code 1 if one is off by 3 %
  tests/performance/instructions.py STEP_SCENE BUILD --record    write instructions.csv anew

valgrind counts (callgrind, without its cache model) what happens below DiscSystem::advance_towards
in the program step_scene, which is compiled with the tests; start and set-up, where MPI polls for
as long as it has to wait, do not count. BUILD says how the program was compiled, as ctest passes it
("GNU 12.2.0 Release"). Numbers hold for the build and the instruction set named in the file:
elsewhere the test
is left out, with code 77.
"""

import argparse
import csv
import os
import re
import shutil
import subprocess
import sys
import tempfile

TOLERANCE = 0.03
TABLE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "instructions.csv")
SETTINGS = {
    "OMP_NUM_THREADS": "1",
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "GOMP_SPINCOUNT": "0",
}

GAS = "[box]\nsize = 250.66\n[discs]\ncount = 4000\nradius = 1\nspeed = 0.3\n[time]\n"
# name: (scene, kind, steps)
SCENES = {
    "gas, time-stepped": (GAS + "steps = 256\nmethod = \"time-stepped\"\n", "toml", 256),
    "generated, time-stepped": ("2000\n20000\n1\n40\nperf\n", "in", 40),
    "gas, event-driven": (GAS + "steps = 256\nmethod = \"event-driven\"\n", "toml", 256),
}


def finished(command):
    """The finished process of a command with the settings of a measurement."""
    run = subprocess.run(
        command,
        env={**os.environ, **SETTINGS},
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    if run.returncode != 0:
        sys.exit(f"{' '.join(command)} failed:\n{run.stderr}")
    return run


def run_scene(program, scene):
    """Runs step_scene, and returns what it prints."""
    return finished([program, scene]).stdout.strip()


def counted(program, scene):
    """Instructions of a run's steps."""
    with tempfile.TemporaryDirectory() as folder:
        command = [
            "valgrind",
            "--tool=callgrind",
            f"--callgrind-out-file={folder}/out",
            "--collect-atstart=no",
            "--toggle-collect=carrom::EngineBase*::advance_towards*",
            program,
            scene,
        ]
        run = finished(command)
    found = re.search(r"Collected : (\d+)", run.stderr)
    if not found:
        sys.exit(f"{' '.join(command)} failed:\n{run.stderr}")
    return int(found.group(1))


def measure(program):
    """Instructions per disc and step of every scene."""
    rows = {}
    with tempfile.TemporaryDirectory() as folder:
        for name, (text, kind, steps) in SCENES.items():
            scene = os.path.join(folder, f"scene.{kind}")
            with open(scene, "w", encoding="utf-8") as file:
                file.write(text)
            discs = (
                int(re.search(r"count = (\d+)", text).group(1))
                if kind == "toml"
                else int(text.split()[0])
            )
            rows[name] = counted(program, scene) / steps / discs
    return rows


def instruction_set():
    """The widest instructions that valgrind lets a program see here."""
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        flags = re.search(r"^flags\s*:(.*)$", file.read(), re.MULTILINE)
    return "avx2" if flags and " avx2" in flags.group(1) else "other"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", metavar="STEP_SCENE")
    parser.add_argument("build", metavar="BUILD")
    parser.add_argument("--record", action="store_true")
    options = parser.parse_args()
    if not shutil.which("valgrind"):
        print("left out: there is no valgrind")
        return 77
    place = (options.build, instruction_set())
    if not options.record:
        with open(TABLE, encoding="utf-8") as file:
            recorded = list(csv.DictReader(file))
        if (recorded[0]["build"], recorded[0]["instruction_set"]) != place:
            print(
                f"left out: recorded for {recorded[0]['build']}, {recorded[0]['instruction_set']};"
                f" here {place[0]}, {place[1]}"
            )
            return 77
    now = measure(options.program)
    if options.record:
        with open(TABLE, "w", encoding="utf-8", newline="") as file:
            table = csv.writer(file, lineterminator="\n")
            table.writerow(["scene", "instructions_per_disc_step", "build", "instruction_set"])
            for name, count in now.items():
                table.writerow([name, f"{count:.1f}", *place])
    code = 0
    for row in recorded if not options.record else []:
        before, after = float(row["instructions_per_disc_step"]), now[row["scene"]]
        change = after / before - 1
        print(f"{row['scene']}: {after:.1f} instructions per disc and step, {100 * change:+.2f} %")
        if abs(change) > TOLERANCE:
            print(
                f"  was {before:.1f}: if that is meant, record it and say why"
                " (tests/performance/instructions.py STEP_SCENE BUILD --record)"
            )
            code = 1
    return code


if __name__ == "__main__":
    sys.exit(main())
