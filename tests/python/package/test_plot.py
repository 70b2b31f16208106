# SPDX-License-Identifier: BSD-3-Clause
"""Pictures show what is in the files; movies are whole or not there."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from conftest import gas

import carrom

matplotlib = pytest.importorskip("matplotlib", reason="matplotlib is not installed")
Image = pytest.importorskip("PIL.Image", reason="pillow is not installed")
matplotlib.use("Agg")

from carrom import plot  # noqa: E402
from carrom.plot.commands import main  # noqa: E402
from carrom.plot.movies import find_ffmpeg  # noqa: E402


@pytest.fixture(autouse=True)
def _close_figures() -> Iterator[None]:
    yield
    matplotlib.pyplot.close("all")


def coloured(path: Path) -> float:
    """The share of pixels that are not grey."""
    with Image.open(path) as picture:
        pixels = np.asarray(picture.convert("RGB")).reshape(-1, 3).astype(int)
    return float(np.mean(pixels.max(axis=1) - pixels.min(axis=1) > 20))


def test_discs_cover_as_much_as_they_should(run: carrom.Run, tmp_path: Path) -> None:
    """Red discs on white, without frame: the share of red is the packing fraction."""
    ax = plot.frame(
        run, colour=np.ones(60), cmap=matplotlib.colors.ListedColormap(["red"]), bar=False
    )
    ax.set_axis_off()
    ax.set_title("")
    ax.figure.set_layout_engine("none")
    ax.figure.set_size_inches(6, 6)
    ax.set_position((0, 0, 1, 1))
    ax.figure.savefig(tmp_path / "red.png", dpi=100)
    assert coloured(tmp_path / "red.png") == pytest.approx(0.3, abs=0.01)


@pytest.mark.parametrize("colour", ["speed", "vx", "vy", "strip", "species"])
def test_each_colour_is_drawn(run: carrom.Run, colour: str) -> None:
    ax = plot.frame(run, 10, colour=colour)
    discs = ax.collections[-1]
    frame = run.frames.at(10)
    wanted = {
        "speed": np.hypot(*frame.v.T),
        "vx": frame.v[:, 0],
        "vy": frame.v[:, 1],
        "strip": frame.strips(4),
        "species": np.zeros(60),
    }[colour]
    assert np.array_equal(discs.get_array(), wanted)
    assert np.array_equal(discs.get_offsets(), frame.x)
    assert ax.get_title() == "step 10"


def test_wrong_wishes_are_errors(run: carrom.Run) -> None:
    with pytest.raises(ValueError, match="no colour 'pink'; there are speed"):
        plot.frame(run, colour="pink")
    with pytest.raises(ValueError, match=r"not \(60,\): one number a disc"):
        plot.frame(run, colour=[1, 2])
    with pytest.raises(carrom.NoDataError, match="no frame of step 11; there are 5"):
        plot.frame(run, 11)
    with pytest.raises(ValueError, match="ranks must be at least 1, not 0"):
        plot.frame(run, colour="strip", ranks=0)
    with pytest.raises(ValueError, match="fastest must be above 0, not nan"):
        plot.frame(run, fastest=float("nan"))
    with pytest.raises(ValueError, match=r"not \(5, 5, 1\)"):
        plot.frame(run, view=(5, 5, 1))  # type: ignore[arg-type]
    with pytest.raises(carrom.NoDataError, match="no frames to draw"):
        plot.movie(run.frames[9:], "m.gif")
    with pytest.raises(carrom.NoDataError, match="needs a finished run"):
        plot.equation_of_state([])


def test_obstacles_are_drawn_with_their_images(program: Path, tmp_path: Path) -> None:
    sides = {side: {"kind": "periodic"} for side in ("left", "right", "bottom", "top")}
    scene = gas(count=5, steps=0, **sides)
    scene["discs"] = {"count": 5, "radius": 0.3}
    scene["effects"] = {"obstacles": {"discs": [[0, 0, 2]], "segments": [[5, 5, 9, 9]]}}
    ax = plot.frame(carrom.run(scene, folder=tmp_path / "run"))
    circles, lines = ax.collections[0], ax.collections[1]
    assert len(circles.get_paths()) == 9
    assert len(lines.get_segments()) == 9


def test_walls_of_other_shapes_are_drawn(program: Path, tmp_path: Path) -> None:
    scene = gas(count=5, steps=0)
    scene["box"] = {"size": [20, 10], "shape": "stadium"}
    scene["discs"] = {"count": 5, "radius": 0.3}
    obstacles = {"arcs": [[5, 5, 1], [10, 5, 2, 0, 90]], "polygons": [[14, 3, 16, 3, 15, 5]]}
    scene["effects"] = {"obstacles": obstacles}
    ax = plot.frame(carrom.run(scene, folder=tmp_path / "run"))
    polygon, circle, arc, wall = ax.collections[1].get_segments()
    assert np.allclose(polygon[0], polygon[-1])
    assert np.allclose(np.hypot(*(circle - [5, 5]).T), 1)
    assert np.allclose(arc[[0, -1]], [[12, 5], [10, 7]])
    assert np.allclose([wall.min(axis=0), wall.max(axis=0)], [[0, 0], [20, 10]], atol=0.01)


def test_a_movie_has_all_frames(run: carrom.Run, tmp_path: Path) -> None:
    path = plot.movie(run, tmp_path / "m.gif", dpi=40, rate=10)
    with Image.open(path) as movie:
        assert movie.n_frames == 5
        assert movie.info["duration"] == 100
    assert coloured(path) > 0.1
    with Image.open(plot.movie(run.frames[::2], tmp_path / "n.gif", dpi=40)) as movie:
        assert movie.n_frames == 3
    assert sorted(p.name for p in tmp_path.iterdir()) == ["m.gif", "n.gif"]


def test_a_movie_of_other_kinds_is_for_ffmpeg(run: carrom.Run, tmp_path: Path) -> None:
    try:
        find_ffmpeg()
    except carrom.MissingPackageError as error:
        pytest.skip(str(error))
    path = plot.movie(run, tmp_path / "m.mp4", dpi=41)
    assert path.read_bytes()[4:8] == b"ftyp"
    with pytest.raises(carrom.FileError, match=r"ffmpeg cannot write m\.unknown"):
        plot.movie(run, tmp_path / "m.unknown", dpi=40)
    assert [p.name for p in tmp_path.iterdir()] == ["m.mp4"]


def test_a_movie_to_nowhere_is_an_error(run: carrom.Run, tmp_path: Path) -> None:
    with pytest.raises(carrom.FileError, match="there is no folder"):
        plot.movie(run, tmp_path / "nowhere/m.gif")


def test_curves_show_the_tables(run: carrom.Run) -> None:
    axes = plot.radial_distribution(run)
    line = axes.lines[0]
    table = run.tables["radial_distribution"]
    assert np.array_equal(line.get_ydata(), table["g"])
    assert len(axes.lines) == 2  # g and the line at 1: errors are a band
    assert len(axes.collections) == 1
    scaled = plot.radial_distribution(run, in_diameters=True).lines[0]
    diameter = 2 * run.frames[0].radius[0]
    assert scaled.get_xdata() == pytest.approx(line.get_xdata() / diameter)
    energy, collisions = plot.history(run)
    assert np.abs(energy.lines[0].get_ydata()).max() < 1e-6
    drawn = sum(float(np.sum(patch.get_data().values)) for patch in collisions.patches)
    assert drawn == len(run.collisions)
    drawn = [ax.get_title() for ax in plot.measurements(run)]
    assert drawn == [
        "displacement",
        "radial distribution",
        "speeds",
        "thermo",
        "velocities",
        "wall pressure history",
    ]


def test_equation_of_state_shows_z(program: Path, tmp_path: Path) -> None:
    sweep = carrom.sweep(gas(steps=20), {"discs.packing": [0.2, 0.1]}, folder=tmp_path)
    ax = plot.equation_of_state(sweep)
    points = ax.containers[0].lines[0]
    assert points.get_xdata() == pytest.approx([0.1, 0.2])
    assert sorted(points.get_ydata()) == sorted(sweep.table["Z"])
    one = plot.equation_of_state(sweep.runs[0]).containers[0].lines[0]
    assert one.get_ydata().tolist() == [sweep.table["Z"][0]]


COMMANDS = {
    "frame": ["--colour", "strip", "--ranks", "3", "--view", "0", "0", "10", "10", "--step", "10"],
    "movie": ["--every", "2", "--dpi", "40"],
    "history": [],
    "measurements": [],
    "gr": ["--in-diameters"],
    "eos": [],
}


@pytest.mark.parametrize("command", list(COMMANDS))
def test_commands_draw(run: carrom.Run, tmp_path: Path, command: str) -> None:
    path = tmp_path / ("p.gif" if command == "movie" else "p.png")
    assert main([command, str(run.folder), "-o", str(path), *COMMANDS[command]]) == 0
    assert coloured(path) > 0.0003


def test_commands_report_what_is_wrong(
    run: carrom.Run, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["frame", str(run.folder), "--step", "11", "-o", "p.png"]) == 2
    assert "carrom-plot: no frame of step 11" in capsys.readouterr().err
    assert main(["gr", str(tmp_path), "-o", "p.png"]) == 2
    assert "is no run of carrom" in capsys.readouterr().err
    assert main(["history", str(run.folder), "-o", str(tmp_path / "no/p.png")]) == 2
    assert "No such file or directory" in capsys.readouterr().err
    picture = ["-o", str(tmp_path / "m.gif"), "--dpi", "20"]
    assert main(["movie", str(run.folder), *picture, "--rate", "1e-9"]) == 2
    assert "cannot draw" in capsys.readouterr().err
    with pytest.raises(SystemExit) as caught:
        main(["frame"])
    assert caught.value.code == 2


def test_without_matplotlib_the_command_says_so(
    run: carrom.Run, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert main(["frame", str(run.folder), "-o", "p.png"]) == 2
    assert "pip install carrom[plot]" in capsys.readouterr().err


def test_color_is_colour(run: carrom.Run, tmp_path: Path) -> None:
    shown = [plot.frame(run, **{name: "vx"}) for name in ("colour", "color")]
    arrays = [ax.collections[-1].get_array() for ax in shown]
    assert np.array_equal(arrays[0], arrays[1])
    assert np.array_equal(arrays[0], run.frames[-1].v[:, 0])
    with pytest.raises(TypeError, match="give one of them"):
        plot.frame(run, colour="vx", color="vy")
    assert main(["frame", str(run.folder), "-o", str(tmp_path / "p.png"), "--color", "vy"]) == 0


def test_views_and_limits_may_be_arrays(run: carrom.Run) -> None:
    ax = plot.frame(run, view=np.array([0, 0, 5, 6]), limits=np.array([1, 2]))
    assert ax.get_xlim() == (0, 5)
    assert ax.collections[-1].get_clim() == (1, 2)
    with pytest.raises(ValueError, match="limits are the first and the last"):
        plot.frame(run, limits=[1])


def test_a_table_that_nobody_knows_is_drawn(run: carrom.Run, tmp_path: Path) -> None:
    """A new quantity needs no line here: its table has names and remarks."""
    (tmp_path / "scene.toml").write_text("")
    (tmp_path / "measurements").mkdir()
    (tmp_path / "measurements/novel.csv").write_text(
        "# wonders: of the world; speeds in lengths per step\n"
        "from,to,count,wonders,wonders_error\n0,2,7,5,1\n2,4,8,6,1\n"
    )
    (ax,) = plot.measurements(tmp_path)
    assert ax.get_title() == "novel"
    assert ax.get_xlabel() == "speeds (lengths per step)"
    assert ax.get_ylabel() == "wonders"
    (line,) = ax.lines
    assert line.get_xydata().tolist() == [[1, 5], [3, 6]]
    band = ax.collections[0].get_paths()[0].vertices[:, 1]
    assert (band.min(), band.max()) == (4, 7)
