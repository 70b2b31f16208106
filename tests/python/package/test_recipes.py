# SPDX-License-Identifier: BSD-3-Clause
"""The recipes of docs/how-to/python-loop.md, and what they must come to."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytestmark = pytest.mark.usefixtures("extension")


@pytest.fixture(scope="module")
def names() -> dict[str, Any]:
    """All names after the cells were run in their order."""
    source = os.environ.get("CARROM_SOURCE_DIR", str(Path(__file__).parents[3]))
    page = Path(source) / "docs/how-to/python-loop.md"
    cells = re.findall(r"^```python\n(.*?)^```", page.read_text(encoding="utf-8"), re.M | re.S)
    assert len(cells) == 3
    found: dict[str, Any] = {}
    for cell in cells:
        exec(cell, found)
    return found


def test_discs_on_springs_have_boltzmanns_distribution(names: dict[str, Any]) -> None:
    """Equipartition to the 3 % of 100 discs' fluctuations; a Gaussian has <r^4> = 2 <r^2>^2."""
    from_places = names["stiffness"] * np.mean(names["squares"])
    assert from_places == pytest.approx(names["temperature"], rel=0.03)
    gauss = np.mean(names["fourths"]) / (8 * np.mean(names["squares"]) ** 2)
    assert gauss == pytest.approx(1, abs=0.08)


def test_propensity_is_no_noise(names: dict[str, Any]) -> None:
    """Halves of the branches agree on which discs move, which shuffled discs would not."""
    flown = np.array(names["flown"])
    halves = flown[::2].mean(axis=0), flown[1::2].mean(axis=0)
    assert np.corrcoef(*halves)[0, 1] > 0.3


def test_the_demon_cools_the_left(names: dict[str, Any]) -> None:
    energies, left = names["energies"], names["left"]
    assert energies[left].mean() < 0.8 * energies[~left].mean()
