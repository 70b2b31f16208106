# SPDX-License-Identifier: BSD-3-Clause
"""What a case of cluster_model.py asks of its ranks: from counted figures and cluster_plan.py to
the script that replay_cluster.cpp replays.
"""

import math
import random
from typing import NamedTuple

import cluster_plan
from cluster_plan import DISC_BYTES, HISTORY_BYTES, Window

RANKS_PER_NODE = 32
# Nanoseconds on one core of the AMD EPYC (docs/data/performance/rates.csv): a collision of the gas
# of packing 0.5, all else included, and a disc and micro-step of the time-stepped method's gas of
# packing 0.2. A disc of a halo takes 33 ns to plan, pack and add.
NS_COLLISION, NS_STEP, NS_HALO = 383.0, 31.4, 33.0
SENT_TO_OWN = 2.1  # cost of a sent disc over that of an own disc (simulate.py)
# The speed bound of a window over the largest speed (BlockTuning), and the largest speed over its
# expected value. The second factor exceeds 1 because bounds fall slowly, so that they follow the
# fastest disc of many windows; it is fitted to the bytes of halos.
SPEED_ALLOWANCE, SPEED_KEPT = 1.08, 1.09
RMS_SPEED = 0.5  # in window_counts, in radii per step
# The time-stepped method: windows of three micro-steps, the depth of halos in mean distances of
# discs, and the share of halo discs that are sent again in each micro-step, because they have
# collided. Both reproduce the bytes of docs/data/performance/cluster.csv, "weak, 1e6 a rank", on
# 256 and 1024 ranks.
MICRO_STEPS = 3
STEPPED_DEPTH, STEPPED_UPDATES = 2.0, 0.17

EVENT_PHASES = (
    "exchange 0",  # few discs change ranks
    f"exchange {DISC_BYTES}",
    "compute",
    f"exchange {HISTORY_BYTES}",
    "reduce 56",
    "again",
    "exchange 0",
    "reduce 56",
    "exchange 0",  # which ranks need more halo
    "exchange 0",  # few ranks get more halo
    "reduce 16",
    "compute",
    f"exchange {HISTORY_BYTES}",
    "reduce 56",
)
STEPPED_PHASES = (
    "exchange 0",
    f"exchange {DISC_BYTES}",
    "reduce 8",
    *("compute", f"exchange {DISC_BYTES * STEPPED_UPDATES:.2f}", "reduce 8") * MICRO_STEPS,
)


class Case(NamedTuple):
    name: str
    ranks: int
    n_discs: float
    method: str = "event-driven"
    is_even: bool = True
    rows: int = 1  # number of ranks in a column
    per_node: int = RANKS_PER_NODE
    windows: int = 6


def reach_of(counted, n_discs):
    """In mean distances of discs. The fastest of n discs has sqrt(2 log n) of a component's
    standard deviation.
    """
    fastest = RMS_SPEED / math.sqrt(2) * math.sqrt(2 * math.log(n_discs))
    radii = 2 + 2 * SPEED_ALLOWANCE * SPEED_KEPT * fastest * counted.micro_steps
    return radii / math.sqrt(math.pi / counted.packing)


class Plan(NamedTuple):
    """What a case asks of its ranks."""

    phases: tuple
    halos: list  # for each rank {other rank: discs}
    first: list  # computing time of each rank in a window in nanoseconds, its halo included
    again: list  # nanoseconds for the repeated run of a block
    rollbacks: float  # in a window
    marked: float  # block runs of a rollback
    own: float  # nanoseconds that one core would take for a rank's share
    seen: float  # discs in blocks with their halos, over own discs
    collisions: list  # collisions of each rank in a window


def gas_of(case):
    if case.is_even:
        return cluster_plan.even_gas(case.n_discs)
    return cluster_plan.half_crowded_gas(case.n_discs)


def event_plan(case, counts):
    """Blocks look a reach further if ranks wait longer for repeated runs than that costs
    (Caution in src/event_driven/block_window.hpp).
    """
    plan, deeper = (plan_with_halo(case, counts, halo) for halo in (3, 4))
    if waited_in(case, plan) <= sum(deeper.first) / sum(plan.first) - 1:
        return plan
    return deeper._replace(rollbacks=0)  # hardly any rollbacks were counted with this halo


def waited_in(case, plan, windows=20):
    """Mean over windows of the time that ranks wait for the one that repeats most, over that of
    first runs.
    """
    chance = random.Random(39)
    longest = [max(again_in(case, plan, chance).values(), default=0) for _ in range(windows)]
    return sum(longest) / windows * case.ranks / sum(plan.first)


