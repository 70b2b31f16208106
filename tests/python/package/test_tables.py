# SPDX-License-Identifier: BSD-3-Clause
"""Tables alone: columns, remarks, and files that are no tables."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import carrom


def test_numbers_keep_every_bit(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    path.write_text(
        "# a remark\nfrom,count,g_1_2,vx_count\n0.1,3,nan,7\n1e-300,9007199254740993,2,0\n"
    )
    table = carrom.read_csv(path)
    assert table.remarks == ("a remark",)
    assert table.columns == ("from", "count", "g_1_2", "vx_count")
    assert [table.dtype[name].kind for name in table.columns] == ["f", "i", "f", "i"]
    assert table["from"].tolist() == [0.1, 1e-300]
    assert table["count"].tolist() == [3, 2**53 + 1]
    assert table[:1].remarks == ("a remark",)


@pytest.mark.parametrize(
    "text", ["", "# nothing\n", "a,b\n1\n", "a,b\n1,x\n", "count\n1.5\n"], ids=range(5)
)
def test_what_is_no_table_is_an_error(tmp_path: Path, text: str) -> None:
    (tmp_path / "t.csv").write_text(text)
    with pytest.raises(carrom.FileError, match=r"t\.csv: is no table"):
        carrom.read_csv(tmp_path / "t.csv")


def test_lines_that_are_none_are_an_error(tmp_path: Path) -> None:
    (tmp_path / "lines").write_text("0 0 1 2 x 4\n")
    with pytest.raises(carrom.FileError, match="are no lines of discs"):
        carrom.read_lines(tmp_path / "lines")


def test_a_table_has_named_columns() -> None:
    with pytest.raises(TypeError, match="named columns"):
        carrom.Table(np.zeros(3))
