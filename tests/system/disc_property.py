# SPDX-License-Identifier: BSD-3-Clause
"""disc_property.py SCENE LINES FOLDER...: do discs have the charges that they began with?

Reads checkpoints and trajectories of runs with h5py. The scene `open` gives charges by species, the
scene `periodic` by the last word of LINES.
"""

import sys
from pathlib import Path

import h5py
import numpy as np


def first_charges(scene, lines):
    if scene == "open":
        return np.repeat([1.0, -2.5, 0.0], [100, 150, 50])
    table = np.loadtxt(lines)
    return table[np.argsort(table[:, 0]), 5]


def main(scene, lines, *folders):
    charges = first_charges(scene, lines)
    assert np.count_nonzero(charges) > 200
    for folder in map(Path, folders):
        checkpoints = sorted(folder.glob("checkpoints/*.h5"))
        assert checkpoints, folder
        for path in checkpoints:
            with h5py.File(path) as file:
                stored = file["carrom/discs/charge"][:]
                n_departed = np.count_nonzero(file["carrom/discs/tau"][:] == -1)
            assert np.array_equal(stored, charges), path
        assert (n_departed > 20) == (scene == "open"), f"{n_departed} discs have left"
        with h5py.File(folder / "trajectory.h5") as file:
            frames = file["particles/discs/charge/value"][:]
        assert frames.shape[0] > 0 and frames.shape[1:] == charges.shape, frames.shape
        assert np.array_equal(frames, np.tile(charges.astype(np.float32), (len(frames), 1)))


main(*sys.argv[1:])
