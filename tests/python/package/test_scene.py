# SPDX-License-Identifier: BSD-3-Clause
"""Scenes become TOML that says the same, and overrides reach the program."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import gas

import carrom
from carrom.scene import flattened, toml_value

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


@pytest.mark.parametrize(
    "value",
    [
        True,
        -3,
        0.1,
        1e300,
        5e-324,
        1e16,
        'a "quoted" \\ text\nof two lines\t\x7f',
        [1, 2.5, [3]],
        {"region": [0, 0, 1.5, 2], "velocity": (1, 0)},
        [],
    ],
)
def test_values_come_back_from_toml(value: Any) -> None:
    back = tomllib.loads(f"value = {toml_value(value)}")["value"]
    wanted = {"region": [0, 0, 1.5, 2], "velocity": [1, 0]} if isinstance(value, dict) else value
    assert back == wanted
    assert type(back) is type(wanted)


def test_numpy_values_keep_every_bit() -> None:
    numbers = np.random.default_rng(1).standard_normal(50) * 1e-7
    assert tomllib.loads(f"v = {toml_value(numbers)}")["v"] == numbers.tolist()
    assert toml_value(np.int64(7)) == "7"
    assert toml_value(np.bool_(True)) == "true"


def test_tables_and_dotted_keys_are_nested() -> None:
    scene = {"box.size": 5, "box": {"left": {"kind": "wall"}}, "time": {"steps": 1}, "output": {}}
    text = carrom.to_toml(scene)
    assert tomllib.loads(text) == {
        "box": {"size": 5, "left": {"kind": "wall"}},
        "time": {"steps": 1},
        "output": {},
    }


def test_none_is_an_error_that_names_the_key() -> None:
    with pytest.raises(TypeError, match=r"time\.steps: a scene cannot have None"):
        carrom.to_toml({"time": {"steps": None}})


def test_a_scene_in_itself_is_an_error(tmp_path: Path) -> None:
    scene = gas()
    scene["discs"]["list"] = rows = [[1, 1, 0, 0]]
    rows.append(rows)
    looped: Any = gas()
    looped["box"]["again"] = looped
    deep: Any = {"size": 5}
    for _ in range(100_000):
        deep = {"box": deep}
    for wrong in (scene, looped, deep, {".".join("a" * 100_000): 1}):
        for act in (carrom.to_toml, lambda s: carrom.run(s, folder=tmp_path / "no")):
            with pytest.raises(ValueError, match="deep, or in themselves"):
                act(wrong)
    with pytest.raises(ValueError, match="deep, or in themselves"):
        carrom.sweep(looped, {"discs.seed": [1, 2]}, folder=tmp_path / "no")
    for text in (f"a = {'[' * 100_000}\n", f"{'.'.join('a' * 100_000)} = 1\n"):
        (tmp_path / "deep.toml").write_text(text)
        with pytest.raises((carrom.FileError, ValueError), match="deep"):
            carrom.read_scene(tmp_path / "deep.toml")


def test_overrides_have_three_spellings() -> None:
    wanted = {"time.steps": 5}
    for spelling in ({"time": {"steps": 5}}, {"time.steps": 5}, {"time__steps": 5}):
        assert flattened(spelling) == wanted


def test_remarks_of_a_stored_scene_count(tmp_path: Path) -> None:
    path = tmp_path / "scene.toml"
    path.write_text("# --set time.steps=7\n# --set discs.generator=lattice\n[time]\nsteps = 3\n")
    assert carrom.read_scene(path) == {"time": {"steps": 7}, "discs": {"generator": "lattice"}}


def test_a_dictionary_a_text_and_a_path_run_alike(program: Path, tmp_path: Path) -> None:
    scene = gas(steps=3)
    path = tmp_path / "gas.toml"
    path.write_text(carrom.to_toml(scene))
    hashes = [
        carrom.run(kind, folder=tmp_path / str(number), discs__seed=5).state_hash
        for number, kind in enumerate((scene, carrom.to_toml(scene), path, str(path)))
    ]
    assert len(set(hashes)) == 1
    other = carrom.run(scene, folder=tmp_path / "other", discs={"seed": 6})
    assert other.state_hash != hashes[0]
    assert other.scene["discs"]["seed"] == 6


def test_listed_discs_keep_every_bit(program: Path, tmp_path: Path) -> None:
    rows = [[1.1, 2.2, 0.3, -0.4], [5 / 3, 7.7, 1e-3, 0.1]]
    scene = {
        "box": {"size": 10},
        "discs": {"generator": "file", "radius": 0.5, "list": np.array(rows)},
        "time": {"steps": 0, "method": "event-driven"},
    }
    frame = carrom.run(scene, folder=tmp_path / "listed").checkpoints[-1]
    assert np.array_equal(np.hstack([frame.x, frame.v]), rows)


@pytest.mark.parametrize("kind", ["dictionary", "text"])
def test_a_file_of_discs_is_named_from_the_working_folder(
    program: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: str
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("discs.txt").write_text("0 1 2 0.5 0\n1 5 6 0 0.25\n")
    scene: Any = {
        "box": {"size": 10},
        "discs": {"generator": "file", "radius": 0.5, "file": "discs.txt", "count": 2},
        "time": {"steps": 2, "method": "event-driven"},
    }
    frame = carrom.run(
        scene if kind == "dictionary" else carrom.to_toml(scene), folder="r"
    ).checkpoints[0]
    assert np.array_equal(frame.x, [[2, 2], [5, 6.5]])
