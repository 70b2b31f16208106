# SPDX-License-Identifier: BSD-3-Clause
"""No function of the package that writes a file replaces one of a run."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

import carrom
from carrom import scaling
from carrom.plot import commands

ROW: scaling.Row = dict.fromkeys(scaling.COLUMNS, 1)


def writers(run: carrom.Run) -> dict[str, Callable[[Path], object]]:
    folder = str(run.folder)
    return {
        "gsd": lambda path: carrom.to_gsd(run, path, walls="apart"),
        "table": lambda path: scaling.write_table([ROW], path),
        "scaling plot": lambda path: scaling.plot([ROW], path),
        "movie": lambda path: carrom.plot.movie(run, path),
        "history": lambda path: _drawn(["history", folder, "-o", str(path)]),
        "frame": lambda path: _drawn(["frame", folder, "-o", str(path)]),
    }


def _drawn(words: list[str]) -> None:
    if commands.main(words) != 0:
        raise carrom.FileError("carrom-plot has printed why")


def content(folder: Path) -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize("name", ["gsd", "table", "scaling plot", "movie", "history", "frame"])
def test_files_of_runs_stay(run: carrom.Run, tmp_path: Path, name: str) -> None:
    pytest.importorskip("gsd" if name == "gsd" else "matplotlib")
    write = writers(run)[name]
    folder = tmp_path / "copy"
    shutil.copytree(Path(str(run.folder)), folder)
    shutil.copy(next((folder / "checkpoints").iterdir()), tmp_path / "kept")
    shutil.copy(folder / "scene.toml", tmp_path / "mine.toml")
    os.symlink(folder / "report.json", tmp_path / "link")
    before = content(tmp_path)
    victims = [path for path in before if path.suffix in (".h5", ".toml", ".json", ".csv")]
    victims += [folder / "measurements/new.gif", folder / "checkpoints/a/b.png"]
    victims += [tmp_path / "kept", tmp_path / "link"]
    assert len(victims) > 6
    for path in victims:
        with pytest.raises(carrom.FileError):
            write(path)
    assert content(tmp_path) == before


def test_what_a_function_has_written_it_replaces(tmp_path: Path) -> None:
    path = tmp_path / "scaling.csv"
    for _ in range(2):
        scaling.write_table([ROW], path)
    assert path.read_text().startswith("ranks,")
