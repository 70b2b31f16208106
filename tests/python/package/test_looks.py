# SPDX-License-Identifier: BSD-3-Clause
"""How runs, tables and frames look in a notebook, and what a name completes to."""

from __future__ import annotations

import os
import subprocess
import sys
import types
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
from conftest import gas

import carrom
from carrom.progress import bar_html


def parsed(html: str) -> ElementTree.Element:
    """Read HTML that is also XML; a mistake in it is an error."""
    return ElementTree.fromstring(f"<body>{html}</body>")


def words(html: str) -> list[str]:
    return [text.strip() for text in parsed(html).itertext() if text.strip()]


def test_a_run_shows_its_state(run: carrom.Run) -> None:
    shown = words(run._repr_html_())
    assert run.state_hash in shown
    assert "finished" in shown
    assert shown[shown.index("frames") + 1] == "5"


def test_a_run_that_has_just_begun_is_shown_too(tmp_path: Path) -> None:
    (tmp_path / "scene.toml").write_text("[box]\nsize = 3\n")
    assert "not finished" in words(carrom.open(tmp_path)._repr_html_())


def test_a_frame_shows_its_discs(run: carrom.Run) -> None:
    frame = run.frames[2]
    html = frame._repr_html_()
    assert "frame of step 10" in words(html)
    circles = [item for item in parsed(html).iter() if item.tag == "circle"]
    assert len(circles) == 60
    drawn = np.array(
        [[float(circle.get(key, "nan")) for key in ("cx", "cy", "r")] for circle in circles]
    )
    assert drawn[:, 0] == pytest.approx(frame.x[:, 0], rel=1e-5)
    assert drawn[:, 1] == pytest.approx(20 - frame.x[:, 1], rel=1e-5, abs=1e-4)
    assert drawn[:, 2] == pytest.approx(frame.radius, rel=1e-3)


def test_a_table_shows_its_ends(run: carrom.Run) -> None:
    table = run.tables["radial_distribution"]
    html = table._repr_html_()
    assert html is not None
    body = [item for item in parsed(html).iter() if item.tag == "tr"]
    assert len(body) == 1 + 10 + 1 + 10
    assert table["g"]._repr_html_() is None
    assert "from, to, pairs, g, g_error" in words(run.tables._repr_html_())


def test_what_is_shown_is_escaped() -> None:
    table = carrom.Table.from_columns({"a<b": ["<script>"]})
    html = table._repr_html_()
    assert html is not None
    assert words(html)[1:] == ["a<b", "<script>"]


def test_sequences_show_what_is_in_them(run: carrom.Run, tmp_path: Path) -> None:
    assert "position, velocity, collisions" in words(run.frames._repr_html_())
    assert "step 20" in words(run.checkpoints._repr_html_())
    nothing = carrom.Frames(None, "nobody")
    assert words(nothing._repr_html_()) == ["no frames of nobody"]


def test_names_complete_to_what_is_there(run: carrom.Run) -> None:
    assert run.tables._ipython_key_completions_() == list(run.tables)
    assert run.tables["thermo"]._ipython_key_completions_()[:2] == ["step", "time"]


def test_a_bar_is_as_long_as_the_run() -> None:
    bar = parsed(bar_html("step 30 of 120 (25 %), <1 s left")).find("progress")
    assert bar is not None
    assert (bar.get("value"), bar.get("max")) == ("30", "120")


def test_notebooks_show_a_bar(
    program: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """With a kernel in the place of Jupyter's, that keeps all it is to show."""
    shown: list[str] = []

    class Handle:
        def update(self, html: str) -> None:
            shown.append(html)

    fake: Any = types.ModuleType("IPython.display")
    fake.HTML = str
    fake.display = lambda html, display_id: Handle()
    monkeypatch.setitem(sys.modules, "IPython", types.ModuleType("IPython"))
    monkeypatch.setitem(sys.modules, "IPython.display", fake)
    monkeypatch.setitem(sys.modules, "ipykernel", types.ModuleType("ipykernel"))
    carrom.sweep(gas(steps=2), {"discs.seed": [1, 2, 3]}, folder=tmp_path)
    assert [bar_html(f"{n} of 3 runs done, 0 failed") for n in (1, 2, 3)] == shown[:-1]
    assert shown[-1] == ""
    assert capsys.readouterr().err == ""


def test_plot_is_there_without_an_import_of_its_own() -> None:
    code = "import carrom; print(carrom.plot.__name__)"
    environment = os.environ | {"PYTHONPATH": str(Path(carrom.__file__).parents[1])}
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env=environment, check=True
    )
    assert done.stdout.strip() == "carrom.plot"


def test_a_star_import_keeps_open() -> None:
    names: dict[str, Any] = {}
    exec("from carrom import *", names)
    assert "open" not in names
    assert names["open_run"] is carrom.open
