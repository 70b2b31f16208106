# SPDX-License-Identifier: BSD-3-Clause
"""readers.py READER LINES TRAJECTORY CHECKPOINT: does READER see what the lines `step id x y vx vy`
say?

Both files hold single-precision numbers for other programs: the lines' numbers rounded to the
nearest are asked for, to the bit. A checkpoint's own columns are in double precision.
"""

import sys

import numpy as np


def read_lines(path):
    """{step: array (n, 4) of x, y, vx, vy}"""
    frames = {}
    with open(path) as lines:
        for line in lines:
            fields = line.split()
            frames.setdefault(int(fields[0]), []).append([float(field) for field in fields[2:6]])
    return {step: np.array(rows) for step, rows in frames.items()}


def expect_same(seen, wanted, what):
    if not np.array_equal(np.asarray(seen, dtype=np.float32), wanted.astype(np.float32)):
        sys.exit(f"{what}: not what the lines say")


def read_with_h5py(lines, trajectory, checkpoint):
    import h5py

    for path, steps in ((trajectory, [0, 5, 10, 15, 20]), (checkpoint, [20])):
        with h5py.File(path) as file:
            assert list(file["h5md"].attrs["version"]) == [1, 1]
            discs = file["particles/discs"]
            for element, columns in (("position", slice(0, 2)), ("velocity", slice(2, 4))):
                assert list(discs[element]["step"]) == steps
                for frame, step in enumerate(steps):
                    expect_same(
                        discs[element]["value"][frame, :, :2],
                        lines[step][:, columns],
                        f"{path} {element} {step}",
                    )
                    assert not discs[element]["value"][frame, :, 2].any()
            assert list(discs["box"].attrs["boundary"]) == [b"none"] * 3
    with h5py.File(checkpoint) as file:
        columns, run = file["carrom/discs"], file["carrom/run"]
        assert np.array_equal(columns["vx"][:], lines[20][:, 2]) and run["step"][()] == 20


def read_with_pyh5md(lines, trajectory, checkpoint):
    import pyh5md

    for path, steps in ((trajectory, [0, 5, 10, 15, 20]), (checkpoint, [20])):
        with pyh5md.File(path, "r") as file:
            discs = file.particles_group("discs")
            for element, columns in (("position", slice(0, 2)), ("velocity", slice(2, 4))):
                series = pyh5md.element(discs, element)
                assert list(series.step) == steps and list(series.time) == steps
                for frame, step in enumerate(steps):
                    expect_same(
                        series.value[frame][:, :2],
                        lines[step][:, columns],
                        f"{path} {element} {step}",
                    )


def read_with_mdanalysis(lines, trajectory, checkpoint):
    import MDAnalysis

    for path, steps in ((trajectory, [0, 5, 10, 15, 20]), (checkpoint, [20])):
        universe = MDAnalysis.Universe.empty(len(lines[0]), trajectory=True)
        universe.load_new(path, format="H5MD", convert_units=False, dt=5)
        assert universe.trajectory.dt == 5
        assert len(universe.trajectory) == len(steps)
        for moment, step in zip(universe.trajectory, steps):
            assert moment.time == step
            assert list(moment.dimensions) == [1023, 1023, 1, 90, 90, 90]
            expect_same(moment.positions[:, :2], lines[step][:, 0:2], f"{path} positions {step}")
            expect_same(moment.velocities[:, :2], lines[step][:, 2:4], f"{path} velocities {step}")


def read_with_vtk(lines, trajectory, _):
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    reader = vtk.vtkXdmfReader()
    reader.SetFileName(trajectory.replace(".h5", ".xdmf"))
    reader.UpdateInformation()
    steps = reader.GetOutputInformation(0).Get(vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS())
    assert list(steps) == [0, 5, 10, 15, 20]
    for step in steps:
        reader.UpdateTimeStep(step)
        grid = reader.GetOutputDataObject(0)
        expect_same(
            vtk_to_numpy(grid.GetPoints().GetData())[:, :2], lines[step][:, 0:2], f"points {step}"
        )
        expect_same(
            vtk_to_numpy(grid.GetPointData().GetArray("velocity"))[:, :2],
            lines[step][:, 2:4],
            f"velocity {step}",
        )


def main(readers):
    """Calls the reader that the first word names, with the lines and the other files."""
    reader, lines, *paths = sys.argv[1:]
    readers[reader](read_lines(lines), *paths)


if __name__ == "__main__":
    main(
        {
            "h5py": read_with_h5py,
            "pyh5md": read_with_pyh5md,
            "MDAnalysis": read_with_mdanalysis,
            "vtk": read_with_vtk,
        }
    )
