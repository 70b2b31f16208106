# SPDX-License-Identifier: BSD-3-Clause
"""Where the extension is, and the first thing to do with it."""

from __future__ import annotations

import atexit
import importlib
import importlib.machinery
import importlib.util
import os
import sys
import threading
from functools import cache
from pathlib import Path
from typing import Any

from carrom.errors import ERROR_OF_CODE, MissingPackageError, ProgramError, SceneError
from carrom.held_core import end_left
from carrom.program import checkouts
from carrom.words import in_python

_NAME = "carrom._core"
_ADVICE = (
    "install a wheel that holds it, or build it in a checkout: pip install nanobind; cmake -S . "
    "-B build-python -DCARROM_PYTHON=ON -DPython_EXECUTABLE=$(which python3); cmake --build "
    "build-python --target carrom_python; then work in the checkout, or let CARROM_CORE be the "
    "path of build-python/python/carrom/_core*.so"
)


@cache
def load() -> Any:
    """Return the extension.

    It is found in the package (wheels hold it), by the variable CARROM_CORE, which names its file,
    or in `build-python/` of a checkout. Threads of OpenMP that wait for more than some 50
    microseconds sleep, as those of the program do, unless `OMP_WAIT_POLICY` or `GOMP_SPINCOUNT` is
    set.

    Raises:
        MissingPackageError: it is not there, or does not fit this Python
    """
    if not {"OMP_WAIT_POLICY", "GOMP_SPINCOUNT"} & os.environ.keys():
        os.environ.update(OMP_WAIT_POLICY="passive", GOMP_SPINCOUNT="1000")
    core = _imported()
    core.make_errors_by(error_of)
    atexit.register(_end, core)
    core.thread, core.process = threading.get_ident(), os.getpid()
    return core


def _end(core: Any) -> None:
    """End MPI with the last simulation, in the process that has started it."""
    end_left()
    core.end_session(os.getpid() != core.process)


def _imported() -> Any:
    named = os.environ.get("CARROM_CORE", "")
    paths = [Path(named)] if named else _built()
    if not named:
        try:
            return importlib.import_module(_NAME)
        except ModuleNotFoundError:
            pass
        except ImportError as error:
            raise MissingPackageError(f"carrom.Simulation: {error}; {_ADVICE}") from None
    for path in paths:
        spec = importlib.util.spec_from_file_location(_NAME, path)
        if spec is None or spec.loader is None or not path.is_file():
            continue
        try:
            module = importlib.util.module_from_spec(spec)
            spec.loader.exec_module(module)
        except ImportError as error:
            raise MissingPackageError(f"carrom.Simulation: {path}: {error}; {_ADVICE}") from None
        sys.modules[_NAME] = module
        return module
    where = f"; CARROM_CORE names no extension: {named}" if named else ""
    raise MissingPackageError(
        f"carrom.Simulation needs the extension, which this installation lacks{where}; {_ADVICE}"
    )


def _built() -> list[Path]:
    """Return extensions that a checkout has built, those for this Python alone."""
    suffixes = importlib.machinery.EXTENSION_SUFFIXES
    folders = [folder / "build-python" / "python" / "carrom" for folder in checkouts()]
    return [folder / f"_core{suffix}" for folder in folders for suffix in suffixes]


def error_of(lines: list[str], code: int) -> ProgramError:
    """Make the exception for an error of the library, in Python's words."""
    words = [in_python(line) for line in lines]
    kind: type[ProgramError] = SceneError if code == 2 else ERROR_OF_CODE.get(code, ProgramError)
    return kind(words, code)
