# SPDX-License-Identifier: BSD-3-Clause
"""The scenes that compare.py times, by name: gases of both methods, the boxes in which EDMD is the
peer, and discs of unequal sizes.
"""

import dataclasses
import math
from collections.abc import Callable

from measure import exact, fast, gas


def slow(n_discs, steps):
    """Packing 0.2, Maxwell's speeds: 0.005 diameters per component and step (rms), as LAMMPS moves
    its discs.
    """
    size = math.sqrt(n_discs * math.pi / 4 / 0.2)
    return (
        (
            f"[box]\nsize = {size!r}\n[discs]\ncount = {n_discs}\nradius = 0.5\nvelocities ="
            f" \"maxwell\"\nspeed = {0.005 * math.sqrt(2)!r}\n[time]\nsteps = {steps}\nmethod ="
            " \"time-stepped\"\n"
        ),
        "toml",
    )


PERIODIC = "".join(f'{side}.kind = "periodic"\n' for side in ("left", "right", "bottom", "top"))


def periodic(n_discs, packing, n_collisions):
    """A gas in a periodic box for about so many collisions: diameter 1, kT = 1, as in EDMD. Random
    insertion does not reach a packing of 0.7, so such discs grow to their size first.
    """
    size = math.sqrt(n_discs * math.pi / 4 / packing)
    contact = (1 - 7 * packing / 16) / (1 - packing) ** 2  # Enskog's rate
    per_time = n_discs * 4 * packing * contact / math.sqrt(math.pi)
    generator = 'generator = "compressed"\n' if packing > 0.5 else ""
    return (
        (
            f"[box]\nsize = {size!r}\n{PERIODIC}[discs]\ncount = {n_discs}\nradius = 0.5\nspeed ="
            f" {math.sqrt(2)!r}\n{generator}[time]\nsteps ="
            f" {max(1, round(n_collisions / per_time))}\nmethod = \"event-driven\"\n"
        ),
        "toml",
    )


def polydisperse(n_discs, packing, steps):
    """Radii spread evenly, with a standard deviation of 23 % of their mean; the largest disc may
    have diameter 1.
    """
    deviation = 0.23
    mean = 0.5 / (1 + math.sqrt(3) * deviation)
    size = math.sqrt(n_discs * math.pi * mean**2 * (1 + deviation**2) / packing)
    generator = 'generator = "compressed"\n' if packing > 0.5 else ""
    return (
        (
            f"[box]\nsize = {size!r}\n{PERIODIC}[discs]\ncount = {n_discs}\nspeed ="
            f" {math.sqrt(2)!r}\n{generator}[discs.radius]\nmean = {mean!r}\npolydispersity ="
            f" {deviation}\nmass = \"equal\"\n[time]\nsteps = {steps}\n"
            "method = \"event-driven\"\n"
        ),
        "toml",
    )


def mixture(n_discs, ratio, packing, steps):
    """Half of the area in discs `ratio` times as large; those have diameter 1, which EDMD's cells
    ask for. All masses are 1, since EDMD reads none.
    """
    n_large = round(n_discs / (1 + ratio**2))
    counts = ((n_large, 0.5), (n_discs - n_large, 0.5 / ratio))
    size = math.sqrt(sum(n * math.pi * r * r for n, r in counts) / packing)
    generator = 'generator = "compressed"\n' if packing > 0.5 else ""
    species = "".join(f"[[discs.species]]\ncount = {n}\nradius = {r!r}\n" for n, r in counts)
    return (
        (
            f"[box]\nsize = {size!r}\n{PERIODIC}{species}[discs]\nspeed = {math.sqrt(2)!r}\n"
            f"{generator}[time]\nsteps = {steps}\nmethod = \"event-driven\"\n"
        ),
        "toml",
    )


