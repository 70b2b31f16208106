# SPDX-License-Identifier: BSD-3-Clause
"""pandas and xarray get the numbers of tables and frames, under the right names."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import gas

import carrom


def test_tables_become_data_frames(run: carrom.Run) -> None:
    pytest.importorskip("pandas", reason="pandas is not installed")
    tables = run.tables.to_pandas()
    assert list(tables) == list(run.tables)
    assert np.array_equal(tables["thermo"]["energy"], run.thermo["energy"])
    assert tables["thermo"].attrs["remarks"] == list(run.thermo.remarks)


def test_data_frames_are_what_pandas_reads(run: carrom.Run) -> None:
    pandas = pytest.importorskip("pandas", reason="pandas is not installed")
    again = pandas.read_csv(Path(str(run.folder)) / "measurements/displacement.csv", comment="#")
    frame = run.tables["displacement"].to_pandas()
    pandas.testing.assert_frame_equal(frame, again, check_exact=True, check_dtype=False)


def test_tables_become_datasets(run: carrom.Run) -> None:
    pytest.importorskip("xarray", reason="xarray is not installed")
    data = run.tables.to_xarray()["thermo"]
    assert data["energy"].dims == ("row",)
    assert np.array_equal(data["energy"], run.thermo["energy"])
    assert data.attrs["remarks"] == list(run.thermo.remarks)


def test_frames_become_data_frames(run: carrom.Run) -> None:
    pytest.importorskip("pandas", reason="pandas is not installed")
    frame = run.frames[1]
    data = frame.to_pandas()
    assert np.array_equal(data[["x", "y"]].to_numpy(), frame.x)
    assert np.array_equal(data[["vx", "vy"]].to_numpy(), frame.v)
    assert data.index.name == "disc"
    assert data.attrs["step"] == 5
    assert "psi6" not in data.columns
    together = run.frames.to_pandas()
    assert together.index.names == ["step", "disc"]
    assert np.array_equal(together.loc[5][["x", "y"]].to_numpy(), frame.x)
    checkpoint = run.checkpoints[-1]
    assert np.array_equal(checkpoint.to_pandas()["vx"], checkpoint.v[:, 0])


def test_frames_become_datasets(run: carrom.Run) -> None:
    pytest.importorskip("xarray", reason="xarray is not installed")
    data = run.frames.to_xarray()
    assert dict(data.sizes) == {"step": 5, "disc": 60, "axis": 2}
    assert data["step"].values.tolist() == [0, 5, 10, 15, 20]
    assert np.array_equal(data["position"].sel(step=10), run.frames.at(10).x)
    assert np.array_equal(data["velocity"].sel(step=10, axis="y"), run.frames.at(10).v[:, 1])
    assert data["radius"].dims == ("disc",)
    assert data["position"].attrs["units"] == "length"
    alone = run.frames.at(10).to_xarray()
    assert np.array_equal(alone["position"], run.frames.at(10).x)
    with pytest.raises(carrom.NoDataError, match="to_xarray needs at least one frame"):
        run.frames[9:].to_xarray()


def test_a_sweep_becomes_a_grid(program: Path, tmp_path: Path) -> None:
    pytest.importorskip("xarray", reason="xarray is not installed")
    grid = {"discs.packing": np.array([0.1, 0.2]), "time.method": ["event-driven", "time-stepped"]}
    sweep = carrom.sweep(gas(steps=20), grid, folder=tmp_path)
    data = sweep.to_xarray()
    assert dict(data.sizes) == {"discs.packing": 2, "time.method": 2}
    for point, run in zip(sweep.points, sweep.runs):
        at = data["compressibility"].sel(point.values)
        assert float(at) == carrom.compressibility(run).value
    (tmp_path / sweep.points[0].name / "report.json").unlink()
    assert int(np.isnan(sweep.to_xarray()["packing"]).sum()) == 1
    pytest.importorskip("pandas", reason="pandas is not installed")
    assert len(sweep.to_pandas()) == 3


@pytest.mark.parametrize("package", ["pandas", "xarray"])
def test_a_missing_package_is_named(
    run: carrom.Run, monkeypatch: pytest.MonkeyPatch, package: str
) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    for source in (run.thermo, run.frames, run.frames[0]):
        with pytest.raises(carrom.MissingPackageError, match=f"pip install {package}"):
            getattr(source, f"to_{package}")()
