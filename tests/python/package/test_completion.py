# SPDX-License-Identifier: BSD-3-Clause
"""What the completer of IPython offers, each case in the state that a user's session is in."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import carrom

SESSION = """
import json, sys, warnings
from IPython.core.interactiveshell import InteractiveShell

shell = InteractiveShell.instance()
shell.run_cell("import carrom")
shell.run_cell(f"run = carrom.open({sys.argv[1]!r}, check=False)")
warnings.simplefilter("ignore")
offers = {}
for text in sys.argv[2:]:
    completions = shell.Completer.completions(text, len(text))
    offers[text] = [completion.text.lstrip(".") for completion in completions]
print(json.dumps(offers))
"""

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
    pytest.importorskip("IPython", reason="IPython is not installed")
    environment = os.environ | {"PYTHONPATH": str(Path(carrom.__file__).parents[1])}
    command = [sys.executable, "-c", SESSION, str(run.folder), *WANTED]
    done = subprocess.run(command, capture_output=True, text=True, env=environment, check=True)
    found: dict[str, list[str]] = json.loads(done.stdout.splitlines()[-1])
    return found


@pytest.mark.parametrize("text", WANTED)
def test_names_complete(offers: dict[str, list[str]], text: str) -> None:
    assert WANTED[text] <= set(offers[text])


def test_nothing_else_is_offered(offers: dict[str, list[str]], run: carrom.Run) -> None:
    """Names of files, magics or helpers would bury what is there."""
    assert set(offers["carrom.plot."]) == set(carrom.plot.__all__)
    assert set(offers['run.tables["']) == set(run.tables)
    assert set(offers['run.thermo["']) == set(run.thermo.columns)
