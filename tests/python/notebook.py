# SPDX-License-Identifier: BSD-3-Clause
"""notebook.py NOTEBOOK: execute a notebook here, and keep it with its outputs and pictures.

Fails if a cell fails, if nothing is drawn, or if git has it with outputs.
"""

import base64
import sys
import time
from pathlib import Path

import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError
from traitlets.config import Config

# Notebooks that start at the same time may choose the same ports; files have names of their own.
CONFIG = Config({"KernelManager": {"transport": "ipc"}})


def main() -> None:
    path = Path(sys.argv[1])
    notebook = nbformat.read(path, as_version=4)
    nbformat.validate(notebook)
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    if any(cell.outputs or cell.execution_count for cell in code):
        sys.exit(f"{path}: has outputs; strip them before they go into git")
    start = time.monotonic()
    try:
        resources = {"metadata": {"path": "."}}
        NotebookClient(notebook, timeout=500, resources=resources, config=CONFIG).execute()
    except CellExecutionError as error:
        sys.exit(f"{path}: {error}")
    finally:
        nbformat.write(notebook, path.name)
    pictures = [
        output["data"]["image/png"]
        for cell in code
        for output in cell.outputs
        if "image/png" in output.get("data", {})
    ]
    for number, picture in enumerate(pictures):
        Path(f"{path.stem}-{number}.png").write_bytes(base64.b64decode(picture))
    print(f"{path.name}: {time.monotonic() - start:.0f} s, {len(pictures)} pictures")
    if not pictures:
        sys.exit(f"{path}: draws nothing")


main()
