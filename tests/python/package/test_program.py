# SPDX-License-Identifier: BSD-3-Clause
"""The program is found where it is, and its absence is an error that says what to do."""

from __future__ import annotations

from pathlib import Path

import pytest

import carrom
from carrom.program import foreign_launcher


def test_wrong_path_in_environment_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CARROM", "/nowhere/carrom")
    with pytest.raises(
        carrom.ProgramNotFoundError, match="CARROM names no program: /nowhere/carrom"
    ):
        carrom.find_program()


def test_argument_counts_before_the_environment(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    program = tmp_path / "carrom"
    program.write_text("#!/bin/sh\n")
    program.chmod(0o755)
    monkeypatch.setenv("CARROM", "/nowhere/carrom")
    assert carrom.find_program(program) == program


def test_program_on_path_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program = tmp_path / "carrom"
    program.write_text("#!/bin/sh\n")
    program.chmod(0o755)
    monkeypatch.delenv("CARROM", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert carrom.find_program() == program


@pytest.mark.parametrize(
    ("environment", "launcher"),
    [
        ({}, ""),
        ({"PMI_RANK": "0", "PMI_SIZE": "2"}, ""),
        ({"OMPI_COMM_WORLD_RANK": "1", "PMIX_RANK": "1"}, "the launcher of Open MPI"),
        ({"SLURM_PROCID": "0", "PMIX_RANK": "0"}, "a launcher that speaks PMIx"),
    ],
)
def test_launchers_that_mpich_does_not_know(environment: dict[str, str], launcher: str) -> None:
    assert foreign_launcher(environment) == launcher
