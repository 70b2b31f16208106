# SPDX-License-Identifier: BSD-3-Clause
"""Run Carrom, the hard-disc simulation, and read what it writes.

Lengths are in the scene's unit, times in steps, velocities in lengths per step and masses in
the scene's unit of mass. `docs/reference/python.md` lists all there is.
"""

from carrom import plot
from carrom.checking import verify
from carrom.checkpoints import Checkpoint
from carrom.completion import trust
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
    SceneError,
    StoppedError,
)
from carrom.frame import Frame
from carrom.frames import Frames
from carrom.gsd_file import to_gsd
from carrom.launching import CarromWarning
from carrom.live_results import LiveTables
from carrom.memory_frame import MemoryFrame
from carrom.physics import (
    Measured,
    average,
    compressibility,
    henderson,
    quantities,
    virial_equation,
)
from carrom.program import find_program, program_version
from carrom.running import resume, run
from carrom.runs import Checkpoints, Run, open_run, read_lines
from carrom.runs import open_run as open  # noqa: F401 - see below
from carrom.scene import read_scene, to_toml
from carrom.simulation import Simulation
from carrom.slurm import SlurmError
from carrom.sweeping import sweep
from carrom.sweeps import Sweep, SweepError
from carrom.tables import Table, Tables, read_csv
from carrom.trajectory_frame import TrajectoryFrame

__version__ = "0.3.0"

trust(
    [Run, TrajectoryFrame, Checkpoint, Frames, Sweep, Simulation, MemoryFrame],
    [Tables, Frames, Checkpoints, LiveTables],
)
del trust, TrajectoryFrame, MemoryFrame, LiveTables

# `open` is left out, so that `from carrom import *` does not replace that of Python.
__all__ = [
    "CarromError",
    "CarromWarning",
    "Checkpoint",
    "Checkpoints",
    "CollectiveError",
    "FileError",
    "Frame",
    "Frames",
    "InputError",
    "InvariantError",
    "Measured",
    "MissingPackageError",
    "NoDataError",
    "OutputError",
    "ProgramError",
    "ProgramNotFoundError",
    "Run",
    "SceneError",
    "Simulation",
    "SlurmError",
    "StoppedError",
    "Sweep",
    "SweepError",
    "Table",
    "Tables",
    "average",
    "compressibility",
    "find_program",
    "henderson",
    "open_run",
    "plot",
    "program_version",
    "quantities",
    "read_csv",
    "read_lines",
    "read_scene",
    "resume",
    "run",
    "sweep",
    "to_gsd",
    "to_toml",
    "verify",
    "virial_equation",
]
