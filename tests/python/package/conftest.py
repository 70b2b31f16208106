# SPDX-License-Identifier: BSD-3-Clause
"""Runs of the real program, which tests share, and the program's own text output."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

import carrom

# Tests share the machine: threads that wait must not spin.
os.environ.setdefault("OMP_WAIT_POLICY", "passive")
os.environ.setdefault("OMP_NUM_THREADS", "1")

Lines = dict[int, npt.NDArray[np.float64]]
Scene = dict[str, Any]

PERIODIC = {side: {"kind": "periodic"} for side in ("left", "right", "bottom", "top")}


def gas(count: int = 60, steps: int = 20, **box: Any) -> Scene:
    """A small gas that collides often."""
    return {
        "box": {"size": 20, **box},
        "discs": {"count": count, "packing": 0.3},
        "time": {"steps": steps, "method": "event-driven"},
    }


def measured(method: str = "event-driven", **box: Any) -> dict[str, Any]:
    scene = gas(count=100, steps=40, **box)
    scene["time"]["method"] = method
    quantities = ["radial_distribution", "displacement", "thermo", "velocities"]
    scene["output"] = {"measurements": {"quantities": quantities, "every_steps": 4}}
    return scene


@pytest.fixture(scope="session")
def extension() -> None:
    """The extension; without it there is no `carrom.Simulation` to test."""
    try:
        carrom.core_module.load()
    except carrom.MissingPackageError as error:
        pytest.skip(str(error))


@pytest.fixture(scope="session")
def program() -> Path:
    """The program; without it there is nothing to test."""
    try:
        return carrom.find_program()
    except carrom.ProgramNotFoundError as error:
        pytest.skip(str(error))


@pytest.fixture
def converted(program: Path, tmp_path: Path) -> Callable[[Path], Lines]:
    """A function that reads a file by `carrom convert FILE --to text`."""

    def read(path: Path) -> Lines:
        text = tmp_path / "converted.txt"
        command = [str(program), "convert", str(path), "--to", "text", "--output", str(text)]
        subprocess.run(command, check=True)
        return carrom.read_lines(text)

    return read


@pytest.fixture(scope="session")
def run(program: Path, tmp_path_factory: pytest.TempPathFactory) -> carrom.Run:
    """A run with all that a run can write."""
    scene = gas() | {
        "output": {
            "text": "every_step",
            "collisions": True,
            "trajectory": {"every_steps": 5, "fields": ["position", "velocity", "collisions"]},
            "checkpoint": {"every_steps": 10, "keep": 5},
            "measurements": {
                "quantities": [
                    "radial_distribution",
                    "wall_pressure",
                    "velocities",
                    "displacement",
                    "thermo",
                ],
                "every_steps": 2,
            },
        }
    }
    return carrom.run(scene, threads=1, folder=tmp_path_factory.mktemp("runs") / "all")
