# SPDX-License-Identifier: BSD-3-Clause
"""Tables of scaling: the program's numbers, speedup and efficiency, and wrong tables."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from conftest import gas

import carrom
from carrom import scaling

HEADER = "ranks,threads,n_discs,steps,wall_seconds,ns_per_disc_step,state_hash"


def row(ranks: int, threads: int, seconds: float, state: str = "a") -> str:
    return f"{ranks},{threads},1000,50,{seconds},0,{state}"


def test_efficiency_is_against_the_fewest_cores(tmp_path: Path) -> None:
    table = tmp_path / "job.csv"
    table.write_text("\n".join([HEADER, row(4, 1, 3.0), row(1, 1, 9.0), row(2, 2, 4.5)]) + "\n")
    rows = scaling.read_table(table)
    assert [(one["ranks"], one["threads"]) for one in rows] == [("1", "1"), ("4", "1"), ("2", "2")]
    assert [one["speedup"] for one in rows] == [1, 3, 2]
    assert [one["efficiency"] for one in rows] == [1, 0.75, 0.5]
    picture = tmp_path / "picture.png"
    pytest.importorskip("matplotlib")
    scaling.plot(rows, picture)
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_a_job_script_writes_the_same_columns() -> None:
    script = Path(__file__).resolve().parents[3] / "job_scripts" / "launch.sh"
    header = re.search(r"(ranks,threads,[a-z_,]*)", script.read_text(encoding="ascii"))
    assert header is not None
    assert header[1] == ",".join(scaling.MEASURED) == HEADER


def test_shapes_are_measured(program: Path, tmp_path: Path) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text(carrom.to_toml(gas(count=200)))
    expected = carrom.run(scene, folder=tmp_path / "run")
    output = tmp_path / "table.csv"
    words = [str(scene), "--ranks", "1", "2", "--threads", "1", "--repeat", "2", "-o", str(output)]
    assert scaling.main(words) == 0
    rows = scaling.read_table(output)
    assert [one["ranks"] for one in rows] == ["1", "2"]
    for one in rows:
        assert one["state_hash"] == expected.state_hash
        assert (one["n_discs"], one["steps"]) == ("200", "20")
        per_disc_and_step = float(one["wall_seconds"]) / (200 * 20) * 1e9
        assert float(one["ns_per_disc_step"]) == pytest.approx(per_disc_and_step, rel=1e-3)
    weak = scaling.measure(scene, [1, 2], is_weak=True, discs__count=100)
    assert [one["n_discs"] for one in weak] == [100, 200]


def test_wrong_tables(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    table, output = tmp_path / "job.csv", str(tmp_path / "out.csv")
    table.write_text("\n".join([HEADER, row(1, 1, 9.0), row(2, 1, 4.5, "b")]) + "\n")
    assert scaling.main(["--from", str(table), "-o", output]) == 1
    assert "different states: a, b" in capsys.readouterr().err
    table.write_text("ranks,threads\n1,1\n")
    assert scaling.main(["--from", str(table), "-o", output]) == 2
    assert "is no table of scaling" in capsys.readouterr().err
    assert scaling.main(["--from", str(tmp_path / "none.csv"), "-o", output]) == 2
    table.write_text("\n".join([HEADER, row(1, 1, 9.0).replace(",50,", ",0,")]) + "\n")
    assert scaling.main(["--from", str(table), "-o", output]) == 2
    assert "at least one step" in capsys.readouterr().err
    table.write_text("\n".join([HEADER, row(1, 1, 9.0)]) + "\n")
    assert scaling.main(["--from", str(table), "-o", str(tmp_path / "nowhere/out.csv")]) == 2
    for words in ([], ["a.toml", "--ranks", "0"], ["a.toml", "--weak"]):
        with pytest.raises(SystemExit):
            scaling.main(words)
