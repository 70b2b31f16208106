# SPDX-License-Identifier: BSD-3-Clause
"""python_loop.py: what a loop of `run(1)` costs, and the memory of a simulation in Python.

Both kinds of loop are done in turns in one process, on processor time, so that other work on the
machine slows both. Needs the extension: the variable CARROM_CORE, `build-python/`, or a wheel.
"""

import resource
import statistics
import time

import carrom

PERIODIC = {side: {"kind": "periodic"} for side in ("left", "right", "bottom", "top")}
TURNS, REPEATS = 25, 8


def scene(count: int, speed: float, **sides: object) -> dict:
    return {
        "box": {"size": count**0.5, **sides},
        "discs": {"count": count, "packing": 0.4, "speed": speed, "generator": "lattice"},
        "time": {"method": "event-driven", "steps": 10**6},
    }


def seconds(work) -> float:
    begin = time.process_time()
    work()
    return time.process_time() - begin


def loop(sim: carrom.Simulation) -> None:
    for _ in range(TURNS):
        sim.run(1)
        sim.positions  # noqa: B018


def compare(speed: float) -> None:
    """Print times of a step at 1e4 discs, in one call and with a look at each step."""
    whole = carrom.Simulation(scene(10_000, speed, **PERIODIC), threads=1)
    whole.run(20)  # the lattice melts
    cut, before = whole.copy(), whole.collisions
    pairs = []
    for _ in range(REPEATS):
        pairs.append((seconds(lambda: whole.run(TURNS)), seconds(lambda: loop(cut))))
    assert whole.state_hash == cut.state_hash
    rate = (whole.collisions - before) * 2 / 10_000 / (TURNS * REPEATS)
    one, each = (1e3 * statistics.median(column) / TURNS for column in zip(*pairs))
    ratio = statistics.median(b / a for a, b in pairs)
    read = seconds(lambda: [whole.positions for _ in range(1000)])
    print(
        f"{rate:.2f} collisions a disc and step: {one:.2f} ms a step in one call, {each:.2f} ms "
        f"with a look at each, ratio {ratio:.2f}; positions {read:.3f} ms"
    )


def peak() -> int:
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


def memory(name: str, sides: dict) -> None:
    """Print bytes a disc at the peak, of a million."""
    count, first = 1_000_000, peak()
    sim = carrom.Simulation(scene(count, 0.1, **sides), threads=1)
    sim.run(2)
    print(f"{name}: {(peak() - first) / count:.0f} bytes a disc", end="")
    kept = sim.positions, sim.velocities
    print(f", {(peak() - first) / count:.0f} with positions and velocities", end="")
    sim.velocities = -kept[1]
    print(f", {(peak() - first) / count:.0f} as velocities are set")


def main() -> None:
    carrom.Simulation(scene(100, 1)).run(1)  # loads libraries
    memory("periodic sides", PERIODIC)
    for speed in (1, 0.5, 0.25, 0.1):
        compare(speed)


main()
