#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Run the code blocks of a page in order, and compare what they print with what the page shows.

  pages.py PAGE --build FOLDER [--python FOLDER] [--update]

The blocks run in the folder `files` below the working folder. It has links to inputs, docs, src and
job_scripts of the checkout and to its build folder. `carrom`, `mpirun` and `carrom-plot` are on
PATH, and Python finds the package carrom.

  ```sh     runs in bash. It must end with code 0, or with N after <!-- exit code N -->.
  ```text   is what the sh block before it prints, standard error included.
  others    stand behind <!-- file: NAME --> and are written to that file. The text before names it
            as `NAME`, because a reader does not see the comment.

In a text block `...` stands for any text, and a line `...` for any lines. Behind the labels of
TIMES any text will do: it depends on the machine. <!-- not run: REASON --> before a block exempts
it, <!-- needs: MODULE ... --> names Python modules, which come from PyPI. What is left out is
printed with its reason. --update writes what was printed into text blocks that have no `...`.
"""

import argparse
import fcntl
import os
import pathlib
import re
import shutil
import subprocess
import sys
import time

TIMES = ("steps ", "machine ", "phases ", "imbalance ", "windows ")
PROGRESS = re.compile(r"^step \d+ of \d+ \(.*\n", re.M)  # slow runs print it
FENCE = re.compile(r"^( *)```(\w*)\s*$")
COMMENT = re.compile(r"^ *<!-- (file|not run|needs|exit code):? (.*?) -->\s*$")
SECONDS_PER_BLOCK = 300  # on a busy machine; an idle machine takes at most 30


class Block:
    """A fenced block: its language, lines, place, and the comments that stand before it."""

    def __init__(self, language, line, indent, notes):
        self.language, self.line, self.indent, self.notes = language, line, indent, notes
        self.lines = []

    @property
    def text(self):
        return "".join(line + "\n" for line in self.lines)


def blocks_of(page):
    blocks, block, notes = [], None, {}
    for number, line in enumerate(page.read_text().splitlines(), 1):
        fence = FENCE.match(line)
        if block is not None:
            if fence and not fence.group(2):
                blocks.append(block)
                block = None
            else:
                block.lines.append(line[len(block.indent) :])
        elif fence:
            block = Block(fence.group(2), number, fence.group(1), notes)
            notes = {}
        elif comment := COMMENT.match(line):
            notes[comment.group(1)] = comment.group(2)
        elif line.strip():
            notes = {}
    return blocks


def pattern_of(shown):
    """A regular expression for what a text block shows."""
    expression = ""
    for line in shown:
        if line.strip() == "...":
            expression += r"(?:.*\n)*?"
            continue
        label = next((word for word in TIMES if line.startswith(word)), None)
        if label:
            line = label + "..."
        expression += ".*".join(re.escape(part) for part in line.split("...")) + "\n"
    return re.compile(expression)


class Runner:
    def __init__(self, options):
        self.page, self.options = options.page.resolve(), options
        self.top = pathlib.Path(os.environ.get("CARROM_SOURCE_DIR", ".")).resolve()
        self.build = options.build.resolve()
        self.python = options.python.resolve() if options.python else None
        self.n_failures = 0
        self.lacking = None  # the first modules that could not be had
        self.new_texts = []

    def complain(self, block, text):
        print(f"FAILED: {self.page.name}:{block.line}: {text}")
        self.n_failures += 1

    def prepare(self):
        self.folder = pathlib.Path("files").resolve()
        shutil.rmtree(self.folder, ignore_errors=True)
        self.folder.mkdir()
        for name in ("inputs", "docs", "src", "job_scripts"):
            (self.folder / name).symlink_to(self.top / name)
        (self.folder / "build").symlink_to(self.build)
        programs = pathlib.Path("programs").resolve()
        shutil.rmtree(programs, ignore_errors=True)
        programs.mkdir()
        (programs / "carrom").symlink_to(os.environ.get("CARROM_PROGRAM", self.build / "carrom"))
        commands = {
            "mpirun": os.environ.get("CARROM_MPIEXEC", "mpiexec"),
            "carrom-import": "python3 -m carrom.importing",  # as pip would install it
            "carrom-plot": "python3 -m carrom.plot.commands",
        }
        for name, command in commands.items():
            (programs / name).write_text(f'#!/bin/sh\nexec {command} "$@"\n')
            (programs / name).chmod(0o755)
        self.environment = dict(os.environ, OMP_WAIT_POLICY="passive", COLUMNS="80",
                                PYTHONPATH=str(self.top / "src/python"),
                                PYTHONDONTWRITEBYTECODE="1")
        self.environment["PATH"] = f"{programs}:{os.environ['PATH']}"

    def has_modules(self, names):
        """Whether the environment of --python has these modules, if need be from PyPI."""
        if self.python is None:
            return False
        with open(self.python.parent / (self.python.name + ".lock"), "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)  # pages may be tested side by side
            if not (self.python / "bin/pip").exists():
                made = quiet([sys.executable, "-m", "venv", "--clear", self.python])
                if not made:
                    return False
            python = self.python / "bin/python"
            imports = [python, "-c", "import " + ", ".join(names)]
            pip = [python, "-m", "pip", "install", "--quiet", "--retries", "1", "--timeout", "10"]
            if not quiet(imports) and not (quiet([*pip, *names]) and quiet(imports)):
                return False
        self.environment["PATH"] = f"{self.python}/bin:{self.environment['PATH']}"
        return True

    def reason_to_skip(self, block):
        if "not run" in block.notes:
            return block.notes["not run"]
        names = block.notes.get("needs", "").split()
        if names and self.lacking is None and not self.has_modules(names):
            self.lacking = ", ".join(names)
        if names and self.lacking:
            return f"{self.lacking}: not to be had from PyPI"
        return None

    def run(self, block):
        """What the block prints, or None if it was not run."""
        reason = self.reason_to_skip(block)
        if reason is not None:
            print(f"not run: {self.page.name}:{block.line}: {reason}")
            return None
        command = ["bash", "-euo", "pipefail", "-c", block.text]
        try:
            done = subprocess.run(
                command,
                cwd=self.folder,
                env=self.environment,
                text=True,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                timeout=SECONDS_PER_BLOCK,
            )
        except subprocess.TimeoutExpired:
            self.complain(block, f"no end within {SECONDS_PER_BLOCK} seconds")
            return None
        wanted = int(block.notes.get("exit code", 0))
        if done.returncode != wanted:
            self.complain(block, f"exit code {done.returncode}, not {wanted}\n{done.stdout}")
            return None
        return PROGRESS.sub("", done.stdout)

    def compare(self, block, printed):
        if pattern_of(block.lines).fullmatch(printed):
            return
        if self.options.update and "..." not in block.text:
            self.new_texts.append((block, printed))
            return
        self.complain(block, f"the page shows\n{block.text}but this was printed:\n{printed}")

    def write_file(self, block):
        lines = self.page.read_text().splitlines()[: block.line]
        since = max((n for n, line in enumerate(lines[:-1]) if FENCE.match(line)), default=0)
        if f"`{block.notes['file']}`" not in " ".join(lines[since:]):
            self.complain(block, f"the text before does not name `{block.notes['file']}`")
        path = self.folder / block.notes["file"]
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(block.text)

    def check_names(self):
        """Links and names of source files lead somewhere. The site's own test finds dead anchors.
        """
        text = self.page.read_text()
        for link in re.findall(r"\]\(([^)#\s]+)[^)]*\)", text):
            if "://" not in link and not (self.page.parent / link).exists():
                print(f"FAILED: {self.page.name}: dead link {link}")
                self.n_failures += 1
        for name in re.findall(r"`([\w.-]+/[\w./-]+\.(?:[ch]pp|py|sh|sbatch))`", text):
            places = [self.top / name, self.top / "src" / name]
            is_ours = any((place.parents[name.count("/") - 1]).is_dir() for place in places)
            if is_ours and not any(place.exists() for place in places):
                print(f"FAILED: {self.page.name}: there is no {name}")
                self.n_failures += 1

    def run_all(self):
        self.check_names()
        self.prepare()
        printed, n_run = None, 0
        for block in blocks_of(self.page):
            if "file" in block.notes:
                self.write_file(block)
            elif block.language == "sh":
                printed = self.run(block)
                n_run += printed is not None
            elif block.language == "text":
                if printed is not None:
                    self.compare(block, printed)
                printed = None
            elif "not run" not in block.notes:
                self.complain(block, "neither sh, nor text, nor behind <!-- file: NAME -->")
        return n_run

    def write_new_texts(self):
        lines = self.page.read_text().splitlines()
        for block, printed in reversed(self.new_texts):
            new = [(block.indent + line).rstrip() for line in printed.splitlines()]
            lines[block.line : block.line + len(block.lines)] = new
        self.page.write_text("".join(line + "\n" for line in lines))


def quiet(command):
    output = subprocess.DEVNULL
    return subprocess.run(command, stdout=output, stderr=output, timeout=300).returncode == 0


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--build", type=pathlib.Path, required=True)
    parser.add_argument("--python", type=pathlib.Path, help="folder of a virtual environment")
    parser.add_argument("--update", action="store_true")
    options = parser.parse_args()
    runner = Runner(options)
    start = time.monotonic()
    n_run = runner.run_all()
    if runner.new_texts:
        runner.write_new_texts()
    seconds = time.monotonic() - start
    print(f"{options.page.name}: {n_run} blocks run in {seconds:.0f} s")
    sys.exit(1 if runner.n_failures else 0)


if __name__ == "__main__":
    main()
