# SPDX-License-Identifier: BSD-3-Clause
"""How runs, tables and frames look in a notebook: HTML that needs no other package."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from carrom.errors import NoDataError

if TYPE_CHECKING:
    from carrom.disc_arrays import DiscArrays

MOST_ROWS = 20
"""A longer table shows its first and last rows."""
_MOST_DISCS = 4000  # circles of a picture; more would make a notebook slow
_WIDTH = 240  # width of a picture in pixels


def facts(title: str, pairs: Mapping[str, object]) -> str:
    """Return a table of names and values. Names without a value (None) are left out."""
    rows = [
        f"<tr><th style='text-align:left'>{escape(name)}</th>"
        f"<td style='text-align:left'>{escape(str(value))}</td></tr>"
        for name, value in pairs.items()
        if value is not None
    ]
    return f"<table><caption>{escape(title)}</caption>{''.join(rows)}</table>"


def rows(title: str, names: Sequence[str], records: Sequence[Sequence[Any]]) -> str:
    """Return a table with a head. Of more than 20 rows the middle is left out."""
    head = "".join(f"<th>{escape(name)}</th>" for name in names)
    lines = [_row(record) for record in records[:MOST_ROWS]]
    if len(records) > MOST_ROWS:
        half = MOST_ROWS // 2
        gap = f"<tr><td colspan='{len(names)}'>&#8942;</td></tr>"
        lines = [*lines[:half], gap, *(_row(record) for record in records[-half:])]
    caption = f"{title}: {len(records)} rows"
    return (
        f"<table><caption>{escape(caption)}</caption><thead><tr>{head}</tr></thead>"
        f"<tbody>{''.join(lines)}</tbody></table>"
    )


def _row(record: Sequence[Any]) -> str:
    return "<tr>" + "".join(f"<td>{escape(_word(value))}</td>" for value in record) + "</tr>"


def _word(value: Any) -> str:
    return f"{value:.6g}" if isinstance(value, (float, np.floating)) else str(value)


def picture(frame: DiscArrays) -> str:
    """Return the discs to scale as SVG; nothing where there are too many, or no positions."""
    try:
        centres = frame.x_from_corner
    except NoDataError:
        return ""
    present = frame.present
    if np.count_nonzero(present) > _MOST_DISCS:
        return ""
    width, height = (float(edge) for edge in frame.box)
    circles = "".join(
        f'<circle cx="{x:.6g}" cy="{height - y:.6g}" r="{r:.4g}"/>'
        for (x, y), r in zip(centres[present].tolist(), frame.radius[present].tolist())
    )
    return (
        f'<svg width="{_WIDTH}" height="{_WIDTH * height / width:.0f}" '
        f'viewBox="0 0 {width:.9g} {height:.9g}" style="border:1px solid gray">'
        f'<g fill="#3b6ea5">{circles}</g></svg>'
    )
