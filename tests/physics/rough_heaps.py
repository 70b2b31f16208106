# SPDX-License-Identifier: BSD-3-Clause
"""Scenes of rough discs whose contacts last, which heaps.py and silo.py share."""

G, RADII, RESTITUTION = 0.01, (0.9, 1.1), 0.5


def surface(friction):
    """What discs, walls and obstacles have in common."""
    return (f"restitution = {RESTITUTION}\n"
            f"tangential_restitution = 0\nfriction = {friction}\n")


def effects(friction, speed):
    """Rough discs under gravity, whose contacts last below this speed."""
    return f"""[effects.contact]
kind = "rough"
contact_time = 0.001
{surface(friction)}
[effects.gravity]
y = {-G}
[effects.lasting_contacts]
speed = {speed}
"""


def discs_and_time(count, steps, sync_every):
    """Discs from a file that write_discs has written beside the scene."""
    return f"""[discs]
count = {count}
generator = "file"
file = "discs.txt"
columns = ["radius", "mass"]
[time]
steps = {steps}
method = "event-driven"
sync_every = {sync_every}
"""


def write_discs(path, discs):
    """Write discs at rest, given as x, y and radius, with masses by area."""
    with open(path, "w", encoding="utf-8") as file:
        for k, (x, y, radius) in enumerate(discs):
            file.write(f"{k} {x:.17g} {y:.17g} 0 0 {radius} {radius ** 2:.17g}\n")
