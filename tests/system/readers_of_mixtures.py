# SPDX-License-Identifier: BSD-3-Clause
"""readers_of_mixtures.py READER LINES TRAJECTORY CHECKPOINT XYZ XYZ_OF_CHECKPOINT

Does READER see two species in a box that is periodic along x as they are? 20 discs of radius 2 and
mass 4, 60 of radius 0.957 and mass 1. Positions are those of the lines `step id x y vx vy`, in
single precision but for those of a checkpoint's XYZ.
"""

import numpy as np
from readers import expect_same, main, read_lines

N_LARGE, N_SMALL, SIZE, STEPS = 20, 60, 60, [0, 5, 10, 15, 20]
RADII = np.array([2.0] * N_LARGE + [0.957] * N_SMALL)
MASSES = np.array([4.0] * N_LARGE + [1.0] * N_SMALL)
SPECIES = np.array([0] * N_LARGE + [1] * N_SMALL)


def see_with_h5py(lines, trajectory, checkpoint, *_):
    import h5py

    for path in (trajectory, checkpoint):
        with h5py.File(path) as file:
            discs = file["particles/discs"]
            assert np.array_equal(discs["radius"][:], RADII), path
            assert np.array_equal(discs["species"][:], SPECIES), path
            assert list(discs["box"].attrs["boundary"]) == [b"periodic", b"none", b"none"], path
            assert np.all(discs["box/edges/value"][:] == [SIZE, SIZE, 1]), path
            table = file["parameters/species"]
            assert list(table["count"]) == [N_LARGE, N_SMALL] and list(table["mass"]) == [4, 1]
    with h5py.File(trajectory) as file:
        assert np.array_equal(file["particles/discs/mass"][:], MASSES)
        expect_same(file["particles/discs/position/value"][2, :, :2], lines[10][:, :2], "position")


def see_with_ase(lines, _, __, *paths):
    import ase.io

    for path, steps in zip(paths, (STEPS, [20])):
        frames = ase.io.read(path, index=":", format="extxyz")
        assert len(frames) == len(steps)
        for atoms, step in zip(frames, steps):
            assert atoms.info["Time"] == step
            assert list(atoms.pbc) == [True, False, False]
            assert np.array_equal(atoms.cell.array, np.diag([SIZE, SIZE, 1]))
            assert atoms.get_chemical_symbols() == ["H"] * N_LARGE + ["He"] * N_SMALL
            assert np.array_equal(atoms.arrays["radius"], RADII)
            assert np.array_equal(atoms.arrays["mass"], MASSES)
            expect_same(atoms.positions[:, :2], lines[step][:, :2], f"{path} {step}")
            expect_same(atoms.arrays["velo"][:, :2], lines[step][:, 2:4], f"{path} {step}")


def see_with_ovito(lines, _, __, *paths):
    from ovito.io import import_file

    for path, steps in zip(paths, (STEPS, [20])):
        pipeline = import_file(path)
        assert pipeline.source.num_frames == len(steps)
        for frame, step in enumerate(steps):
            data = pipeline.compute(frame)
            particles = data.particles
            assert data.attributes["Time"] == step
            assert list(data.cell.pbc) == [True, False, False]
            assert np.array_equal(np.asarray(data.cell)[:, :3], np.diag([SIZE, SIZE, 1]))
            assert np.allclose(particles["Radius"][...], RADII, rtol=1e-7, atol=0)
            assert np.allclose(particles["Mass"][...], MASSES, rtol=1e-7, atol=0)
            types = particles.particle_types
            names = [types.type_by_id(number).name for number in types[...]]
            assert names == ["H"] * N_LARGE + ["He"] * N_SMALL
            expect_same(particles.positions[...][:, :2], lines[step][:, :2], f"{path} {step}")


def see_with_mdanalysis(lines, trajectory, checkpoint, *_):
    import h5py
    import MDAnalysis

    for path, steps in ((trajectory, STEPS), (checkpoint, [20])):
        universe = MDAnalysis.Universe.empty(len(RADII), trajectory=True)
        universe.load_new(path, format="H5MD", convert_units=False, dt=5)
        with h5py.File(path) as file:
            universe.add_TopologyAttr("radii", file["particles/discs/radius"][:])
        assert universe.trajectory.dt == 5 and np.array_equal(universe.atoms.radii, RADII)
        for moment, step in zip(universe.trajectory, steps):
            assert moment.time == step
            assert list(moment.dimensions) == [SIZE, SIZE, 1, 90, 90, 90]
            expect_same(moment.positions[:, :2], lines[step][:, :2], f"{path} {step}")


def see_with_vtk(lines, trajectory, *_):
    import vtk
    from vtk.util.numpy_support import vtk_to_numpy

    reader = vtk.vtkXdmfReader()
    reader.SetFileName(trajectory.replace(".h5", ".xdmf"))
    reader.UpdateInformation()
    steps = reader.GetOutputInformation(0).Get(vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS())
    assert list(steps) == STEPS
    for step in STEPS:
        reader.UpdateTimeStep(step)
        grid = reader.GetOutputDataObject(0)
        values = grid.GetPointData()
        assert np.array_equal(vtk_to_numpy(values.GetArray("radius")), RADII)
        assert np.array_equal(vtk_to_numpy(values.GetArray("species")), SPECIES)
        points = vtk_to_numpy(grid.GetPoints().GetData())
        expect_same(points[:, :2], lines[step][:, :2], f"points {step}")


if __name__ == "__main__":
    main(
        {
            "h5py": see_with_h5py,
            "ase": see_with_ase,
            "ovito": see_with_ovito,
            "MDAnalysis": see_with_mdanalysis,
            "vtk": see_with_vtk,
        }
    )
