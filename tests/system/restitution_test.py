# SPDX-License-Identifier: BSD-3-Clause
"""Every collision has its restitution, whenever it comes: at the start, at a sync, or right after
one. Only chains of many collisions within next to no way are elastic, and the run counts these.

Expected numbers follow from restitution by hand.
"""
import math

from program import SOURCES, ProgramTest, checkpoint, lines_of, main

BOX = "[box]\nsize = [40, 10]\n"
PAIR = BOX + """
[discs]
radius = 1
list = [[{left}, 5, 0.1, 0], [{right}, 5, -0.1, 0]]
[effects.contact]
kind = "{kind}"
restitution = 0.5
{more}
[time]
steps = {steps}
[output]
text = "ends"
"""
CRADLE = """
[box]
size = [40, 4]
[discs]
radius = 1
list = [[1, 2, 3, 0], [6, 2, 0, 0], [8.001, 2, 0, 0], [10.002, 2, 0, 0], [12.003, 2, 0, 0]]
[effects.contact]
kind = "restitution"
restitution = 0.9
[time]
steps = 2
[output]
text = "ends"
"""
BALL = """
[box]
size = 40
bottom = {{ kind = "{kind}", restitution = {restitution} {more} }}
[discs]
radius = 1
list = [[20, {height}, 0, {speed}]]
[effects.gravity]
y = -0.01
[time]
steps = {steps}
[output]
text = "ends"
"""


