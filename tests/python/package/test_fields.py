# SPDX-License-Identifier: BSD-3-Clause
"""Profiles as arrays, Datasets and pictures: the numbers of the table, at their places."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from conftest import gas

import carrom
from carrom.fields import Fields

N_X, N_Y, N_BLOCKS = 4, 3, 2


@pytest.fixture(scope="module")
def profiled(program: Path, tmp_path_factory: pytest.TempPathFactory) -> carrom.Run:
    scene = gas() | {
        "output": {
            "measurements": {
                "quantities": ["profiles", "correlations"],
                "every_steps": 1,
                "profile_columns": N_X,
                "profile_rows": N_Y,
                "profile_samples": 8,
            },
        }
    }
    return carrom.run(scene, threads=1, folder=tmp_path_factory.mktemp("runs") / "profiled")


@pytest.fixture
def _figures() -> Iterator[None]:
    matplotlib = pytest.importorskip("matplotlib", reason="matplotlib is not installed")
    matplotlib.use("Agg")
    yield
    matplotlib.pyplot.close("all")


def test_each_cell_is_at_its_place(profiled: carrom.Run) -> None:
    table = profiled.tables["profiles"]
    fields = Fields(table)
    assert fields.shape == (N_Y, N_X)
    assert fields.n_blocks == N_BLOCKS
    assert np.allclose(fields.x[0], (np.arange(N_X) + 0.5) * 20 / N_X)
    for row in table[:: N_X + 1]:
        block = fields.block_of(int(row["to_step"]))
        i, j = int(row["x"] * N_X / 20), int(row["y"] * N_Y / 20)
        assert fields.values("count")[block, j, i] == row["count"]
        pressure = (row["xx"] + row["yy"] + row["contact_xx"] + row["contact_yy"]) / 2
        assert fields.values("pressure")[block, j, i] == pytest.approx(pressure)
    assert fields.values("count").sum(axis=(1, 2)).tolist() == [60 * 8] * N_BLOCKS
    with pytest.raises(carrom.NoDataError, match="no field 'heat'; they have count"):
        fields.values("heat")
    with pytest.raises(carrom.NoDataError, match="ends with step 3; blocks end with 7, 15"):
        fields.block_of(3)


def test_profiles_become_a_dataset(profiled: carrom.Run) -> None:
    pytest.importorskip("xarray", reason="xarray is not installed")
    table = profiled.tables["profiles"]
    data = table.to_xarray()
    assert dict(data.sizes) == {"step": N_BLOCKS, "y": N_Y, "x": N_X}
    row = table[N_X * N_Y + 2 * N_X + 1]
    at = data.sel(step=row["to_step"], x=row["x"], y=row["y"])
    for name in table.columns[3:]:
        assert float(at[name]) == row[name]
    assert data.attrs["remarks"] == list(table.remarks)
    assert profiled.tables["correlations"].to_xarray()["scattering"].dims == ("row",)


@pytest.mark.usefixtures("_figures")
def test_maps_show_the_last_block(profiled: carrom.Run) -> None:
    from carrom import plot

    axes = plot.profiles(profiled, ["density", "vx"])
    assert len(axes) == 2
    shown = axes[0].collections[0].get_array()
    expected = Fields(profiled.tables["profiles"]).values("density")[-1]
    assert np.array_equal(np.asarray(shown).reshape(N_Y, N_X), expected)
    with pytest.raises(carrom.NoDataError, match="profiles_1"):
        plot.profiles(profiled, species=1)
    plot.measurements(profiled)


@pytest.mark.usefixtures("_figures")
def test_a_single_row_is_a_curve(program: Path, tmp_path: Path) -> None:
    from carrom import plot
    from carrom.plot.commands import main

    measured = {"quantities": ["profiles"], "every_steps": 1, "profile_rows": 1}
    measured["profile_samples"] = 5
    scene = gas() | {"output": {"measurements": measured}}
    run = carrom.run(scene, threads=1, folder=tmp_path / "row")
    (ax,) = plot.profiles(run, ["pressure"])
    curves = ax.get_lines()
    assert len(curves) == 4  # one for each block, the last one above the others
    fields = Fields(run.tables["profiles"])
    assert np.array_equal(curves[-1].get_xdata(), fields.x[-1])
    assert np.array_equal(curves[-1].get_ydata(), fields.values("pressure")[-1, 0])
    picture = tmp_path / "row.png"
    assert main(["profiles", str(run.folder), "--columns", "density", "-o", str(picture)]) == 0
    assert picture.stat().st_size > 1000
    assert main(["profiles", str(run.folder), "--step", "3", "-o", str(picture)]) == 2