@dataclasses.dataclass
class Case:
    """`unit`: what the rate counts. `whole`: the time of the whole program, start included, instead
    of stepping alone. `edmd`: whether EDMD can run the same scene. `edmd_share`: how many of
    Carrom's collisions EDMD makes, where it would take minutes for all of them.
    """

    scene: Callable
    ranks: int = 1
    threads: int = 1
    unit: str = "disc-steps"
    peer: tuple | None = None
    goal: str = ""
    whole: bool = False
    edmd: bool = False
    edmd_share: float = 1


def beside_edmd():
    found = {}
    for packing in (0.3, 0.5, 0.7):
        for name, n_discs in (
            ("870", 870),
            ("4096", 4096),
            ("1e4", 10_000),
            ("1e5", 100_000),
            ("1e6", 1_000_000),
        ):
            if packing == 0.7 and n_discs == 1_000_000:
                continue  # its discs would grow for minutes in each round
            found[f"periodic, packing {packing}, {name}"] = Case(
                lambda s, n=n_discs, e=packing: periodic(n, e, s(2_000_000)),
                unit="collisions",
                edmd=True,
            )
    return found


def unequal_sizes():
    """Steps are for some two million collisions: at packing 0.4 a disc makes two in a step, or as
    many as the ratio of sizes, and at packing 0.7 six times as many.
    """
    found = {}
    for packing, steps in ((0.4, 100), (0.7, 16)):
        for ratio in (1, 3, 10, 30):
            found[f"sizes 1 and {ratio}, packing {packing}"] = Case(
                lambda s, r=ratio, p=packing, n=steps: mixture(
                    10_000, r, p, max(2, s(2 * n // max(2, r)))
                ),
                unit="collisions",
                edmd=True,
                edmd_share=1 if ratio < 10 else 1 / (2 * ratio),
            )
        found[f"sizes of 23 %, packing {packing}"] = Case(
            lambda s, p=packing, n=steps: polydisperse(10_000, p, s(n)),
            unit="collisions",
            edmd=True,
        )
    return found


def cases():
    found = {
        "slow gas, 1e5": Case(
            lambda s: slow(100_000, s(2048)), peer=(316, 600), goal="2e8, 6 x LAMMPS"
        ),
        "slow gas, 1e6": Case(
            lambda s: slow(1_000_000, s(512)), peer=(1000, 60), goal="1.5e8, 10 x LAMMPS"
        ),
        "slow gas, 1e6, 2 threads": Case(lambda s: slow(1_000_000, s(512)), threads=2),
        "slow gas, 1e6, 2 ranks": Case(lambda s: slow(1_000_000, s(512)), ranks=2),
        "gas, 1e6": Case(lambda s: gas(1_000_000, s(64)), goal="5e7"),
        "gas, 1e6, 2 threads": Case(lambda s: gas(1_000_000, s(64)), threads=2),
        "gas, 1e6, 2 ranks": Case(lambda s: gas(1_000_000, s(64)), ranks=2),
        "all, packing 0.3, 1e6": Case(
            lambda s: exact(1_000_000, 0.3, s(4_000_000)), unit="collisions", goal="2.5e6"
        ),
        "all, packing 0.3, 1e6, 2 threads": Case(
            lambda s: exact(1_000_000, 0.3, s(4_000_000)), threads=2, unit="collisions"
        ),
        "all, packing 0.3, 1e6, 2 ranks": Case(
            lambda s: exact(1_000_000, 0.3, s(4_000_000)), ranks=2, unit="collisions"
        ),
        "all, packing 0.5, 1e5": Case(
            lambda s: exact(100_000, 0.5, s(4_000_000)), unit="collisions", goal="3.5e6"
        ),
        "generated, 1e4, 500 steps": Case(lambda s: fast(10_000, s(500)), whole=True, goal="2 s"),
    }
    for name, n_discs, steps in (
        ("1e3", 1_000, 16_384),
        ("1e4", 10_000, 2048),
        ("1e5", 100_000, 256),
        ("1e7", 10_000_000, 8),
    ):
        found[f"gas, {name}"] = Case(lambda s, n=n_discs, k=steps: gas(n, s(k)))
    return found | beside_edmd() | unequal_sizes()
