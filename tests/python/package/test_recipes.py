# SPDX-License-Identifier: BSD-3-Clause
"""The recipes of docs/how-to/python-loop.md: each as a cell that draws, and what they come to."""

from __future__ import annotations

import math
import os
import re
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytestmark = pytest.mark.usefixtures("extension")

SECONDS = 60  # of processor time a cell, on one thread


@pytest.fixture(scope="module")
def names() -> dict[str, Any]:
    """All names after the cells were run in their order, and what each has taken and drawn."""
    plt = pytest.importorskip("matplotlib.pyplot", reason="matplotlib is not installed")
    plt.switch_backend("Agg")
    source = os.environ.get("CARROM_SOURCE_DIR", str(Path(__file__).parents[3]))
    page = Path(source) / "docs/how-to/python-loop.md"
    cells = re.findall(r"^```python\n(.*?)^```", page.read_text(encoding="utf-8"), re.M | re.S)
    found: dict[str, Any] = {"cells": []}
    for cell in cells:
        plt.close("all")
        begin = time.process_time()
        exec(cell, found)
        found["cells"].append((time.process_time() - begin, len(plt.get_fignums())))
    plt.close("all")
    return found


def test_each_is_a_cell_of_less_than_a_minute_with_a_plot(names: dict[str, Any]) -> None:
    assert len(names["cells"]) == 5
    for seconds, figures in names["cells"]:
        assert seconds < SECONDS
        assert figures == 1


def test_discs_on_springs_have_boltzmanns_distribution(names: dict[str, Any]) -> None:
    """Equipartition to the 3 % of 100 discs' fluctuations; a Gaussian has <r^4> = 2 <r^2>^2."""
    places = names["trapped"]
    assert names["stiffness"] * np.mean(places**2) == pytest.approx(names["temperature"], rel=0.03)
    fourth = np.mean(np.sum(places**2, axis=1) ** 2)
    assert fourth / (8 * np.mean(places**2) ** 2) == pytest.approx(1, abs=0.08)


def test_a_washboard_has_boltzmanns_distribution(names: dict[str, Any]) -> None:
    """The mean of the cosine is -I1/I0 by theory, of 400 discs to 3 %, and so is the histogram."""
    z = names["depth"] / names["kT"]
    first = sum(
        (z / 2) ** (2 * k + 1) / (math.factorial(k) * math.factorial(k + 1)) for k in range(30)
    )
    cosine = np.mean(np.cos(np.concatenate(names["phases"])))
    assert cosine == pytest.approx(-first / np.i0(z), rel=0.05)
    np.testing.assert_allclose(names["counts"], names["boltzmann"], rtol=0.1)
    assert names["counts"].max() > 2 * names["counts"].min()


def test_propensity_is_no_noise(names: dict[str, Any]) -> None:
    """Halves of the branches agree on which discs move, which shuffled discs would not."""
    assert np.corrcoef(*names["halves"])[0, 1] > 0.3


def test_the_demon_cools_the_left_until_it_is_forgotten(names: dict[str, Any]) -> None:
    """Energy is conserved throughout; without the demon equipartition comes back."""
    steps, cold, hot = names["steps"], names["cold"], names["hot"]
    at_work, later = (steps > 2000) & (steps <= 2500), steps > 3500
    assert cold[at_work].mean() < 0.8 * hot[at_work].mean()
    assert cold[later].mean() == pytest.approx(hot[later].mean(), rel=0.15)
    assert names["gas"].energy == pytest.approx(names["energy"], rel=1e-12)


def test_the_controller_keeps_the_pressure_of_the_equation_of_state(names: dict[str, Any]) -> None:
    """Both means are over 100 turns, whose pressures scatter by some 2 % each."""
    pressure, theory = names["pressures"][-100:].mean(), names["theory"][-100:].mean()
    assert pressure == pytest.approx(names["wanted"], rel=0.02)
    assert theory == pytest.approx(names["wanted"], rel=0.03)
