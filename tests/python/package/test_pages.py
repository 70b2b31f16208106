# SPDX-License-Identifier: BSD-3-Clause
"""Blocks of pages that need the extension, which the tests of pages lack."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest

pytestmark = pytest.mark.usefixtures("extension")

SOURCE = Path(os.environ.get("CARROM_SOURCE_DIR", str(Path(__file__).parents[3])))
FIRST_BLOCKS = [
    "docs/lessons/python.md",
    "docs/reference/python.md",
    "docs/how-to/python-loop.md",
    "src/python/README.md",
]


@pytest.mark.parametrize("page", FIRST_BLOCKS)
def test_the_first_block_of_each_page_runs(
    page: str,
    program: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    text = (SOURCE / page).read_text(encoding="utf-8")
    block = re.findall(r"^```python\n(.*?)^```", text, re.M | re.S)[0]
    assert "carrom.Simulation(" in block, "pages lead with it"
    monkeypatch.chdir(tmp_path)
    exec(block, {})
    printed = capsys.readouterr().out.splitlines()
    if page == "docs/lessons/python.md":
        collisions, energy = printed[0].split()
        assert f"collide {collisions} times" in text
        assert float(energy) == pytest.approx(200)
        assert printed[1] == "True"
    if page == "docs/reference/python.md":
        assert float(printed[0].split()[-1]) == pytest.approx(2.3e-9, rel=0.05)
        assert "to 2e-9 lengths" in text
    if page == "docs/how-to/python-loop.md":
        assert abs(float(printed[0]) - 1) < 0.01, "the energy of discs and springs"
