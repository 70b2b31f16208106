# SPDX-License-Identifier: BSD-3-Clause
"""The real program for tests in Python: a run, what it printed, its files.

Tests are classes of `ProgramTest`. Python's own unittest runs them (`program.main()`), and pytest
does, too. The environment names the program, its launcher and the sources, as for shell scripts.
"""
import json
import os
import re
import shutil
import subprocess
import unittest
from pathlib import Path

PROGRAM = os.environ["CARROM_PROGRAM"]
LAUNCHER = os.environ["CARROM_MPIEXEC"]
SOURCES = Path(os.environ["CARROM_SOURCE_DIR"])
ENVIRONMENT = {**os.environ, "OMP_WAIT_POLICY": "passive"}  # more threads than cores must not spin
VERSION = subprocess.run([LAUNCHER, "--version"], capture_output=True, text=True,
                         check=False).stdout
# The launcher of Open MPI 5.0.7 (Debian 13) sometimes sends some bytes of standard output to
# standard error. So with this launcher each rank writes to the files itself.
PAST_LAUNCHER = ["sh", "-c", 'exec "$@" >>"$0/out" 2>>"$0/err"']


def checkpoint(folder, step):
    return f"{folder}/checkpoints/checkpoint-{step:012}.h5"


def lines_of(text, step):
    """The discs of a step, one a line."""
    return [line for line in text.splitlines() if line.startswith(f"{step} ")]


def ranks_of(launcher):
    """The ids of its ranks. MPICH's launcher has processes between itself and them."""
    def children(parents):
        return subprocess.run(["pgrep", "-P", ",".join(map(str, parents))], capture_output=True,
                              text=True, check=True).stdout.split()
    ranks = children([launcher])
    return children(ranks) if "HYDRA" in VERSION else ranks


class Printed:
    """What a run printed, and how it ended."""

    def __init__(self, code, out, err):
        self.code, self.out, self.err = code, out, err


class ProgramTest(unittest.TestCase):
    """Each test has a folder of its own, which the program sees as its working folder."""

    maxDiff = 2000

    def setUp(self):
        self.folder = Path.cwd() / "files" / self.id().rsplit(".", 1)[-1]
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir(parents=True)

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return name

    def command(self, ranks, words):
        """One rank needs no launcher, which takes two seconds to leave if its only rank fails."""
        words = [PROGRAM, *map(str, words)]
        if ranks == 1:
            return words
        past = [*PAST_LAUNCHER, str(self.folder.parent)] if re.search("Open MPI\\) 5|PRRTE",
                                                                      VERSION) else []
        return [LAUNCHER, "-n", str(ranks), *past, *words]

    def run_program(self, ranks, *words, code=0, says=(), patience=120):
        """Fails unless the run ends with this code, or one of these, and prints `says` as errors
        or messages.
        """
        names = [self.folder.parent / name for name in ("out", "err")]
        with open(names[0], "wb") as out, open(names[1], "wb") as err:
            ended = subprocess.run(self.command(ranks, words), cwd=self.folder, env=ENVIRONMENT,
                                   stdin=subprocess.DEVNULL, stdout=out, stderr=err,
                                   timeout=patience, check=False)
        texts = [name.read_text(encoding="utf-8", errors="replace") for name in names]
        what = f"on {ranks} ranks: {' '.join(map(str, words))}\n{texts[1]}"
        self.assertIn(ended.returncode, code if isinstance(code, tuple) else (code,), what)
        for text in [says] if isinstance(says, str) else says:
            self.assertIn(text, texts[1], what)
        return Printed(ended.returncode, *texts)

    def check_refused(self, write, cases):
        """Each scene that `write(text)` writes to wrong.toml ends with code 2 and one line that
        says so; `cases` are pairs of the text and of what is said.
        """
        for text, says in cases:
            with self.subTest(says):
                write(text)
                run = self.run_program(1, "run", "wrong.toml", code=2, says=says)
                self.assertEqual(len(run.err.splitlines()), 1, run.err)

    def report(self, name):
        return json.loads((self.folder / name).read_text(encoding="utf-8"))

    def hash_of(self, name):
        return self.report(name)["state_hash"]

    def check_restart(self, scene, options=(), *, first, last):
        """Goes to step `last` on two ranks, and in two stretches on one and on three: bits and
        lines are the same. Files are in the folders `whole` and `kept`.
        """
        ends = ["--set", "output.text=ends"]
        whole = self.run_program(2, "run", scene, *options, *ends, "--steps", last, "-o", "whole",
                                 "--report", "whole.json")
        self.run_program(1, "run", scene, *options, "--threads", 2, "--steps", first, "-o", "kept")
        self.run_program(1, "verify", checkpoint("kept", first))
        rest = self.run_program(3, "run", "--restart", "kept", *ends, "--steps", last, "--report",
                                "rest.json")
        self.assertEqual(self.hash_of("rest.json"), self.hash_of("whole.json"))
        self.assertEqual(lines_of(rest.out, last), lines_of(whole.out, last))
        self.assertTrue(lines_of(rest.out, last))
        return rest


def main():
    unittest.main(verbosity=2)
