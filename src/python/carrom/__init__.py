# SPDX-License-Identifier: BSD-3-Clause
"""Run Carrom, the hard-disc simulation, and read what it writes.

Lengths are in the scene's unit, times in steps, velocities in lengths per step and masses in
the scene's unit of mass. `docs/python.md` has a lesson.
"""

from carrom.errors import (
    CarromError,
    CollectiveError,
    FileError,
    InputError,
    InvariantError,
    MissingPackageError,
    NoDataError,
    OutputError,
    ProgramError,
    ProgramNotFoundError,
    StoppedError,
)
from carrom.program import find_program, program_version

__version__ = "0.2.0"

__all__ = [
    "CarromError",
    "CollectiveError",
    "FileError",
    "InputError",
    "InvariantError",
    "MissingPackageError",
    "NoDataError",
    "OutputError",
    "ProgramError",
    "ProgramNotFoundError",
    "StoppedError",
    "find_program",
    "program_version",
]
