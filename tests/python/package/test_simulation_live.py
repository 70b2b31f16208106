# SPDX-License-Identifier: BSD-3-Clause
"""Images, reports, refused arrays, bars and stubs of `carrom.Simulation`."""

from __future__ import annotations

import ast
import inspect
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from completion import offers_after
from conftest import PERIODIC, gas, measured

import carrom

pytestmark = pytest.mark.usefixtures("extension")


def unwrapped(sim: carrom.Simulation) -> Any:
    return sim.positions + sim.images * sim.box


FAST = {
    "event-driven": gas(steps=150, **PERIODIC),
    "time-stepped": gas(steps=150, **PERIODIC),
}
"""Scenes in which discs go round the box several times."""


@pytest.mark.parametrize("name", FAST)
def test_images_are_those_of_a_trajectory(program: Path, tmp_path: Path, name: str) -> None:
    scene = FAST[name]
    scene["time"]["method"] = "time-stepped" if name == "time-stepped" else "event-driven"
    frames = {"every_steps": 1, "fields": ["position", "image"]}
    run = carrom.run(scene | {"output": {"trajectory": frames}}, folder=tmp_path / "run")
    sim = carrom.Simulation(scene, threads=2)
    twin = None
    for step in (0, 1, 40, 64, 100, 150):
        sim.run(step - sim.step)
        if step == 64:
            twin = sim.copy()
            sim.checkpoint(tmp_path / "c.h5")
        assert np.array_equal(sim.images, run.frames.at(step).image), step
        assert np.array_equal(sim.frame.image, sim.images)
    assert np.abs(sim.images).max() >= 2
    assert twin is not None
    for other in (twin, carrom.Simulation(tmp_path / "c.h5")):
        other.run(150 - other.step)
        assert np.array_equal(other.images, sim.images)


def test_a_free_disc_flies_on_though_others_are_moved() -> None:
    """The place plus the images is a line; a moved disc is moved by as much as was asked for."""
    scene = {
        "box": {"size": [10, 7], **PERIODIC},
        "discs": {"list": [[2, 2, 0.73, -0.41], [7, 5, -0.9, 0.3]], "radius": 0.01},
        "time": {"method": "event-driven", "steps": 1000},
    }
    sim = carrom.Simulation(scene)
    x0, v = sim.positions, sim.velocities
    sim.run(37)
    np.testing.assert_allclose(unwrapped(sim), x0 + 37 * v, atol=1e-11)
    before, places = unwrapped(sim), sim.positions.copy()
    places[1] = places[1] * 0.5 + 1
    moved = places - sim.positions
    sim.positions = places
    np.testing.assert_allclose(unwrapped(sim), before + moved, atol=1e-11)
    sim.velocities = -v
    sim.run(100)
    np.testing.assert_allclose(unwrapped(sim), before + moved - 100 * v, atol=1e-11)
    sim.run(500)  # longer than between two updates of image counts
    np.testing.assert_allclose(unwrapped(sim), before + moved - 600 * v, atol=1e-9)


def test_images_that_move_have_no_whole_numbers() -> None:
    sides = PERIODIC | {side: {"kind": "sheared"} for side in ("bottom", "top")}
    sim = carrom.Simulation(gas(**sides) | {"effects": {"shear": {"rate": 0.02}}})
    sim.run(20)
    with pytest.raises(carrom.SceneError, match=r"^images: between sheared sides images move"):
        _ = sim.images
    with pytest.raises(carrom.NoDataError):
        _ = sim.frame.image
    assert sim.frame.x.shape == (60, 2)


def test_there_are_no_images_between_walls() -> None:
    sim = carrom.Simulation(gas(steps=50))
    sim.run(50)
    assert sim.images.shape == (60, 2)
    assert not sim.images.any()
    half = dict(list(PERIODIC.items())[:2])  # left and right
    sim = carrom.Simulation(gas(steps=200, **half))
    sim.run(200)
    assert sim.images[:, 0].any()
    assert not sim.images[:, 1].any()


def compare(ours: dict[str, Any], wanted: dict[str, Any]) -> None:
    """Numbers of two tables, and of tables in them."""
    for name, value in ours.items():
        if isinstance(value, dict):
            compare(value, wanted[name])
        elif value is None or isinstance(value, str):
            assert value == wanted[name]
        else:
            assert value == pytest.approx(wanted[name], rel=1e-13, abs=1e-16), name


@pytest.mark.parametrize("box", [{}, PERIODIC])
def test_the_report_is_that_of_the_program(
    program: Path, tmp_path: Path, box: dict[str, Any]
) -> None:
    scene = gas(steps=600, **box)
    run = carrom.run(scene, threads=1, folder=tmp_path / "run")
    sim = carrom.Simulation(scene)
    sim.run(600)
    report = sim.report
    json.dumps(report)
    assert report.pop("changes") == {}
    shared = set(report) & set(run.report)
    assert set(report) - shared == {"rotational_energy", "potential_energy"}
    compare({name: report[name] for name in shared}, run.report)


def test_the_report_notes_what_was_changed() -> None:
    sim = carrom.Simulation(gas(steps=100))
    sim.run(7)
    sim.velocities = -sim.velocities
    sim.run(5)
    sim.change(velocities=sim.velocities * 1.5, positions=sim.positions)
    twin = sim.copy()
    wanted = {
        "velocities": {"times": 2, "first_step": 7, "last_step": 12},
        "positions": {"times": 1, "first_step": 12, "last_step": 12},
    }
    sim.run(3)
    assert sim.report["changes"] == twin.report["changes"] == wanted
    assert sim.report["averages"]["from_step"] == 12
    assert (sim.report["first_step"], sim.report["steps"]) == (0, 15)
    twin.velocities = -twin.velocities
    assert sim.report["changes"] == wanted
    with pytest.raises(carrom.SceneError):
        sim.velocities = sim.velocities * np.inf
    assert sim.report["changes"] == wanted


