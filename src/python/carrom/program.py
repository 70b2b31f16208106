# SPDX-License-Identifier: BSD-3-Clause
"""Where the program and the MPI launcher are."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

from carrom.errors import ProgramNotFoundError

_ADVICE = "build it (see docs/start/install.md), put it on PATH, or set CARROM to its path"


def find_program(program: str | os.PathLike[str] | None = None) -> Path:
    """Return the path of the program `carrom`.

    The first of these counts: the argument, the environment variable CARROM, `carrom` on PATH,
    `build/carrom` of the checkout that holds this package or the working folder.

    Raises:
        ProgramNotFoundError: none of them is a program; the message says where it looked
    """
    named = os.fspath(program) if program is not None else os.environ.get("CARROM", "")
    if named:
        found = shutil.which(named)
        if found is None:
            source = "the argument `program`" if program is not None else "CARROM"
            raise ProgramNotFoundError(f"{source} names no program: {named}; {_ADVICE}")
        return Path(found).absolute()
    if (found := shutil.which("carrom")) is not None:
        return Path(found).absolute()
    looked = [folder / "build" / "carrom" for folder in _checkouts()]
    for path in looked:
        if os.access(path, os.X_OK) and path.is_file():
            return path
    places = ", ".join(["PATH", *map(str, looked)])
    raise ProgramNotFoundError(f"the program carrom is not in {places}; {_ADVICE}")


def _checkouts() -> list[Path]:
    """Folders above this package and above the working folder that look like a checkout."""
    above = [*Path(__file__).resolve().parents, Path.cwd(), *Path.cwd().parents]
    marked = [folder for folder in above if (folder / "src" / "python" / "carrom").is_dir()]
    return list(dict.fromkeys(marked))


def find_launcher(launcher: str | os.PathLike[str] | None = None) -> str:
    """Return the MPI launcher: the argument, CARROM_MPIEXEC, `mpiexec` or `mpirun` on PATH."""
    named = os.fspath(launcher) if launcher is not None else os.environ.get("CARROM_MPIEXEC", "")
    for name in [named] if named else ["mpiexec", "mpirun"]:
        if (found := shutil.which(name)) is not None:
            return found
    what = named or "mpiexec or mpirun"
    raise ProgramNotFoundError(f"no MPI launcher: {what} is not on PATH; install Open MPI or MPICH")


def program_version(program: str | os.PathLike[str] | None = None) -> str:
    """Return the version that the program prints, for example "0.2.0".

    Raises:
        ProgramNotFoundError: there is no program, or it prints none
    """
    command = [str(find_program(program)), "--version"]
    try:
        done = subprocess.run(command, check=True, capture_output=True, text=True)
    except (OSError, subprocess.CalledProcessError) as error:
        raise ProgramNotFoundError(f"{command[0]}: prints no version: {error}") from None
    words = done.stdout.split()
    return next((word for word in words if word[:1].isdigit()), " ".join(words))
