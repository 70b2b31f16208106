#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Test the instructions that nvcc makes of the kernels: `ptx_test.py BUILD`.

Each sum and product must be rounded by itself, so that a driver cannot fuse it with another one,
and `fma` must be in no kernel but those whose source writes it. Without nvcc the test is skipped;
CARROM_NVCC names one.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SKIPPED = 77
SOURCE = Path(__file__).resolve().parents[3]
ARITHMETIC = re.compile(r"\b(?:add|sub|mul|div|sqrt|mad|fma)(?:\.[a-z]+)*\.f(?:32|64)\b")
# The contact of a pair and the way back into a periodic box are written with fma.
WITH_FMA = re.compile("Predict|Match|Waiting|Mark|Renew|Restart.*PeriodicSpace")
OF_PAIRS = re.compile("Predict|Match|Waiting|Mark|Renew")


def compiler() -> str:
    """Return nvcc, or end the test."""
    named = os.environ.get("CARROM_NVCC") or shutil.which("nvcc", path="/usr/local/cuda/bin")
    found = named or shutil.which("nvcc")
    if not found:
        print("skipped: there is no nvcc; CARROM_NVCC=FILE names one")
        sys.exit(SKIPPED)
    return found


def instructions(build: Path) -> str:
    """Return the kernels as text, for one architecture."""
    includes = [f"-I{folder}" for folder in sorted((build / "modules").iterdir())]
    with tempfile.TemporaryDirectory() as place:
        text = Path(place) / "kernels.ptx"
        flags = (SOURCE / "src/gpu/cuda.cmake").read_text().split("set(nvcc_flags")[1]
        words = [compiler(), *flags.split(")")[0].split(), "-arch=compute_80", "-ptx"]
        words += [f"-I{SOURCE}/include", *includes]
        words += [str(SOURCE / "src/gpu/cuda_device.cu"), "-o", str(text)]
        subprocess.run(words, check=True)
        return text.read_text()


def main() -> None:
    """Search the instructions of each kernel."""
    text = instructions(Path(sys.argv[1]))
    kernel, n_kernels, with_fma = "", 0, set()
    for line in text.splitlines():
        if start := re.search(r"\.(?:entry|func)\b.*?([A-Za-z_0-9$]+)\($", line):
            kernel = start[1]
            n_kernels += ".entry" in line
        for word in ARITHMETIC.findall(line):
            assert ".rn" in word and ".ftz" not in word, f"{word} in {kernel}"
            if word.startswith("fma"):
                with_fma.add(kernel)
                assert WITH_FMA.search(kernel), f"{word} in {kernel}"
            assert not word.startswith("mad"), f"{word} in {kernel}"
    n_of_pairs = sum(1 for name in with_fma if OF_PAIRS.search(name))
    # Predict, Match, two kernels of Waiting, Mark and Renew, for each of seven dynamics.
    assert n_of_pairs == 6 * 7, f"{n_of_pairs} kernels find contacts"
    print(f"{n_kernels} kernels, {len(with_fma)} of them with fma")


if __name__ == "__main__":
    main()
