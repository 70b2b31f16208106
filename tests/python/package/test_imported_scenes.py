# SPDX-License-Identifier: BSD-3-Clause
"""Where scenes find imported discs, and which columns of a file are left out."""

from __future__ import annotations

from pathlib import Path

import pytest

import carrom
from carrom.importing import Choice, import_discs, read_discs
from carrom.importing.command import main

ROWS = "1 1 0 0 0.5 1\n5 5 0 0 0.5 1\n8 8 0 0 0.5 1\n"


def test_the_scene_names_the_file_as_the_call_did(
    program: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """A scene in the working folder finds discs in another folder, as file, text or dictionary."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "sub").mkdir()
    Path("rows.txt").write_text(ROWS, encoding="ascii")
    assert main(["rows.txt", "-o", "sub/x.h5", "--box", "10"]) == 0
    text = capsys.readouterr().out + "\n[time]\nsteps = 1\n"
    assert 'from = "sub/x.h5"' in text
    Path("scene.toml").write_text(text, encoding="ascii")
    hashes = set()
    for scene in ("scene.toml", text, carrom.read_scene(text)):
        run = carrom.run(scene, folder=f"run{len(hashes)}", overwrite=True, program=program)
        hashes.add(run.state_hash)
    path = tmp_path / "sub" / 'a "b".h5'
    scene = import_discs("rows.txt", path, Choice(box=(10, 10)), program=program).scene
    assert carrom.read_scene(scene)["discs"]["from"] == str(path)
    # A setting replaces the path of the text.
    run = carrom.run(text, discs__from="sub/../sub/x.h5", folder="set", program=program)
    assert hashes == {run.state_hash}


def test_columns_that_are_not_known_are_named(
    program: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "gas.csv"
    file.write_text("\nx,y,radius_um,R,w\n1,1,.5,.5,7\n", encoding="ascii")
    message = rf"{file}:2: columns 'radius_um', 'w' left out.*names are known: x, y,.* radius"
    with pytest.warns(carrom.CarromWarning, match=message) as caught:
        assert read_discs(file, Choice(box=(10, 10))).count == 1
    assert [warning.filename for warning in caught] == [__file__]
    with pytest.warns(carrom.CarromWarning, match=message) as caught:
        import_discs(file, tmp_path / "gas.h5", Choice(box=(10, 10)), program=program)
    assert [warning.filename for warning in caught] == [__file__]
    assert main([str(file), "-o", str(tmp_path / "gas.h5"), "--box", "10"]) == 0
    assert capsys.readouterr().err.startswith(f"warning: {file}:2: columns 'radius_um', 'w'")
