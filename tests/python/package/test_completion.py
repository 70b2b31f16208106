# SPDX-License-Identifier: BSD-3-Clause
"""What the completer of IPython offers, each case in the state that a user's session is in."""

from __future__ import annotations

import pytest
from completion import offers_after

import carrom

WANTED = {
    'run.tables["': {"thermo", "displacement", "radial_distribution"},
    'run.thermo["': {"step", "energy", "temperature"},
    'run.tables["displacement"]["': {"steps", "sum"},
    "run.frames[0].": {"x", "v", "radius", "to_pandas", "psi6"},
    "run.checkpoints[-1].": {"x", "column", "scene"},
    "run.frames.": {"at", "to_mdanalysis", "steps"},
    "carrom.plot.": {"frame", "movie", "history"},
    "carrom.": {"run", "open", "sweep", "Run"},
}
"""What a text completes to, at least."""


@pytest.fixture(scope="module")
def offers(run: carrom.Run) -> dict[str, list[str]]:
    return offers_after(f"run = carrom.open({str(run.folder)!r}, check=False)", WANTED)


@pytest.mark.parametrize("text", WANTED)
def test_names_complete(offers: dict[str, list[str]], text: str) -> None:
    assert WANTED[text] <= set(offers[text])


def test_nothing_else_is_offered(offers: dict[str, list[str]], run: carrom.Run) -> None:
    """Names of files, magics or helpers would bury what is there."""
    assert set(offers["carrom.plot."]) == set(carrom.plot.__all__)
    assert set(offers['run.tables["']) == set(run.tables)
    assert set(offers['run.thermo["']) == set(run.thermo.columns)
