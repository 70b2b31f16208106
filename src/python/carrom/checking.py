# SPDX-License-Identifier: BSD-3-Clause
"""Checking a file byte by byte. The readers of this package read without checksums."""

from __future__ import annotations

import os
import subprocess

from carrom.errors import FileError
from carrom.program import find_program


def verify(path: str | os.PathLike[str], program: str | os.PathLike[str] | None = None) -> None:
    """Check every byte of a checkpoint, a trajectory or a log, and that its discs are possible.

    The readers of this package trust HDF5, which keeps no checksums. So call this before you
    believe a file that was copied, or that comes from a disk that fails.

    Args:
        path: the file; of a recording the one that joins the segments, `trajectory.h5`
        program: see `carrom.find_program`

    Raises:
        FileError: the file is damaged, has no checksums, or is a log with a gap; the message is
            that of `carrom verify`
    """
    command = [os.fspath(find_program(program)), "verify", os.fspath(path)]
    done = subprocess.run(
        command, capture_output=True, text=True, errors="replace", stdin=subprocess.DEVNULL
    )
    if done.returncode != 0:
        said = (done.stdout + done.stderr).strip()
        raise FileError(said or f"{path}: carrom verify ended with code {done.returncode}")
