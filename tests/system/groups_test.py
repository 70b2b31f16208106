# SPDX-License-Identifier: BSD-3-Clause
"""Where discs begin: species by share or packing, groups, and discs that freeze. References are
counts worked out by hand, the places themselves, energies that the scene asks for, and the scene
that lists frozen discs as obstacles.
"""
import itertools
import json
import math

from program import ProgramTest, lines_of, main

SCENE = """
[box]
size = {box}
{sides}
[discs]
{discs}
[time]
steps = 300
"""
PERIODIC = "\n".join(f'{side}.kind = "periodic"' for side in ("left", "right", "bottom", "top"))
GROUPS = """velocities = "maxwell"
species = [{radius = 0.5}, {radius = 1, mass = 4}]
[[discs.groups]]
count = 60
region = [0, 0, 20, 40]
temperature = 0.04
[[discs.groups]]
packing = 0.6
species = 2
region = [20, 0, 40, 12]
generator = "compressed"
speed = 0
[[discs.groups]]
count = 40
region = [20, 14, 40, 24]
generator = "lattice"
temperature = 0.01
[[discs.groups]]
packing = 0.05
region = [0, 0, 40, 40]
"""
PACKED = round(0.6 * 20 * 12 / math.pi)
THIN = round(0.05 * 40 * 40 / (math.pi * 0.25))
N = 60 + 40 + THIN + PACKED


class Starts(ProgramTest):
    def write_scene(self, name, discs, box=40, sides=""):
        keys, mark, groups = discs.partition("\n[[")
        return self.write(f"{name}.toml", SCENE.format(box=box, sides=sides, discs=keys) + mark +
                          groups)

    def discs(self, name, *options, ranks=1, step=0):
        """Place and velocity of each disc."""
        out = self.run_program(ranks, "run", f"{name}.toml", "--quiet", "--set", "output.text=ends",
                               "--steps", step, *options).out
        return [tuple(map(float, line.split()[2:6])) for line in lines_of(out, step)]

    def facts(self, name, *options, ranks=1, steps=0):
        self.run_program(ranks, "run", f"{name}.toml", "--quiet", "--steps", steps, "--report",
                         "facts.json", *options)
        return self.report("facts.json")

    def check_within(self, discs, region, radius):
        x0, y0, x1, y1 = region
        for x, y, _, _ in discs:
            self.assertTrue(x0 + radius - 1e-12 <= x <= x1 - radius + 1e-12, (x, y))
            self.assertTrue(y0 + radius - 1e-12 <= y <= y1 - radius + 1e-12, (x, y))


class Shares(Starts):
    def test_counts(self):
        """A third of 100 discs goes to the largest rest. Shares of an area give numbers in the
        ratio of share over r^2. A packing gives the nearest number of discs in its region.
        """
        two = "species = [{{{} = {}, radius = 1}}, {{{} = {}, radius = 0.5}}]"
        for keys, areas in (
                ("count = 100\n" + two.format("share", 1 / 3, "share", 2 / 3), (33, 67)),
                ("count = 90\n" + two.format("share_of_area", 0.5, "share_of_area", 0.5),
                 (18, 72)),
                ("packing = 0.25\n" + two.format("share_of_area", 0.6, "share_of_area", 0.4),
                 (76, 204)),
                (two.format("packing", 0.1, "packing", 0.2), (51, 407)),
                (two.format("packing", 0.1, "count", 5), (51, 5)),
                (two.format("region = [0, 0, 20, 20], packing", 0.1, "packing", 0.2), (13, 407))):
            with self.subTest(keys):
                self.write_scene("shares", keys)
                facts = self.facts("shares")
                self.assertEqual(facts["n_discs"], sum(areas))
                covered = math.pi * (areas[0] + areas[1] / 4) / 1600
                self.assertAlmostEqual(facts["packing"], covered, delta=1e-12)

    def test_same_scene_as_counts(self):
        """A scene that gives the counts has the same bits, over a restart, too."""
        self.write_scene("shares", "packing = 0.25\nspecies = [{share_of_area = 0.6, radius = 1}, "
                         "{share_of_area = 0.4, radius = 0.5}]")
        self.write_scene("counts", "species = [{count = 76, radius = 1}, {count = 204, radius = "
                         "0.5}]")
        hashes = {self.facts(name, steps=20)["state_hash"] for name in ("shares", "counts")}
        self.assertEqual(len(hashes), 1)
        self.check_restart("shares.toml", first=20, last=40)

    def test_messages(self):
        one = "species = [{{{}, radius = 1}}, {{{}, radius = 2}}]"
        self.check_refused(lambda text: self.write_scene("wrong", text), (
                ("count = 9\n" + one.format("share = 0.5", "share = 0.6"),
                 "sum to 1.1, and must sum to 1"),
                ("count = 9\n" + one.format("share = 0.5", "share_of_area = 0.5"),
                 "the same of the two in all rows"),
                ("count = 9\n" + one.format("share = 0.5", "count = 5"), "in all rows"),
                (one.format("share = 0.5", "share = 0.5"), "give one of the two"),
                ("count = 9\npacking = 0.1\n" + one.format("share = 0.5", "share = 0.5"),
                 "give one of the two, not both"),
                ("count = 9\n" + one.format("share = 0.99", "share = 0.01"),
                 "row 2 of 'discs.species': its share or packing gives 0 discs"),
                (one.format("count = 3, packing = 0.1", "count = 4"),
                 "row 1 of 'discs.species': count and packing exclude each other"),
                (one.format("mass = 2", "count = 4"),
                 "it needs count, packing, share or share_of_area"),
                (one.format("packing = 1.5", "count = 4"),
                 "its packing must be greater than 0 and at most 1, not 1.5"),
                ("packing = 1e-9\n" + one.format("share = 0.5", "share = 0.5"),
                 "'discs.packing' gives 0 discs of the radii in 'discs.species'"),
                ("packing = 0.3\n" +
                 one.format("share = 0.5", "share = 0.5").replace("2}", "1e30}"),
                 "'discs.packing' gives 0 discs"),
                ("temperature = 1\n" + one.format("count = 3, mass = 0", "count = 4"),
                 "row 1 of 'discs.species': the mass must be from 2^-100 to 2^100, not 0"),
                ("packing = 0.2\n" + one.format("count = 3", "count = 4"),
                 "'discs.packing' has no meaning where 'discs.species' has counts")))


