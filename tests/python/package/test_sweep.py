# SPDX-License-Identifier: BSD-3-Clause
"""Sweeps: grids, tables with errors, and calls that go on where others ended."""

from __future__ import annotations

import _thread
import concurrent.futures
import pickle
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import PERIODIC, Scene, gas

import carrom


def test_a_grid_becomes_one_table(program: Path, tmp_path: Path) -> None:
    grid = {"discs.packing": [0.1, 0.2], "time__micro_steps": [1, 4]}
    sweep = carrom.sweep(gas(steps=600), grid, folder=tmp_path, workers=2)
    table = sweep.table
    assert table["discs.packing"].tolist() == [0.1, 0.1, 0.2, 0.2]
    assert table["time.micro_steps"].tolist() == [1, 4, 1, 4]
    assert table["runs"].tolist() == [1] * 4
    for run, row in zip(sweep.runs, table):
        averages = run.report["averages"]
        assert row["virial_pressure"] == averages["virial_pressure"]["value"]
        error = averages["collision_frequency"]["error"]
        assert row["collision_frequency_error"] == (np.nan if error is None else error)
        assert (row["Z"], row["Z_error"]) == carrom.compressibility(run)
        z = run.report["compressibility"]
        assert (row["compressibility"], row["compressibility_error"]) == (z["value"], z["error"])
    alone = carrom.run(gas(steps=600), folder=tmp_path / "alone", discs__packing=0.2)
    assert sweep.runs[2].state_hash == alone.state_hash
    assert "4 of 4 done" in repr(sweep)
    assert "4 of 4 done" in sweep._repr_html_()


def test_errors_are_over_repeats(program: Path, tmp_path: Path) -> None:
    sweep = carrom.sweep(
        gas(steps=30, **PERIODIC),
        {"discs.packing": [0.2]},
        folder=tmp_path,
        repeats=4,
        quantities={"pairs": lambda run: float(run.report["pair_collisions"])},
    )
    pairs = [run.report["pair_collisions"] for run in sweep.runs]
    assert [run.scene["discs"]["seed"] for run in sweep.runs] == [3210, 3211, 3212, 3213]
    assert len(set(pairs)) == 4
    (row,) = sweep.table
    assert row["pairs"] == np.mean(pairs)
    assert row["pairs_error"] == pytest.approx(np.std(pairs, ddof=1) / 2)
    assert np.isnan(row["virial_pressure"])


def test_a_second_call_runs_what_is_missing(program: Path, tmp_path: Path) -> None:
    scene = gas(steps=30)
    carrom.sweep(scene, {"discs.seed": [1, 2]}, folder=tmp_path)
    times = [path.stat().st_mtime_ns for path in sorted(tmp_path.glob("*/report.json"))]
    stopped = carrom.run(scene, folder=tmp_path / "discs.seed=3", discs__seed=3, steps=10)
    assert stopped.report["steps"] == 10
    sweep = carrom.sweep(scene, {"discs.seed": [1, 2, 3, 4]}, folder=tmp_path)
    assert sweep.table["discs.seed"].tolist() == [1, 2, 3, 4]
    after = [path.stat().st_mtime_ns for path in sorted(tmp_path.glob("*/report.json"))]
    assert after[:2] == times
    assert sweep.runs[2].report["first_step"] == 10
    whole = carrom.run(scene, folder=tmp_path / "whole", discs__seed=3)
    assert sweep.runs[2].state_hash == whole.state_hash


def test_two_sweeps_at_once_share_a_folder(program: Path, tmp_path: Path) -> None:
    scene, grid = gas(steps=3000), {"discs.seed": [1, 2, 3]}
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        both = [pool.submit(carrom.sweep, scene, grid, folder=tmp_path) for _ in range(2)]
    hashes = [[run.state_hash for run in one.result().runs] for one in both]
    assert hashes[0] == hashes[1]
    assert len(set(hashes[0])) == 3


def test_another_scene_in_the_folder_is_an_error(program: Path, tmp_path: Path) -> None:
    carrom.sweep(gas(steps=3), {"discs.seed": [1]}, folder=tmp_path)
    with pytest.raises(carrom.FileError, match=r"another scene \(box\.size\); name another folder"):
        carrom.sweep(gas(steps=3, size=30), {"discs.seed": [1]}, folder=tmp_path)


def test_a_longer_run_in_the_folder_is_an_error(program: Path, tmp_path: Path) -> None:
    carrom.sweep(gas(steps=4), {"discs.seed": [1]}, folder=tmp_path)
    with pytest.raises(carrom.FileError, match="holds a run of 4 steps; name another folder"):
        carrom.sweep(gas(steps=3), {"discs.seed": [1]}, folder=tmp_path)
    longer = carrom.sweep(gas(steps=6), {"discs.seed": [1]}, folder=tmp_path)
    assert longer.runs[0].report["first_step"] == 4


