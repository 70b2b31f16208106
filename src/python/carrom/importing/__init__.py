# SPDX-License-Identifier: BSD-3-Clause
"""Discs from files of other programs: GSD, LAMMPS, extended XYZ, CSV and plain rows.

`python3 -m carrom.importing FILE -o discs.h5` and `carrom-import` are the commands, `import_discs`
is the function behind them. A format is one file with a class that reads its frames.
"""

from carrom.importing.importer import FORMATS, Choice, import_discs, read_discs

__all__ = ["FORMATS", "Choice", "import_discs", "read_discs"]
