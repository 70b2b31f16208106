# SPDX-License-Identifier: BSD-3-Clause
"""Checking files byte by byte, which the program does."""

from __future__ import annotations

import os
import subprocess
import warnings
from pathlib import Path

from carrom.errors import FileError, ProgramNotFoundError
from carrom.program import find_program

_UNSURE = {5, 6}  # exit codes: no checksums; a log with a gap
_LAUNCHERS = ("OMPI_", "PMIX_", "PMI_", "SLURM_", "PALS_", "ALPS_", "FLUX_")


def verify(path: str | os.PathLike[str], program: str | os.PathLike[str] | None = None) -> None:
    """Check every byte of a checkpoint, a trajectory or a log, and that its discs are possible.

    `carrom.open` does so when a file is first read. Files that are read in another way, and a
    recording that has grown since, are checked by this function alone.

    Args:
        path: the file; of a recording the one that joins the segments, `trajectory.h5`
        program: see `carrom.find_program`

    Raises:
        FileError: the file is damaged, has no checksums, or is a log with a gap; the message is
            that of `carrom verify`
    """
    code, text = _judge(path, program)
    if code != 0:
        raise FileError(text)


def check(path: str | os.PathLike[str]) -> None:
    """Compare the checksums of a file that is about to be read.

    It may belong to a run that goes on: where another file took its place meanwhile, that one is
    checked. Without the program nothing can be compared, which is a warning, as is a file that
    another program has rewritten without checksums.
    """
    if not Path(path).is_file():
        return  # the reader reports a missing file
    try:
        for _ in range(3):
            before = _version(path)
            code, text = _judge(path, None)
            if code == 0 or _version(path) == before:
                break
    except ProgramNotFoundError as error:
        warnings.warn(f"{path}: is read without comparing checksums: {error}", stacklevel=4)
        return
    if code in _UNSURE:
        warnings.warn(text, stacklevel=4)
    elif code != 0:
        raise FileError(text)


def _version(path: str | os.PathLike[str]) -> object:
    try:
        status = os.stat(path)
    except OSError:
        return None
    return status.st_ino, status.st_mtime_ns, status.st_size


def _judge(path: str | os.PathLike[str], program: str | os.PathLike[str] | None) -> tuple[int, str]:
    """Return the exit code of `carrom verify`, and what it printed."""
    command = [os.fspath(find_program(program)), "verify", os.fspath(path)]
    # With these variables the program would act as a rank of this process's launcher.
    alone = {name: text for name, text in os.environ.items() if not name.startswith(_LAUNCHERS)}
    done = subprocess.run(
        command,
        capture_output=True,
        text=True,
        errors="replace",
        stdin=subprocess.DEVNULL,
        env=alone,
    )
    said = (done.stdout + done.stderr).strip()
    return done.returncode, said or f"{path}: carrom verify ended with code {done.returncode}"
