# SPDX-License-Identifier: BSD-3-Clause
"""What IPython offers for a text, in a session of its own."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

import carrom

if TYPE_CHECKING:
    from collections.abc import Iterable

SESSION = """
import json, sys, warnings
from IPython.core.interactiveshell import InteractiveShell

shell = InteractiveShell.instance()
shell.run_cell("import carrom")
shell.run_cell(sys.argv[1])
warnings.simplefilter("ignore")
offers = {}
for text in sys.argv[2:]:
    completions = shell.Completer.completions(text, len(text))
    offers[text] = [completion.text.lstrip(".") for completion in completions]
print(json.dumps(offers))
"""


def offers_after(cell: str, texts: Iterable[str]) -> dict[str, list[str]]:
    """Return the names that each text completes to, once the cell has run."""
    pytest.importorskip("IPython", reason="IPython is not installed")
    environment = os.environ | {"PYTHONPATH": str(Path(carrom.__file__).parents[1])}
    command = [sys.executable, "-c", SESSION, cell, *texts]
    done = subprocess.run(command, capture_output=True, text=True, env=environment, check=True)
    found: dict[str, list[str]] = json.loads(done.stdout.splitlines()[-1])
    return found