class Restitution(ProgramTest):
    def velocities(self, text, last, ranks=1):
        """(vx, vy) of each disc at the last step."""
        run = self.run_program(ranks, "run", self.write("scene.toml", text), "--report", "r.json")
        return [tuple(map(float, line.split()[4:6])) for line in lines_of(run.out, last)]

    def test_wall_at_the_start(self):
        text = BOX.replace("\n", '\nright.restitution = 0.5\n', 2).replace(
            "right.restitution = 0.5\nsize", "size") + """
            [discs]
            radius = 1
            list = [[39, 5, 0.1, 0]]
            [time]
            steps = 10
            [output]
            text = "ends"
            """
        self.assertEqual(self.velocities(text, 10), [(-0.05, 0)])

    def test_obstacle_at_the_start(self):
        text = BOX + """
            [discs]
            radius = 1
            list = [[17, 5, 0.1, 0]]
            [effects.obstacles]
            discs = [[20, 5, 2]]
            restitution = 0.5
            [time]
            steps = 10
            [output]
            text = "ends"
            """
        (speed, _), = self.velocities(text, 10)
        self.assertAlmostEqual(speed, -0.05, delta=1e-15)

    def test_pairs_around_a_sync(self):
        """Contacts at 64 plus 0.00005, 0 and a rounding, at the start, and in mid-interval."""
        rough = "tangential_restitution = -1"
        for kind, more in (("restitution", ""), ("rough", rough)):
            for time in (64.00005, 64.0, 64 + 2 ** -40, 0.0, 30.0, 128.000001):
                half = 1 + 0.1 * time
                text = PAIR.format(left=20 - half, right=20 + half, kind=kind, more=more, steps=200)
                with self.subTest(kind=kind, time=time):
                    ends = self.velocities(text, 200)
                    self.assertAlmostEqual(ends[0][0], -0.05, delta=1e-15)
                    self.assertAlmostEqual(ends[1][0], 0.05, delta=1e-15)

    def test_ball_falls_on_the_floor_at_a_sync(self):
        """It hits with g 64, and rises to a quarter of the height."""
        height = 1 + 0.005 * 64 ** 2
        text = BALL.format(kind="wall", restitution=0.5, more="", height=height, speed=0, steps=80)
        (_, speed), = self.velocities(text, 80)
        self.assertAlmostEqual(speed, 0.5 * 0.64 - 0.01 * 16, delta=1e-10)

    def test_orbit_on_a_shaken_plate(self):
        """A ball that is up for one period of 64 steps, so that it comes down at syncs: its
        speed returns if the plate's is g P / 2 times (1 - e) / (1 + e) at that phase, which
        attracts it on the way up.
        """
        restitution, phase, period = 0.8, 0.3, 64
        leaving = 0.01 * period / 2
        plate = leaving * (1 - restitution) / (1 + restitution)
        amplitude = plate * period / (2 * math.pi * math.cos(phase))
        more = f", amplitude = {amplitude!r}, period = {period}, phase = {phase}"
        place = 1 + amplitude * math.sin(phase)
        text = BALL.format(kind="oscillating", restitution=restitution, more=more, height=place,
                           speed=leaving, steps=64 * 40 + 32)
        (_, speed), = self.velocities(text, 64 * 40 + 32)
        self.assertAlmostEqual(speed, 0, delta=1e-6)  # at the top
        self.assertIn(self.report("r.json")["wall_collisions"], (40, 41))

    def test_cradle(self):
        for ranks in (1, 3):
            ends = self.velocities(CRADLE, 2, ranks)
            self.assertAlmostEqual(ends[4][0], 3 * 0.95 ** 4, delta=1e-12)
            self.assertEqual(self.report("r.json")["guarded_collisions"], 0)

    def test_memory_of_a_collision_survives_a_checkpoint(self):
        """A restart in the middle of a collapse has the same bits."""
        gas = SOURCES / "inputs/cooling.toml"
        self.check_restart(gas, ["--set", "discs.count=300", "--set",
                                 "effects.contact.restitution=0.2", "--set",
                                 "time.sync_every=7"], first=40, last=60)
        self.assertTrue((self.folder / checkpoint("kept", 40)).exists())

    def test_long_contact_times_are_counted(self):
        haff = SOURCES / "inputs/haff.toml"
        self.run_program(2, "run", haff, "-o", "short", "--report", "short.json")
        self.run_program(2, "run", haff, "--set", "effects.contact.contact_time=0.01", "-o", "long",
                         "--report", "long.json",
                         says=["749 collisions took no energy", "effects.contact.contact_time"])
        short, long = self.report("short.json"), self.report("long.json")
        self.assertEqual(short["guarded_collisions"], 0)
        self.assertGreater(long["guarded_share"], 0.01)
        # What they did not take is in the energy that is left over the run.
        self.assertLess(long["guarded_share"], 0.03)

    def test_collapse_ends(self):
        """A wall of e = 0.5 and discs of e = 0.1 in a row collapse, which the guard ends."""
        row = ", ".join(f"[{x}, 5, {vx}, 0]" for x, vx in
                        zip((3, 7, 11, 15, 19), (0, 0, 0, 0, -0.5)))
        text = BOX + f"left.restitution = 0.5\n[discs]\nradius = 1\nlist = [{row}]\n" + """
            [effects.contact]
            kind = "restitution"
            restitution = 0.1
            [time]
            steps = 1000
            [output]
            text = "ends"
            """
        hashes = set()
        for ranks in (1, 2):
            ends = self.velocities(text, 1000, ranks)
            hashes.add(self.hash_of("r.json"))
        self.assertEqual(len(hashes), 1)
        self.assertLess(self.report("r.json")["pair_collisions"], 2000)
        self.assertLess(max(abs(vx) for vx, _ in ends), 0.05)

    def test_wedges_end(self):
        """A disc is driven between a rubbing obstacle and a wall, and one flies into a corner of
        two lines: both collide without end, and the runs end and say what the guard spares.
        """
        self.write("driven.toml", """
            [box]
            size = [16, 12]
            [discs]
            radius = 0.677
            list = [[4, 11, -1, 0]]
            [time]
            steps = 3
            [effects.obstacles]
            discs = [[2.462, 10.423, 0.5]]
            restitution = 0
            tangential_restitution = 0.3
            velocity = 0.4
            """)
        for ranks in (1, 2):
            run = self.run_program(ranks, "run", "driven.toml", "--report", f"{ranks}.json",
                                   patience=60)
            self.assertRegex(run.err, r"warning: \d+ collisions took no energy")
        self.assertEqual(self.hash_of("1.json"), self.hash_of("2.json"))
        self.assertLess(self.report("1.json")["wall_collisions"], 3000000)
        self.write("corner.toml", """
            [box]
            size = 20
            [discs]
            radius = 0.5
            list = [[4, 10, 0.5, 0]]
            [time]
            steps = 500
            [effects.obstacles]
            segments = [[1, 9, 19, 9.9999], [1, 11, 19, 10.0001]]
            restitution = 0.3
            """)
        energies = []
        for words in ((), ("--set", "effects.contact.contact_time=1e-9")):
            run = self.run_program(1, "run", "corner.toml", "--report", "c.json", *words)
            self.assertIn("collisions took no energy", run.err)
            energies.append(self.report("c.json")["kinetic_energy"])
        self.assertLess(energies[1], energies[0] / 3)  # the advice of the warning helps


if __name__ == "__main__":
    main()
