#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measure Carrom beside its peers: LAMMPS, EDMD, and a plain stream of the same bytes. One CSV row
per case.

  tests/studies/compare.py --build build --output docs/data/performance/rates.csv --minutes 7
      [--edmd PROGRAM] [--only PATTERN] [--short]

Every case of a round runs before the next round begins, each together with what it is compared
with, so that a drift of the machine's speed falls on both; ratios are taken within a round, and the
CSV has their medians. Rounds go on until the time is up, at least three. --short runs all cases
once and for a fraction of their steps: to see that it works. LAMMPS (Debian: lammps) is left out,
and named, where there is none. planar_edmd.py builds EDMD; it makes as many collisions as Carrom,
from the same places in the same periodic box.
"""

import argparse
import csv
import fnmatch
import json
import os
import platform
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

from measure import ENVIRONMENT
from rate_cases import cases

FOLDER = os.path.dirname(os.path.abspath(__file__))



def timed(command, environment, folder=None):
    start = time.perf_counter()
    run = subprocess.run(
        command, check=True, stdout=subprocess.PIPE, text=True, env=environment, cwd=folder
    )
    return time.perf_counter() - start, run.stdout


class Machine:
    def __init__(self, build, short, edmd):
        self.build, self.short = build, short
        self.edmd = [os.path.abspath(program) for program in edmd]
        self.environment = ENVIRONMENT
        self.lammps = shutil.which("lmp")
        if not self.lammps:
            print("there is no LAMMPS (lmp): its columns stay empty", file=sys.stderr)
        if not self.edmd:
            print("there is no --edmd: its columns stay empty", file=sys.stderr)

    def steps(self, n):
        return max(2, n // 16) if self.short else n

    def carrom(self, case, folder):
        """(rate per second, bytes per disc, report)"""
        text, kind = case.scene(self.steps)
        scene, report = os.path.join(folder, f"scene.{kind}"), os.path.join(folder, "report.json")
        with open(scene, "w", encoding="utf-8") as file:
            file.write(text)
        command = [
            os.path.join(self.build, "carrom"),
            "run",
            scene,
            "--threads",
            str(case.threads),
            "--quiet",
            "--report",
            report,
        ]
        if case.ranks > 1:
            command = ["mpirun", "-np", str(case.ranks)] + command
        seconds, _ = timed(command, self.environment)
        with open(report, encoding="utf-8") as file:
            result = json.load(file)
        if not case.whole:
            seconds = result["wall_seconds"]
        done = (
            result["pair_collisions"]
            if case.unit == "collisions"
            else result["n_discs"] * result["steps"]
        )
        return done / seconds, seconds, result

    def peer(self, case):
        """LAMMPS's disc-steps per second."""
        if not case.peer or not self.lammps:
            return None
        side, steps = case.peer
        command = [
            self.lammps,
            "-in",
            os.path.join(FOLDER, "lammps_gas.in"),
            "-log",
            "none",
            "-var",
            "side",
            str(side),
            "-var",
            "steps",
            str(self.steps(steps)),
            "-var",
            "first",
            str(self.steps(steps) // 3),
        ]
        _, text = timed(command, {**self.environment, "OMP_NUM_THREADS": "1"})
        seconds, done, discs = [
            match
            for match in re.findall(
                r"Loop time of (\S+) on .* for (\d+) steps with (\d+) atoms", text
            )
        ][-1]
        return int(discs) * int(done) / float(seconds)

    def exact_peer(self, case, n_collisions, folder):
        """Collisions per second of the fastest of EDMD's programs, from where Carrom began. Multi
        ends with an error where a disc has more neighbours than it has room for; another counts.
        So does another where one is not done after a minute.
        """
        if not case.edmd or not self.edmd:
            return None
        scene, start = os.path.join(folder, "scene.toml"), os.path.join(folder, "start")
        program = os.path.join(self.build, "carrom")
        begin = [program, "run", scene, "--set", "time.steps=0", "--overwrite", "--quiet"]
        timed([*begin, "-o", start], self.environment)
        stored = os.path.join(start, "checkpoints", "checkpoint-000000000000.h5")
        _, text = timed([program, "convert", stored, "--to", "xyz"], self.environment)
        count, header, *lines = text.splitlines()
        size = re.search(r'Lattice="(\S+)', header).group(1)
        columns = "Properties=species:S:1:pos:R:3:velo:R:3:id:I:1:radius:R:1:"
        assert columns in header, header
        with open(os.path.join(folder, "init.sph"), "w", encoding="ascii") as file:
            file.write(f"{count}\n{size} {size} 1.0\n")
            for words in map(str.split, lines):
                file.write(f"a {words[1]} {words[2]} 0.5 {words[8]}\n")
        rates = []
        for peer in self.edmd:
            words = [peer, str(max(1, round(n_collisions * case.edmd_share)))]
            try:
                run = subprocess.run(words, capture_output=True, text=True, cwd=folder, timeout=60)
            except subprocess.TimeoutExpired:
                continue
            found = re.search(r"collisions (\d+) seconds (\S+)", run.stdout)
            if run.returncode == 0 and found:
                rates.append(int(found.group(1)) / float(found.group(2)))
        return max(rates, default=None)

    def stream(self, n_discs, threads):
        """Disc-steps per second of a program that only reads and writes every disc's 64 bytes."""
        passes = max(3, int(2e8 / n_discs / (16 if self.short else 1)))
        _, text = timed(
            [
                os.path.join(self.build, "tests", "machine_peaks"),
                "stream",
                str(n_discs),
                str(passes),
                str(threads),
            ],
            self.environment,
        )
        return 1e9 / float(text)


def machine_text():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        words = dict(re.findall(r"^(\w[\w ]*?)\s*:\s*(.*)$", file.read(), re.MULTILINE))
    name = words.get("model name", platform.processor())
    return f"{name}, model {words.get('model', 'unknown')}, {os.cpu_count()} cores"


def version_of(build):
    compiler, kind = "", ""
    with open(os.path.join(build, "CMakeCache.txt"), encoding="utf-8") as file:
        cache = file.read()
    found = re.search(r"^CMAKE_CXX_COMPILER:\w+=(.*)$", cache, re.MULTILINE)
    if found:
        compiler = subprocess.run(
            [found.group(1), "--version"], capture_output=True, text=True, check=False
        ).stdout.splitlines()[0]
    found = re.search(r"^CMAKE_BUILD_TYPE:\w+=(.*)$", cache, re.MULTILINE)
    kind = found.group(1) if found else ""
    commit = subprocess.run(
        ["git", "-C", FOLDER, "describe", "--always", "--dirty"],
        capture_output=True,
        text=True,
        check=False,
    ).stdout.strip()
    text = subprocess.run(
        [os.path.join(build, "carrom"), "--version"], capture_output=True, text=True, check=True
    ).stdout
    vectors = re.search(r"^vectors\s+(\S+)", text, re.MULTILINE).group(1)
    return f"{compiler}, {kind}, vectors {vectors}", commit


def median(values):
    values = [value for value in values if value is not None]
    return statistics.median(values) if values else ""


def number(value):
    return f"{value:.5g}" if value != "" else ""


COLUMNS = """
    case unit ranks threads n_discs steps rounds rate least most seconds ns_per_disc_step
    lammps_rate over_lammps edmd_rate over_edmd stream_rate over_stream imbalance bytes_per_disc
    goal machine compiler version
""".split()


def write(path, chosen, rounds, machine):
    compiler, commit = version_of(machine.build)
    with open(path, "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(COLUMNS)
        for name, case in chosen.items():
            runs = rounds[name]
            if not runs:
                continue
            rates = [run["rate"] for run in runs]
            result = runs[-1]["result"]
            over = {
                key: median([run["rate"] / run[key] if run[key] else None for run in runs])
                for key in ("lammps", "edmd", "stream")
            }
            table.writerow(
                [
                    name,
                    case.unit,
                    case.ranks,
                    case.threads,
                    result["n_discs"],
                    result["steps"],
                    len(runs),
                    number(median(rates)),
                    number(min(rates)),
                    number(max(rates)),
                    number(median([run["seconds"] for run in runs])),
                    number(median([run["result"]["ns_per_disc_step"] for run in runs])),
                    number(median([run["lammps"] for run in runs])),
                    number(over["lammps"]),
                    number(median([run["edmd"] for run in runs])),
                    number(over["edmd"]),
                    number(median([run["stream"] for run in runs])),
                    number(over["stream"]),
                    number(median([run["result"]["imbalance"] for run in runs])),
                    number(result["peak_bytes_per_disc"]),
                    case.goal,
                    machine_text(),
                    compiler,
                    commit,
                ]
            )


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--build", default="build")
    parser.add_argument("--output", required=True)
    parser.add_argument("--minutes", type=float, default=7)
    parser.add_argument(
        "--edmd",
        nargs="*",
        default=[],
        help="programs that planar_edmd.py builds; the fastest counts",
    )
    parser.add_argument("--only", default="*", help="cases by name, as in '*, 1e6*'")
    parser.add_argument("--short", action="store_true")
    options = parser.parse_args()
    chosen = {name: case for name, case in cases().items() if fnmatch.fnmatch(name, options.only)}
    machine = Machine(os.path.abspath(options.build), options.short, options.edmd)
    rounds = {name: [] for name in chosen}
    end = time.monotonic() + 60 * options.minutes
    fewest = 1 if options.short else 3
    turn, longest = 0, 0.0
    with tempfile.TemporaryDirectory() as folder:
        while turn < fewest or (not options.short and time.monotonic() + longest < end):
            start = time.monotonic()
            for name, case in chosen.items():
                rate, seconds, result = machine.carrom(case, folder)
                lammps = machine.peer(case)
                edmd = machine.exact_peer(case, result["pair_collisions"], folder)
                stream = (
                    machine.stream(result["n_discs"], case.ranks * case.threads)
                    if case.unit == "disc-steps" and not case.whole
                    else None
                )
                rounds[name].append(
                    {
                        "rate": rate,
                        "seconds": seconds,
                        "result": result,
                        "lammps": lammps,
                        "edmd": edmd,
                        "stream": stream,
                    }
                )
                print(
                    f"round {turn}  {name:34} {rate:10.4g} {case.unit}/s"
                    + (f"  LAMMPS {lammps:.3g}" if lammps else "")
                    + (f"  EDMD {edmd:.3g}" if edmd else "")
                    + (f"  stream {stream:.3g}" if stream else ""),
                    file=sys.stderr,
                )
            write(options.output, chosen, rounds, machine)
            longest = max(longest, time.monotonic() - start)
            turn += 1


if __name__ == "__main__":
    main()
