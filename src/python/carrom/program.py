# SPDX-License-Identifier: BSD-3-Clause
"""Where the program and the MPI launcher are."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import NoReturn

from carrom.errors import ProgramNotFoundError

# Wheels hold the program; a package that was installed from the source does not.
_BUNDLED = Path(__file__).parent / "bin" / "carrom"
# pip puts the launcher of the wheel's MPI into the environment's `bin`.
_BUNDLED_LAUNCHER = os.path.normpath(Path(__file__).parent / "../../../../bin/mpiexec")
_ADVICE = "build it (see docs/start/install.md), put it on PATH, or set CARROM to its path"


def find_program(program: str | os.PathLike[str] | None = None) -> Path:
    """Return the path of the program `carrom`.

    The first of these counts: the argument, the environment variable CARROM, the program of the
    wheel that this package came with, `carrom` on PATH, `build/carrom` of the checkout that holds
    this package or the working folder.

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
    if _BUNDLED.is_file():
        return _BUNDLED
    if (found := shutil.which("carrom")) is not None:
        return Path(found).absolute()
    searched = [folder / "build" / "carrom" for folder in checkouts()]
    for path in searched:
        if os.access(path, os.X_OK) and path.is_file():
            return path
    places = ", ".join(["PATH", *map(str, searched)])
    raise ProgramNotFoundError(f"the program carrom is not in {places}; {_ADVICE}")


def checkouts() -> list[Path]:
    """Folders above this package and above the working folder that look like a checkout."""
    above = [*Path(__file__).resolve().parents, Path.cwd(), *Path.cwd().parents]
    marked = [folder for folder in above if (folder / "src" / "python" / "carrom").is_dir()]
    return list(dict.fromkeys(marked))


def find_launcher(launcher: str | os.PathLike[str] | None = None) -> str:
    """Return the MPI launcher.

    The first of these counts: the argument, the environment variable CARROM_MPIEXEC, `mpiexec` of
    this Python environment if the wheel brought the program, `mpiexec` or `mpirun` on PATH.

    Raises:
        ProgramNotFoundError: none of them is there
    """
    named = os.fspath(launcher) if launcher is not None else os.environ.get("CARROM_MPIEXEC", "")
    own = [_BUNDLED_LAUNCHER] if _BUNDLED.is_file() else []
    for name in [named] if named else [*own, "mpiexec", "mpirun"]:
        if (found := shutil.which(name)) is not None:
            return found
    what = named or "mpiexec or mpirun"
    raise ProgramNotFoundError(f"no MPI launcher: {what} is not on PATH; install Open MPI or MPICH")


def program_version(program: str | os.PathLike[str] | None = None) -> str:
    """Return the version that the program prints, for example "0.3.0".

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


def foreign_launcher(environment: Mapping[str, str]) -> str:
    """Return the launcher that started this process, if the wheel's MPICH cannot work with it.

    MPICH would say "unsupported PMI version PMIx" then.
    """
    if "PMI_RANK" in environment:
        return ""
    if "OMPI_COMM_WORLD_RANK" in environment:
        return "the launcher of Open MPI"
    return "a launcher that speaks PMIx" if "PMIX_RANK" in environment else ""


def main() -> NoReturn:
    """Become the program: what the command `carrom` of a wheel does."""
    if found := foreign_launcher(os.environ):
        if os.environ.get("PMIX_RANK", "0") == "0":  # only one rank prints it
            print(
                f"carrom: {found} has started this program, which is built with MPICH; use the "
                f"launcher of that library: {_BUNDLED_LAUNCHER} (with srun: --mpi=pmi2)",
                file=sys.stderr,
            )
        sys.exit(2)
    os.execv(find_program(), ["carrom", *sys.argv[1:]])
