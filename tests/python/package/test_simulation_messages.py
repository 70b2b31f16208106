# SPDX-License-Identifier: BSD-3-Clause
"""Mistakes in calls of `carrom.Simulation`: one line that names the mistake and the remedy."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import gas

import carrom

pytestmark = pytest.mark.usefixtures("extension")


def first_line(error: BaseException) -> str:
    return str(error).splitlines()[0]


def wrong(scene: Any, **overrides: Any) -> list[str]:
    with pytest.raises(carrom.SceneError) as caught:
        carrom.Simulation(scene, **overrides)
    return caught.value.lines


def test_a_misspelled_table_names_the_right_one() -> None:
    scene = gas()
    scene["disc"] = scene.pop("discs")
    assert wrong(scene)[0] == "no such key 'disc'; did you mean 'discs'?"
    assert wrong(gas(), disc__seed=3) == ["no such key 'disc'; did you mean 'discs'?"]


def test_a_misspelled_argument_names_the_right_one(program: Path, tmp_path: Path) -> None:
    assert wrong(gas(), thread=2) == ["no argument thread; did you mean threads=2?"]
    with pytest.raises(carrom.InputError, match=r"^no argument rank; did you mean ranks=2\?"):
        carrom.run(gas(), folder=tmp_path / "run", rank=2)


def test_a_dictionary_has_keys_and_no_lines() -> None:
    scene = gas() | {"output": {"measurements": {"quantities": ["thermo"], "every_steps": 1.5}}}
    scene["time"]["method"] = "event-drivn"
    lines = wrong(scene, box__size=-1)
    assert len(lines) == 3
    assert not any("scene.toml" in line for line in lines), lines
    for key in ("box.size", "time.method", "output.measurements.every_steps"):
        assert sum(key in line for line in lines) == 1, lines
    # The program names the line of this mistake, but no key.
    walls = gas() | {"output": {"trajectory": {"every_steps": 5, "fields": ["image"]}}}
    with pytest.warns(carrom.CarromWarning):
        (line,) = wrong(walls)
    assert line.startswith('output.trajectory.fields: cannot have "image"')
    assert wrong({"box": {"size": 3}})[0].startswith("'discs.count' is missing")


def test_a_text_has_lines_of_its_own() -> None:
    text = carrom.to_toml(gas()).replace("size = 20", "size = -20")
    assert wrong(text) == ["line 2 of the scene: 'box.size' must be from 2^-230 to 2^250, not -20"]
    with pytest.raises(carrom.FileError, match=r"^the scene's text: Expected"):
        carrom.Simulation("[box\nsize = 3\n")


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda s: s.run(1.5), "run takes a whole number of steps, not 1.5"),
        (lambda s: s.run(np.float64(2)), r"run takes a whole number of .*2\.0.*; try: 2"),
        (lambda s: s.run("2"), "run takes a whole number of steps, not '2'"),
        (lambda s: s.every(0.5, print), "interval must be a whole number of steps, not 0.5"),
        (lambda _: carrom.Simulation(gas(), threads=1.5), "threads must be a whole number, not 1"),
        (lambda s: setattr(s, "spins", None), "spins are real numbers, not None"),
    ],
)
def test_whole_numbers_are_asked_for_in_words(call: Any, message: str) -> None:
    with pytest.raises(TypeError, match=f"^{message}"):
        call(carrom.Simulation(gas()))


def test_rows_of_different_lengths() -> None:
    sim = carrom.Simulation(gas())
    with pytest.raises(ValueError, match=r"^velocities have the shape \(60, 2\), and rows of one"):
        sim.velocities = [[1, 2], [3]]


def test_a_checkpoint_needs_its_folder(tmp_path: Path) -> None:
    sim = carrom.Simulation(gas())
    with pytest.raises(carrom.OutputError) as caught:
        sim.checkpoint(tmp_path / "nowhere" / "c.h5")
    folder = tmp_path / "nowhere"
    assert caught.value.lines == [
        f"{folder}/c.h5: cannot be written, because there is no folder {folder}; make it first"
    ]
    sim.run(1)


def test_smooth_discs_have_no_spins() -> None:
    sim = carrom.Simulation(gas())
    for spins in ([0.1] * 60, np.full(60, 0.1)):
        with pytest.raises(carrom.SceneError) as caught:
            sim.spins = spins
        assert caught.value.lines == [
            "change: discs are smooth, and only rough discs turn; leave out their spins, or set "
            'effects.contact.kind = "rough" in the scene'
        ]
    sim.spins = [0] * 60
    contact = {"kind": "rough", "restitution": 0.9, "tangential_restitution": 0.5}
    rough = carrom.Simulation(gas() | {"effects": {"contact": contact}})
    rough.spins = [0.1] * 60
    assert rough.spins.tolist() == [0.1] * 60
