# SPDX-License-Identifier: BSD-3-Clause
"""Surfaces that slide and rub without loss drive discs. Where discs become faster without end, the
run ends with code 3, and says what to do. Where they only heat up, it goes on.
"""
from program import ProgramTest, main

DRIVEN = """
[box]
size = 20
[discs]
count = {count}
radius = 0.3
speed = 0.2
[time]
steps = {steps}
[effects.obstacles]
segments = [{segment}]
tangential_restitution = {stuck}
velocity = {velocity}
"""
WEDGE, FREE = "[0, 5, 20, 10]", "[5, 10, 15, 10]"


class Runaway(ProgramTest):
    def drive(self, ranks, segment, code=0, says=(), **more):
        words = {"count": 4, "steps": 400, "stuck": 1, "velocity": 0.3} | more
        self.write("scene.toml", DRIVEN.format(segment=segment, **words))
        return self.run_program(ranks, "run", "scene.toml", "--quiet", "--report", "r.json",
                                code=code, says=says).err

    def test_wedge(self):
        """Between the segment and a side a disc collides ever more often. Windows decide which is
        found first, its speed or its collisions without end; both messages have the remedy."""
        for ranks, count in (1, 4), (1, 300), (3, 60):
            said = self.drive(ranks, WEDGE, count=count, code=3)
            self.assertRegex(said, "(over 100,000 times as fast|collides without end).* try:? a "
                                   "restitution or a tangential_restitution below 1 there")

    def test_heating(self):
        """Far from sides a disc gains by turns: 4 u^2 a hit in the mean, for a mass of 1, over 2.
        The sums of some 100 hits scatter by some 100 %."""
        self.drive(1, FREE)
        report = self.report("r.json")
        gained = report["kinetic_energy"] - 4 * 0.02
        self.assertGreater(gained, 0.5)
        self.assertLess(gained, 8 * 0.3 ** 2 * report["wall_collisions"])

    def test_remedy(self):
        """With the loss that the message names the same wedge has a steady state."""
        self.drive(1, WEDGE, stuck=0, count=40)
        self.drive(1, WEDGE, velocity=0, count=40)


if __name__ == "__main__":
    main()
