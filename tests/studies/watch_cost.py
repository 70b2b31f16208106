#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What `python -m carrom.watch` costs the run that it follows.

  tests/studies/watch_cost.py [--build build] [--rounds 9]
      [--output docs/data/performance/watch.csv]

Asks for what an open page asks for, as often as the page is told to: the state, the curves and the
last frame. Needs h5py and numpy. The columns:

  watcher_share       processor time of the watcher over the time that the run takes
  instructions_ratio  of the run's steps, watched over not watched, as valgrind counts them
  processor_ratio     of the run's processor time, likewise: the median of --rounds rounds in turns,
                      and quartiles. This needs an idle machine; nothing where --rounds is 0.
"""

import argparse
import csv
import json
import os
import pathlib
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time
import urllib.error
import urllib.request

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "performance"))
from instructions import SETTINGS

COLUMNS = ("scene", "discs", "seconds", "watcher_share", "instructions_ratio", "processor_ratio",
           "processor_lower_quartile", "processor_upper_quartile")
TOP = pathlib.Path(__file__).resolve().parents[2]
# name: (discs, steps, steps from frame to frame); a minute each on an idle core
SCENES = {"gas of 1e4 discs": (10_000, 400_000, 2000), "gas of 1e6 discs": (1_000_000, 4000, 500)}
VALGRIND = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null",
            "--collect-atstart=no", "--toggle-collect=carrom::DiscSystem::advance_towards*"]


def scene_text(n_discs, steps, every):
    return (f"[box]\nsize = {(n_discs * 15.7) ** 0.5!r}\n[discs]\ncount = {n_discs}\nradius = 1\n"
            f"generator = \"lattice\"\nspeed = 0.1\n[time]\nsteps = {steps}\n"
            f"method = \"event-driven\"\n[output.trajectory]\nevery_steps = {every}\n")


class Page(threading.Thread):
    """Asks for what a page in a browser asks for, until it is closed."""

    def __init__(self, address):
        super().__init__()
        self.address, self.closed, self.n_frames = address, threading.Event(), 0

    def get(self, words):
        try:
            with urllib.request.urlopen(self.address + words, timeout=60) as answer:
                return answer.read()
        except urllib.error.HTTPError as error:  # not yet there, or being replaced
            error.read()
            return None

    def run(self):
        n_steps, last, pause = 0, -1, 1.0
        while not self.closed.wait(pause):
            answer = self.get(f"state?have={n_steps}&last={last}")
            if answer is None:
                continue
            state = json.loads(answer)
            pause = state["pause"]
            self.get("curves")
            if state["steps"]:
                n_steps, last = state["first"] + len(state["steps"]), state["steps"][-1]
                self.n_frames += self.get(f"frame?step={last}&colour=speed&follow=1") is not None


class Watcher:
    """The watcher's process and a page that is open, for a run in a folder to come."""

    def __init__(self, folder):
        command = [sys.executable, "-m", "carrom.watch", str(folder), "--wait", "--port", "0"]
        environment = os.environ | {"PYTHONPATH": str(TOP / "src/python")}
        self.process = subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, text=True)
        self.page = Page(self.process.stdout.readline().split(" - ")[0].split()[-1])
        self.page.start()

    def end(self):
        """Processor seconds; exits where the page has seen nothing."""
        self.page.closed.set()
        self.page.join()
        self.process.send_signal(signal.SIGINT)
        _, _, usage = os.wait4(self.process.pid, 0)
        self.process.returncode = 0
        if self.page.n_frames == 0:
            sys.exit("the run has ended before the page has seen a frame; take more steps")
        return usage.ru_utime + usage.ru_stime


def run(carrom, scene, folder, prefix=()):
    """(seconds, processor seconds, instructions) of a run on one core."""
    command = [*prefix, carrom, "run", str(scene), "-o", str(folder), "--quiet", "--threads", "1"]
    begin = time.monotonic()
    with subprocess.Popen(command, env=os.environ | SETTINGS, stderr=subprocess.PIPE,
                          text=True) as process:
        printed = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"{' '.join(command)} failed:\n{printed}")
    counts = [int(line.split()[-1]) for line in printed.splitlines() if "Collected :" in line]
    return time.monotonic() - begin, usage.ru_utime + usage.ru_stime, counts[0] if counts else 0


def watched_and_not(carrom, scene, folder, name, prefix=()):
    """A run that is watched and one that is not, and the watcher's processor seconds."""
    watcher = Watcher(folder / f"{name}_watched")
    watched = run(carrom, scene, folder / f"{name}_watched", prefix)
    spent = watcher.end()
    return watched, run(carrom, scene, folder / f"{name}_alone", prefix), spent


def row(carrom, name, rounds):
    n_discs, steps, every = SCENES[name]
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        scene = folder / "scene.toml"
        scene.write_text(scene_text(n_discs, steps // 20, every // 20), encoding="utf-8")
        watched, alone, _ = watched_and_not(carrom, scene, folder, "counted", VALGRIND)
        instructions = watched[2] / alone[2]
        scene.write_text(scene_text(n_discs, steps, every), encoding="utf-8")
        pairs = [watched_and_not(carrom, scene, folder, f"round_{k}")
                 for k in range(max(1, rounds))]
    seconds = statistics.median(watched[0] for watched, _, _ in pairs)
    share = statistics.median(spent / watched[0] for watched, _, spent in pairs)
    numbers = [f"{seconds:.1f}", f"{share:.4f}", f"{instructions:.6f}"]
    ratios = [watched[1] / alone[1] for watched, alone, _ in pairs]
    if rounds > 1:
        low, median, high = statistics.quantiles(ratios, n=4)
        numbers += [f"{median:.4f}", f"{low:.4f}", f"{high:.4f}"]
    return [name, n_discs, *numbers]


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--build", type=pathlib.Path, default=pathlib.Path("build"))
    parser.add_argument("--rounds", type=int, default=0)
    parser.add_argument("--only", nargs="+", choices=SCENES, default=list(SCENES))
    parser.add_argument("--output", default="/dev/stdout", metavar="CSV")
    options = parser.parse_args()
    carrom = str((options.build / "carrom").resolve())
    with open(options.output, "w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(COLUMNS if options.rounds > 1 else COLUMNS[:5])
        for name in options.only:
            table.writerow(row(carrom, name, options.rounds))
            file.flush()


if __name__ == "__main__":
    main()