class OfUnit(np.ndarray):  # type: ignore[type-arg]
    """An array as pint and astropy have them."""

    magnitude = 1


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        (lambda v: v + 1j, TypeError, "velocities are real numbers, not complex128"),
        (lambda v: v.astype(str), TypeError, "real numbers, not <U"),
        (lambda v: np.ma.masked_less(v, 0), ValueError, "velocities have masked elements"),
        (lambda v: v.view(OfUnit), ValueError, "plain numbers in lengths per step"),
        (lambda v: v[:-1], ValueError, r"shape \(60, 2\), not \(59, 2\)"),
        (lambda v: 1, ValueError, r"shape \(60, 2\), not \(\)"),
        (lambda v: v * 1e300, carrom.SceneError, "take smaller speeds"),
    ],
)
def test_arrays_that_mean_something_else_are_refused(
    change: Any, error: type[Exception], message: str
) -> None:
    sim = carrom.Simulation(gas(steps=20))
    before = sim.state_hash
    with pytest.raises(error, match=message):
        sim.velocities = change(sim.velocities)
    assert sim.state_hash == before
    sim.run(5)


def test_arrays_of_other_kinds_are_taken() -> None:
    sim = carrom.Simulation(gas(steps=20))
    sim.velocities = np.asfortranarray(sim.velocities)
    sim.velocities = sim.velocities.tolist()
    sim.velocities = np.ones((60, 2), dtype=np.int32)
    assert np.array_equal(sim.velocities, np.ones((60, 2)))


def test_a_loop_of_short_runs_leaves_a_notebook_empty(monkeypatch: pytest.MonkeyPatch) -> None:
    display = pytest.importorskip("IPython.display", reason="IPython is not installed")
    made: list[object] = []

    class Handle:
        def update(self, shown: Any) -> None:
            made.append(shown.data)

    monkeypatch.setattr(carrom.progress, "is_notebook", lambda: True)
    monkeypatch.setattr(display, "display", lambda *_, **__: made.append("new") or Handle())
    sim = carrom.Simulation(gas(count=300, steps=10**6))
    for _ in range(20):
        sim.run(1)
    assert made == []
    with monkeypatch.context() as patch:
        patch.setattr(carrom.stepping, "STRETCH", 1e-4)
        sim.run(500)
    assert made[0] == "new"
    assert made.count("new") == 1
    assert "<progress value=" in str(made[1])
    assert made[-1] == ""  # wiped at the end


def test_stubs_are_those_of_the_extension() -> None:
    """Names, arguments and docstrings; the stub has types, which the extension cannot say."""
    core = carrom.core_module.load()
    text = Path(carrom.__file__).with_name("_core.pyi").read_text(encoding="utf-8")
    module = ast.parse(text)
    wanted = {node.name: node for node in module.body if isinstance(node, ast.FunctionDef)}
    found = {name for name in vars(core) if not name.startswith("_")}
    found -= {"thread", "process", "Core"}
    assert set(wanted) == found
    core_class = next(node for node in module.body if isinstance(node, ast.ClassDef))
    members = {node.name: node for node in core_class.body if isinstance(node, ast.FunctionDef)}
    assert set(members) == {name for name in vars(core.Core) if not name.startswith("_")}
    for owner, nodes in ((core, wanted), (core.Core, members)):
        for name, node in nodes.items():
            ours = getattr(owner, name)
            documented = inspect.getdoc(ours) or ""
            stated = " ".join((ast.get_docstring(node) or "").split())
            assert " ".join(documented.split()).endswith(stated), name
            if not isinstance(ours, property) and callable(ours):
                arguments = [argument.arg for argument in node.args.args]
                signature = documented.split("\n", 1)[0]
                for argument in arguments:
                    assert f"{argument}" in signature, (name, argument)


def test_names_complete() -> None:
    wanted = {
        "sim.": {"run", "positions", "velocities", "images", "every", "averages", "report"},
        'sim.averages["': {"Z", "kT", "mean_speed", "virial_pressure"},
        'sim.tables["': {"thermo", "displacement"},
        'sim.tables["thermo"]["': {"step", "energy"},
        'sim.report["': {"state_hash", "averages", "changes"},
        "sim.frame.": {"x", "v", "image", "to_pandas"},
    }
    scene = repr(measured(**PERIODIC))
    offers = offers_after(f"sim = carrom.Simulation({scene}); sim.run(20)", wanted)
    for text, names in wanted.items():
        assert names <= set(offers[text]), text
    assert not any(name.startswith("_") for name in offers["sim."])


def test_radii_that_discs_exchange_are_those_of_the_step() -> None:
    scene = gas(steps=40, **PERIODIC)
    scene["discs"] = {"species": [{"count": 5, "radius": 0.2 + 0.02 * k} for k in range(12)]}
    sim = carrom.Simulation(scene | {"effects": {"swap": {"rounds": 4}}})
    first, frame = sim.radii, sim.frame
    sim.run(40)
    assert np.sum(sim.radii != first) > 10
    assert sorted(sim.radii) == sorted(first)
    assert frame.radius.tolist() == first.tolist()
    assert sim.frame.radius.tolist() == sim.radii.tolist()
    assert sim.copy().radii.tolist() == sim.radii.tolist()