def plan_with_halo(case, counts, halo):
    counted = counts[case.is_even]
    gas = gas_of(case)
    box = cluster_plan.box_of(gas)
    window = Window(counted.collisions, reach_of(counted, case.n_discs), halo)
    small = cluster_plan.even_gas(1e5)
    even = Window(counts[True].collisions, reach_of(counts[True], 1e5), 3)
    ns = NS_COLLISION * 1e5 * even.collisions
    ns /= cluster_plan.blocks_of(small, cluster_plan.box_of(small), even).work
    one = cluster_plan.blocks_of(gas, box, window._replace(halo=3))
    cut = cluster_plan.cut_box(gas, case.ranks, case.rows, True, window)
    blocks = [cluster_plan.blocks_of(gas, part, window) for part in cut.rectangles()]
    halos = cluster_plan.halos(gas, cut, window.depth)
    return Plan(
        EVENT_PHASES,
        halos,
        [b.work * ns + NS_HALO * sum(h.values()) for b, h in zip(blocks, halos)],
        [b.repeated_work * ns for b in blocks],
        counted.rollbacks * sum(b.borders for b in blocks),
        counted.marked,
        one.work * ns / case.ranks,
        sum(b.seen for b in blocks) / sum(b.n_own for b in blocks),
        [b.collisions for b in blocks],
    )


def stepped_plan(case):
    """All discs cost the same: those that collide in a micro-step are few."""
    gas = gas_of(case)
    window = Window(0.0, 1.0, 1)
    cut = cluster_plan.cut_box(gas, case.ranks, case.rows, False, window)
    halos = cluster_plan.halos(gas, cut, STEPPED_DEPTH)
    own = [sum(p.discs_in(part) for p in gas) for part in cut.rectangles()]
    sent = [sum(h.values()) * (1 / MICRO_STEPS + STEPPED_UPDATES) for h in halos]
    return Plan(
        STEPPED_PHASES,
        halos,
        [NS_STEP * n + SENT_TO_OWN * NS_STEP * s for n, s in zip(own, sent)],
        [],
        0,
        0,
        NS_STEP * case.n_discs / case.ranks,
        1 + sum(map(lambda h: sum(h.values()), halos)) / case.n_discs,
        own,
    )


def script_of(case, plan):
    """Numbers and words for replay_cluster. Times scatter as the number of collisions does."""
    chance = random.Random(39)
    lines = [f"{case.ranks} {case.per_node} {case.windows}"]
    for rank, gets in enumerate(plan.halos):
        partners = sorted(gets)
        words = [f"{len(partners)}"]
        words += [f"{p} {plan.halos[p].get(rank, 0.0):.0f} {gets[p]:.0f}" for p in partners]
        lines.append(" ".join(words))
    lines.append(f"{len(plan.phases)} " + " ".join(plan.phases))
    for _ in range(case.windows):
        times = [
            max(0.0, t * chance.gauss(1, 1 / math.sqrt(max(1.0, n))))
            for t, n in zip(plan.first, plan.collisions)
        ]
        lines.append(" ".join(f"{t:.0f}" for t in times))
        lines.append(rollback_line(case, plan, chance))
    return "\n".join(lines) + "\n"


def rollback_line(case, plan, chance):
    again = again_in(case, plan, chance)
    if not again:
        return "-1"
    return f"{len(again)} " + " ".join(f"{r} {t:.0f}" for r, t in sorted(again.items()))


def again_in(case, plan, chance):
    """Time of repeated runs in a window, by rank. A rollback repeats blocks of a rank and of one of
    its partners, or of the rank alone.
    """
    again = {}
    for _ in range(poisson(chance, plan.rollbacks)):
        rank = chance.randrange(case.ranks)
        beside = sorted(plan.halos[rank]) or [rank]
        n_marked = max(1, int(plan.marked + chance.random()))
        for k in range(n_marked):
            marked = rank if k % 2 == 0 else chance.choice([rank, chance.choice(beside)])
            again[marked] = again.get(marked, 0.0) + plan.again[marked]
    return again


def poisson(chance, mean):
    if mean > 50:
        return max(0, round(chance.gauss(mean, math.sqrt(mean))))
    n, product = 0, chance.random()
    while product > math.exp(-mean):
        n, product = n + 1, product * chance.random()
    return n
