# SPDX-License-Identifier: BSD-3-Clause
"""No two modules of the package import each other, also not through others, inside functions, or
for types alone. So each can be read after those that it names."""

from __future__ import annotations

import ast
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

import carrom

Graph = dict[str, set[str]]


def modules_of(folder: Path) -> dict[str, str]:
    """Return the sources of a package by the names of its modules; the extension has a stub."""
    sources = {}
    for path in [*folder.rglob("*.py"), *folder.rglob("*.pyi")]:
        parts = path.relative_to(folder.parent).with_suffix("").parts
        name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
        sources[name] = path.read_text(encoding="utf-8")
    return sources


def imports_of(name: str, source: str, known: set[str]) -> set[str]:
    """Return the modules that a module imports anywhere in its text."""
    found = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            whole = [f"{node.module}.{alias.name}" for alias in node.names]
            found |= {one if one in known else str(node.module) for one in whole}
    return (found & known) - {name}


def graph_of(sources: dict[str, str]) -> Graph:
    return {name: imports_of(name, text, set(sources)) for name, text in sources.items()}


def test_there_are_no_circles() -> None:
    graph = graph_of(modules_of(Path(carrom.__file__).parent))
    assert "carrom.disc_arrays" in graph["carrom.frame"]
    TopologicalSorter(graph).prepare()


def test_a_circle_for_types_alone_would_be_found() -> None:
    sources = {
        "carrom.a": "def late():\n    from carrom import b\n",
        "carrom.b": "if TYPE_CHECKING:\n    from carrom.a import late\n",
    }
    with pytest.raises(CycleError):
        TopologicalSorter(graph_of(sources)).prepare()