class Groups(Starts):
    def test_groups(self):
        """Ids count by species, then by group. Discs lie whole in their regions and overlap none,
        and each group has the energy that it asks for. Bits are the same on any ranks.
        """
        for sides in ("", PERIODIC):
            self.write_scene("groups", GROUPS, sides=sides)
            discs = self.discs("groups")
            ends = list(itertools.accumulate((60, 40, THIN, PACKED)))
            self.assertEqual(len(discs), N)
            parts = [discs[a:b] for a, b in zip([0, *ends], ends)]
            for part, region, radius in zip(parts, ((0, 0, 20, 40), (20, 14, 40, 24),
                                                    (0, 0, 40, 40), (20, 0, 40, 12)),
                                            (0.5, 0.5, 0.5, 1)):
                if sides == "":
                    self.check_within(part, region, radius)
            energies = [sum(vx * vx + vy * vy for _, _, vx, vy in part) / 2 for part in parts]
            for energy, wanted in zip(energies, (60 * 0.04, 40 * 0.01, THIN / 2, 0)):
                self.assertAlmostEqual(energy, wanted, delta=1e-12 * N)
            if sides:
                for part in parts:  # no part drifts
                    self.assertLess(abs(sum(vx for _, _, vx, _ in part)), 1e-12 * N)
            radii = [0.5] * ends[2] + [1] * PACKED
            for i, j in itertools.combinations(range(N), 2):
                dx, dy = (discs[i][k] - discs[j][k] for k in (0, 1))
                if sides:
                    dx, dy = (d - 40 * round(d / 40) for d in (dx, dy))
                self.assertGreater(math.hypot(dx, dy), radii[i] + radii[j] - 1e-12, (i, j))
            for ranks in (2, 5) if sides else (3,):
                self.assertEqual(self.discs("groups", "--threads", 2, ranks=ranks), discs)

    def test_run_and_restart(self):
        self.write_scene("groups", GROUPS)
        self.run_program(2, "run", "groups.toml", "--check", "--quiet", "--steps", 10)
        self.check_restart("groups.toml", first=10, last=20)
        self.run_program(1, "run", "groups.toml", "--restart", "kept", "--steps", 20, "--set",
                         'discs.groups=[{count = 3}]', code=2, says="'discs.groups'")

    def test_equal_groups_differ(self):
        """Two groups that are alike begin in different ways."""
        self.write_scene("alike", """radius = 0.5
[[discs.groups]]
count = 50
generator = "compressed"
region = [0, 0, 10, 10]
[[discs.groups]]
count = 50
generator = "compressed"
region = [10, 0, 20, 10]
""")
        discs = self.discs("alike")
        self.check_within(discs[:50], (0, 0, 10, 10), 0.5)
        self.check_within(discs[50:], (10, 0, 20, 10), 0.5)
        self.assertTrue(all(abs(b[0] - a[0] - 10) > 1e-6
                            for a, b in zip(discs[:50], discs[50:])))

    def test_one_group_is_the_scene(self):
        """One group in all of the box begins as the scene without groups, bit for bit."""
        for generator, sides in itertools.product(("random", "lattice", "compressed"),
                                                  ("", PERIODIC)):
            keys = f'radius = 1\nspeed = 0.1\n{{}}count = 100\ngenerator = "{generator}"\n'
            self.write_scene("one", keys.format("[[discs.groups]]\n"), sides=sides)
            self.write_scene("none", keys.format(""), sides=sides)
            hashes = {self.facts(name)["state_hash"] for name in ("one", "none")}
            self.assertEqual(len(hashes), 1, (generator, sides))

    def test_messages(self):
        first = "radius = 0.5\n[[discs.groups]]\n"
        species = "species = [{radius = 1}, {radius = 2}]\n[[discs.groups]]\n"
        self.check_refused(lambda text: self.write_scene("wrong", text), (
                (first + "radius = 1", "has no 'radius'"),
                (first + "temperature = 1", "row 1 of 'discs.groups': it needs count or packing"),
                (first + "count = 2\npacking = 0.1", "count and packing exclude each other"),
                (first + "count = 2.5", "its count must be a whole number from 1"),
                (first + "packing = 1e-9", "its packing gives 0 discs in its region"),
                (first + "count = 3\nspecies = 2", "not 2; without that key all discs are alike"),
                (species + "count = 3", "no row of 'discs.groups' has discs of it"),
                (species.replace("{radius = 1}", "{radius = 1, count = 3}") + "count = 3",
                 "its count is that of its groups"),
                (first + "count = 3\ngenerator = \"triangular\"",
                 'generator must be "random", "lattice" or "compressed", not'),
                (first + "count = 3\nfreeze = 1", "freeze must be true or false"),
                (first + "count = 3\nregion = [0, 0, 50, 2]", "its region must be [x0"),
                (first + "count = 3\nregion = [0, 0, 40, 0.5]", "is narrower than a disc"),
                (first + "count = 300\nregion = [0, 0, 10, 10]", "its region would be covered to"),
                (first + 'count = 120\nregion = [0, 0, 10, 10]\ngenerator = "lattice"',
                 "no lattice of 120 discs of radius 0.5 fits"),
                (first + 'count = 120\nregion = [0, 0, 10, 10]\ngenerator = "compressed"',
                 "would cover 0.9425 of its region"),
                (first + 'count = 9\ngenerator = "lattice"\n[[discs.groups]]\ncount = 9\n'
                 'generator = "compressed"', "row 2 of 'discs.groups': its region overlaps that"),
                (first + "count = 3\ntemperature = 1\nspeed = 1",
                 "temperature and speed exclude each other"),
                (first + "count = 3\ntemperature = -1", "its temperature must be 0, or give"),
                ("count = 3\n" + first + "count = 3",
                 "'discs.count' and 'discs.groups' exclude each other")))

    def test_lattice_over_an_obstacle(self):
        self.write_scene("pins", "radius = 0.5\n[[discs.groups]]\ncount = 100\nregion = "
                         '[0, 0, 20, 20]\ngenerator = "lattice"\n')
        inside = "effects.obstacles.discs=[[10, 10, 3]]"
        run = self.run_program(3, "run", "pins.toml", "--set", inside, code=2,
                               says=("overlaps fixed disc 1 by", "a region beside it"))
        self.assertEqual(run.err.count("overlaps"), 1, run.err)
        beside = "effects.obstacles.discs=[[30, 30, 3]]"
        self.run_program(3, "run", "pins.toml", "--set", beside, "--check", "--quiet", "--steps", 5)