def test_an_interrupt_lets_all_runs_store_checkpoints(program: Path, tmp_path: Path) -> None:
    def interrupt() -> None:
        while len(list(tmp_path.glob("*/scene.toml"))) < 2:
            time.sleep(0.02)
        time.sleep(0.5)
        _thread.interrupt_main()

    thread = threading.Thread(target=interrupt)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        carrom.sweep(gas(steps=50_000_000), {"discs.seed": [1, 2, 3]}, folder=tmp_path, workers=2)
    thread.join()
    folders = sorted(path.name for path in tmp_path.iterdir())
    assert folders == ["discs.seed=1", "discs.seed=2"]
    assert [len(carrom.open(tmp_path / name).checkpoints) for name in folders] == [1, 1]


def test_what_fails_leaves_the_rest(program: Path, tmp_path: Path) -> None:
    with pytest.raises(carrom.SweepError, match="1 of 3 runs failed") as caught:
        carrom.sweep(gas(steps=3), {"discs.packing": [0.1, 5, 0.2]}, folder=tmp_path)
    assert "discs.packing=5: " in str(caught.value)
    assert caught.value.sweep.table["discs.packing"].tolist() == [0.1, 0.2]
    ((point, error),) = caught.value.sweep.failures
    assert point.values == {"discs.packing": 5}
    assert isinstance(error, carrom.InputError)
    failed = carrom.SweepError(carrom.Sweep(tmp_path, ("discs.packing",), []))
    assert str(pickle.loads(pickle.dumps(failed))) == str(failed)


def test_grids_without_values_are_errors(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="no key"):
        carrom.sweep(gas(), {}, folder=tmp_path)
    with pytest.raises(ValueError, match=r"discs\.seed"):
        carrom.sweep(gas(), {"discs.seed": []}, folder=tmp_path)


@pytest.mark.parametrize(
    ("grid", "options", "text"),
    [
        ({"time.method": "event-driven"}, {}, r"several values of time\.method"),
        ({"discs.packing": 0.1}, {}, r"several values of discs\.packing: \[0\.1\]"),
        ({"discs.packing": [None]}, {}, r"discs\.packing: a scene cannot have None"),
        ({"box.size": [20, 20.0]}, {}, r"box\.size has the value 20\.0 twice"),
        ({"box.size": [20], "box__size": [30]}, {}, r"box\.size is given twice"),
        ({"box.size": [20]}, {"box__size": 30}, r"box\.size is given twice"),
        ({"discs.seed": [1, 2]}, {"repeats": 2}, r"discs\.seed cannot be in the grid too"),
        ({"output.folder": ["a", "b"]}, {}, r"cannot set output\.folder"),
        ({"discs.seed": [1]}, {"output__folder": "a"}, r"cannot set output\.folder"),
        ({"discs.seed": [1]}, {"ranks": 0}, "ranks must be at least 1, not 0"),
        ({"discs.seed": [1]}, {"threads": 0}, "threads must be at least 1, not 0"),
        ({"discs.seed": [1]}, {"workers": 0}, "workers must be at least 1, not 0"),
    ],
)
def test_wrong_grids_run_nothing(tmp_path: Path, grid: Scene, options: Scene, text: str) -> None:
    with pytest.raises((TypeError, ValueError), match=text):
        carrom.sweep(gas(), grid, folder=tmp_path, **options)
    assert list(tmp_path.iterdir()) == []


def test_values_may_be_arrays(program: Path, tmp_path: Path) -> None:
    sizes = [np.array([20, 20]), np.array([30, 20])]
    sweep = carrom.sweep(gas(steps=2), {"box.size": sizes}, folder=tmp_path)
    assert sweep.table["box.size"].tolist() == ["[20, 20]", "[30, 20]"]
    assert [run.scene["box"]["size"] for run in sweep.runs] == [[20, 20], [30, 20]]


def test_legacy_text_is_swept_too(program: Path, tmp_path: Path) -> None:
    path = tmp_path / "gas.in"
    path.write_text("20\n30\n1\n5\nperf\n")
    sweep = carrom.sweep(path, {"time.micro_steps": [1, 2]}, folder=tmp_path / "sweep")
    assert sweep.table["time.micro_steps"].tolist() == [1, 2]
    assert carrom.sweep(path, {"time.micro_steps": [1, 2]}, folder=tmp_path / "sweep").missing == []
    path.write_text("20\n30\n1\n6\nperf\n")
    with pytest.raises(carrom.FileError, match=r"another scene \(.*gas\.in\)"):
        carrom.sweep(path, {"time.micro_steps": [1, 2]}, folder=tmp_path / "sweep")
