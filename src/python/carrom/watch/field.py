# SPDX-License-Identifier: BSD-3-Clause
"""The newest block of `"profiles"`, as the page draws it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from carrom.errors import NoDataError
from carrom.fields import Fields
from carrom.runs import Run


class NewestField:
    """Keeps the table that has been read until its file changes."""

    def __init__(self) -> None:
        """Know nothing yet."""
        self.clear()

    def clear(self) -> None:
        """Forget a run: another one has begun in its place."""
        self._stamp: tuple[int, int] | None = None
        self._fields: Fields | None = None

    def read(self, run: Run, name: str) -> dict[str, Any]:
        """Return a field of the newest block, rows from below; cells without discs are None.

        Raises:
            NoDataError: the run has no profiles yet, or none of that name
        """
        fields = self._newest(run)
        values = fields.values(name)[-1]
        return {
            "names": list(fields.names),
            "step": float(fields.steps[-1]),
            "x": fields.x[-1].tolist(),
            "y": fields.y[-1].tolist(),
            "rows": [[float(v) if np.isfinite(v) else None for v in row] for row in values],
        }

    def _newest(self, run: Run) -> Fields:
        path = None if run.folder is None else Path(run.folder) / "measurements" / "profiles.csv"
        if path is None or not path.exists():
            raise NoDataError('needs "profiles" among output.measurements.quantities')
        about = path.stat()
        stamp = (about.st_mtime_ns, about.st_size)
        if self._fields is None or stamp != self._stamp:
            self._fields, self._stamp = Fields(run.tables["profiles"]), stamp
        if self._fields.n_blocks == 0:
            raise NoDataError("no block of profiles has ended yet")
        return self._fields
