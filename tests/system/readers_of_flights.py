# SPDX-License-Identifier: BSD-3-Clause
"""readers_of_flights.py READER FREE WHOLE RESUMED MEASURED: units and image counts of flights
around a periodic box of 10, as READER (h5py or MDAnalysis) sees them.

FREE, WHOLE and RESUMED are trajectories. Discs of FREE do not meet, so that each goes on evenly.
MEASURED is the table of displacements that the run of WHOLE has added up by itself.
"""

import sys

import numpy as np

BOX = 10
UNITS = {
    "position/value": "nm",
    "position/time": "ps",
    "velocity/value": "nm ps-1",
    "box/edges/value": "nm",
    "radius": "nm",
}


def unwrapped(file):
    """Places (frames, discs, 2) on an endless plane."""
    discs = file["particles/discs"]
    places, images = discs["position/value"], discs["image/value"]
    assert images.dtype == np.int32 and images.shape == places.shape
    assert not images[:, :, 2].any() and np.array_equal(discs["image/step"], discs["position/step"])
    assert places[:, :, :2].min() >= 0 and places[:, :, :2].max() <= BOX
    return (places[:] + images[:] * discs["box/edges/value"][:][:, None])[:, :, :2]


def read_with_h5py(free, whole, resumed, measured):
    import h5py

    with h5py.File(free) as file:
        discs = file["particles/discs"]
        steps, velocities = discs["position/step"][:], discs["velocity/value"][:, :, :2]
        seen = unwrapped(file)
        assert np.abs(discs["image/value"]).max() > 20, "no disc has flown far"
        assert np.array_equal(discs["image/value"][0], np.zeros_like(discs["image/value"][0]))
        wanted = seen[0] + steps[:, None, None] * velocities[0]
        assert np.abs(seen - wanted).max() < 1e-9, "discs that do not meet fly on evenly"
        for name, unit in UNITS.items():
            assert discs[name].attrs["unit"] == unit, name
        assert "unit" not in discs["image/value"].attrs
        units = file["h5md/modules/units"].attrs
        assert list(units["version"]) == [1, 0] and units["system"] == b"SI"
    with h5py.File(whole) as one, h5py.File(resumed) as other:
        seen = unwrapped(one)
        assert "modules" not in one["h5md"] and "unit" not in one[
            "particles/discs/position/value"].attrs
        for name in ("image", "position", "velocity"):
            path = f"particles/discs/{name}/value"
            assert np.array_equal(one[path], other[path]), f"{name} of another machine shape"
    table = np.loadtxt(measured, delimiter=",", comments="#", skiprows=4, ndmin=2)
    squares = ((seen - seen[0]) ** 2).mean(axis=1)
    assert np.abs(np.diff(seen, axis=0)).max() > BOX, "no disc has flown far"
    assert np.allclose(table[:, 1:3], squares, rtol=1e-12, atol=1e-12), "displacements"


def read_with_mdanalysis(free, whole, resumed, measured):
    import h5py
    import MDAnalysis

    with h5py.File(free) as file:
        places = file["particles/discs/position/value"][:]
        velocities = file["particles/discs/velocity/value"][:]
    universe = MDAnalysis.Universe.empty(places.shape[1], trajectory=True, velocities=True)
    universe.load_new(free, format="H5MD", dt=5)  # units are known: it takes Angstrom and ps
    assert universe.trajectory.units["length"] == "nm"
    for moment, place, velocity in zip(universe.trajectory, places, velocities, strict=True):
        assert np.allclose(moment.positions, 10 * place, rtol=1e-6, atol=1e-5)
        assert np.allclose(moment.velocities, 10 * velocity, rtol=1e-6, atol=1e-5)
        assert moment.time == 5 * moment.frame
        assert np.allclose(moment.dimensions[:2], 10 * BOX)


reader, *files = sys.argv[1:]
{"h5py": read_with_h5py, "MDAnalysis": read_with_mdanalysis}[reader](*files)