FROZEN = """count = 90
radius = 1
generator = "compressed"
speed = 0.1
freeze = [[0, 0, 20, 3], [0, 17, 20, 20]]
"""


class Freezing(Starts):
    def test_frozen_discs_are_obstacles(self):
        """The run is that of a scene that lists the frozen discs as obstacles and the others as
        discs. The start has all of them: those of the scene without the key.
        """
        self.write_scene("whole", FROZEN.replace("freeze", "#"), 20)
        self.write_scene("frozen", FROZEN, 20)
        whole, free = self.discs("whole"), self.discs("frozen")
        still = [disc for disc in whole if disc[1] <= 3 or disc[1] >= 17]
        self.assertEqual([disc[:2] for disc in free],
                         [disc[:2] for disc in whole if 3 < disc[1] < 17])
        self.assertTrue(10 < len(still) < 40)
        facts = self.facts("frozen", steps=20)
        self.assertEqual(facts["n_discs"], len(free))
        self.assertIn(f"{len(still)} fixed discs", json.dumps(facts["effects"]))
        self.assertAlmostEqual(facts["kinetic_energy"], len(free) * 0.1 ** 2 / 2, delta=1e-12)
        rows = ", ".join(f"[{x!r}, {y!r}, {vx!r}, {vy!r}]" for x, y, vx, vy in free)
        bodies = ", ".join(f"[{x!r}, {y!r}, 1]" for x, y, _, _ in still)
        self.write_scene("listed", f"radius = 1\nlist = [{rows}]\n[effects.obstacles]\n"
                         f"discs = [{bodies}]", 20)
        self.assertEqual(self.facts("listed", steps=20)["state_hash"], facts["state_hash"])

    def test_same_bits_and_restart(self):
        for sides in ("", PERIODIC):
            self.write_scene("frozen", FROZEN, 20, sides)
            hashes = {self.facts("frozen", "--threads", threads, ranks=ranks,
                                 steps=20)["state_hash"]
                      for ranks, threads in ((1, 3), (3, 2), (5, 1))}
            self.assertEqual(len(hashes), 1)
        self.run_program(2, "run", "frozen.toml", "--check", "--quiet", "--steps", 20)
        self.check_restart("frozen.toml", first=10, last=20)
        # with the scene, and after a change that no restart can make
        self.run_program(2, "run", "frozen.toml", "--restart", "kept", "--steps", 20, "--quiet",
                         "--report", "again.json", "-o", "again")
        self.assertEqual(self.hash_of("again.json"), self.hash_of("whole.json"))
        self.run_program(1, "run", "frozen.toml", "--restart", "kept", "--steps", 20, "--set",
                         "discs.freeze=[[0, 0, 20, 5]]", "-o", "other", code=2,
                         says="'discs.freeze' is another list there")
        self.run_program(1, "run", "frozen.toml", "--resume", "--steps", 30, "-o", "kept",
                         "--quiet")

    def test_frozen_group(self):
        """A dense block that rests, and a gas around it, of species with numbers of their own."""
        self.write_scene("block", """species = [{radius = 0.5}, {radius = 1, mass = 2}]
[[discs.groups]]
count = 60
region = [15, 15, 25, 25]
generator = "compressed"
freeze = true
[[discs.groups]]
count = 100
temperature = 0.02
[[discs.groups]]
count = 30
species = 2
temperature = 0.02
""")
        discs = self.discs("block")
        self.assertEqual(len(discs), 130)
        facts = self.facts("block", "--check", ranks=3, steps=20)
        self.assertAlmostEqual(facts["kinetic_energy"], 130 * 0.02, delta=1e-12)
        self.assertIn("60 fixed discs", json.dumps(facts["effects"]))
        self.check_restart("block.toml", first=10, last=20)

    def test_file_of_discs(self):
        """Discs of a file with radii freeze where they are; the others keep their order."""
        self.write("d.txt", "x,y,vx,vy,radius\n5,5,0,0,1\n20,20,1,0,2\n35,35,0,0,1\n30,20,0,1,1\n")
        self.write_scene("file", 'file = "d.txt"\nfreeze = [[0, 0, 10, 10], [34, 34, 36, 36]]')
        self.assertEqual(self.discs("file"), [(20, 20, 1, 0), (30, 20, 0, 1)])
        self.check_restart("file.toml", first=50, last=100)
        self.run_program(1, "run", "file.toml", "--restart", "kept", "--steps", 100, "--quiet",
                         "--report", "again.json", "-o", "again")
        self.assertEqual(self.hash_of("again.json"), self.hash_of("whole.json"))

    def test_messages(self):
        self.check_refused(lambda text: self.write_scene("wrong", text), (
                (FROZEN + "frozen = [[3, 1, 1, 1], [2, 3, 3, 1]]", "ids must be of discs"),
                (FROZEN + "frozen = [[3, 1, 1, 1]]", "'discs.frozen' is written by the program"),
                (FROZEN.replace("[[0, 0, 20, 3], [0, 17, 20, 20]]", "[[3, 0, 2, 3]]"),
                 "row 1 of 'discs.freeze': it must be [x0, y0, x1, y1] with x0 <= x1"),
                (FROZEN.replace("90", "9").replace("[[0, 0, 20, 3], [0, 17, 20, 20]]",
                                                     "[[0, 0, 0.5, 0.5]]"),
                 "no disc begins in a region of 'discs.freeze'"),
                (FROZEN.replace("90", "9").replace("[[0, 0, 20, 3], [0, 17, 20, 20]]",
                                                     "[[0, 0, 40, 40]]"),
                 "all 9 discs are frozen"),
                ("count = 9\nradius = 1\nfrozen = [[0, 1, 1, 1]]",
                 "'discs.frozen' has no meaning without 'discs.freeze'"),
                (FROZEN + "[box.top]\nkind = \"moving\"\nspeed = -0.01", "walls that move")))


if __name__ == "__main__":
    main()
