#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Show that effects cost a plain scene nothing: compare this build with one from which their code
has been taken out.

  tests/performance/without_effects.py STEP_SCENE SOURCE CMAKE [ARGUMENT ...]

Copies the source tree, takes out all dynamics but the plain ones (from the list of those that are
compiled, and the choice between them), compiles step_scene from that and runs fixed plain scenes
with both programs. State hashes must be equal, and instructions of stepping (callgrind, as in
instructions.py) within 0.1 %. Bytes of a disc are the size of its state, the same line of code in
both. Takes some minutes: CMAKE builds with two processes. ARGUMENTs go to its configuration. Code 1
if anything differs, 77
where there is no valgrind.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile

from instructions import SCENES, counted, run_scene

TOLERANCE = 0.001
PLAIN = {"PlainDynamics", "StudyDynamics<double>", "StudyDynamics<float>"}
LISTED = re.compile(r" ?make\((\w+(?:<\w+>)?)\)")
CHOICE = re.compile(
    r"^    const Effects& effects = .*?(?=^    if \(scene\.precision == )", re.MULTILINE | re.DOTALL
)


def take_out_effects(source):
    """Returns how many dynamics were taken out of the list that kernels and engines are compiled
    for.
    """
    path = os.path.join(source, "src/dynamics/all_dynamics.hpp")
    with open(path, encoding="utf-8") as file:
        text = file.read()
    taken = [name for name in LISTED.findall(text) if "Dynamics" in name and name not in PLAIN]
    with open(path, "w", encoding="utf-8") as file:
        file.write(LISTED.sub(lambda m: "" if m.group(1) in taken else m.group(0), text))
    path = os.path.join(source, "src/engine/dynamics_of_scene.hpp")
    with open(path, encoding="utf-8") as file:
        text = file.read()
    text, n_choices = CHOICE.subn("", text)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    if n_choices != 1 or not taken:
        sys.exit(f"did not find what to take out: {n_choices} choices, {len(taken)} dynamics")
    return len(taken)


def build_without(source, cmake, arguments, folder):
    copy, build = os.path.join(folder, "source"), os.path.join(folder, "build")
    shutil.copytree(source, copy, ignore=shutil.ignore_patterns("build*", ".git", "docs"))
    print(f"taken out: {take_out_effects(copy)} dynamics")
    for command in (
        [cmake, "-S", copy, "-B", build, *arguments],
        [cmake, "--build", build, "-j", "2", "--target", "step_scene"],
    ):
        run = subprocess.run(command, capture_output=True, text=True, check=False)
        if run.returncode != 0:
            sys.exit(f"{' '.join(command)} failed:\n{run.stdout[-4000:]}{run.stderr[-4000:]}")
    return os.path.join(build, "tests", "step_scene")


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    program, source, cmake, *arguments = sys.argv[1:]
    if not shutil.which("valgrind"):
        print("left out: there is no valgrind")
        return 77
    code = 0
    with tempfile.TemporaryDirectory() as folder:
        bare = build_without(source, cmake, arguments, folder)
        for name, (text, kind, _) in SCENES.items():
            scene = os.path.join(folder, f"scene.{kind}")
            with open(scene, "w", encoding="utf-8") as file:
                file.write(text)
            counts, hashes = [counted(p, scene) for p in (bare, program)], [
                run_scene(p, scene) for p in (bare, program)
            ]
            change = counts[1] / counts[0] - 1
            print(
                f"{name}: {counts[0]} instructions without effects' code, {counts[1]} with it,"
                f" {100 * change:+.3f} %; state hash {hashes[1]}"
            )
            if abs(change) > TOLERANCE or hashes[0] != hashes[1]:
                print(f"  not the same: {hashes[0]} without")
                code = 1
    return code


if __name__ == "__main__":
    sys.exit(main())
