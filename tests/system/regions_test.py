# SPDX-License-Identifier: BSD-3-Clause
"""Regions in which discs begin at random. References are the places themselves, the scene without a
region where the region is all of the box, and the uniform distribution.
"""
from program import ProgramTest, lines_of, main

SCENE = """
[box]
size = {box}
{sides}
[discs]
{discs}
speed = 0.1
[time]
steps = 400
"""

PERIODIC = "\n".join(f'{side}.kind = "periodic"' for side in ("left", "right", "bottom", "top"))
TWO_GASES = """
[[discs.species]]
count = 90
radius = 0.25
region = [0, 0, 10, 20]
[[discs.species]]
count = 60
radius = 0.25
region = [10, 0, 20, 20]
[[discs.species]]
count = 12
radius = 1
mass = 4
"""


class Regions(ProgramTest):
    def write_scene(self, name, discs, box=20, sides=""):
        keys, mark, species = discs.partition("\n[[")
        text = SCENE.format(box=box, sides=sides, discs=keys)
        return self.write(f"{name}.toml", text + mark + species)

    def places(self, name, ranks=1, step=0):
        out = self.run_program(ranks, "run", f"{name}.toml", "--quiet", "--set",
                               "output.text=ends", "--steps", step).out
        return [tuple(map(float, line.split()[2:4])) for line in lines_of(out, step)]

    def check_within(self, places, region, radius):
        x0, y0, x1, y1 = region
        for x, y in places:
            self.assertTrue(x0 + radius <= x <= x1 - radius, (x, y))
            self.assertTrue(y0 + radius <= y <= y1 - radius, (x, y))

    def test_places_are_uniform_in_the_region(self):
        """Whole discs lie in it. The mean of places is its centre, to five standard errors of a
        uniform distribution, also in a box that stands.
        """
        for name, box, region in (("wide", [60, 20], [30, 5, 55, 15]),
                                  ("tall", [20, 60], [5, 30, 15, 55])):
            self.write_scene(name, f"count = 300\nradius = 0.25\nregion = {region}", box)
            places = self.places(name)
            self.assertEqual(len(places), 300)
            self.check_within(places, region, 0.25)
            for axis in (0, 1):
                low, high = region[axis] + 0.25, region[axis + 2] - 0.25
                mean = sum(place[axis] for place in places) / 300
                self.assertLess(abs(mean - (low + high) / 2), 5 * (high - low) / 3600 ** 0.5)
            self.assertEqual(self.places(name, 3), places)

    def test_region_that_is_the_box(self):
        """Discs begin where they do without a region, bit for bit."""
        for sides in ("", PERIODIC):
            hashes = set()
            for region in ("", "region = [0, 0, 20, 20]", "region = [[0, 0, 20, 20]]"):
                self.write_scene("box", f"count = 200\nradius = 0.4\n{region}", sides=sides)
                self.run_program(1, "run", "box.toml", "--quiet", "--steps", 0, "--report",
                                 "box.json")
                hashes.add(self.hash_of("box.json"))
            self.assertEqual(len(hashes), 1)

    def test_two_gases(self):
        """Each species in its own part, and one anywhere. Same bits on any number of ranks, and
        over a restart.
        """
        self.write_scene("gases", TWO_GASES)
        places = self.places("gases")
        self.check_within(places[:90], (0, 0, 10, 20), 0.25)
        self.check_within(places[90:150], (10, 0, 20, 20), 0.25)
        self.check_within(places[150:], (0, 0, 20, 20), 1)
        others = [x for x, _ in places[150:]]
        self.assertTrue(min(others) < 9 and max(others) > 11)
        for ranks in (2, 3, 4, 5):
            self.assertEqual(self.places("gases", ranks), places)
        self.run_program(2, "run", "gases.toml", "--check", "--quiet", "--steps", 50)
        self.check_restart("gases.toml", first=150, last=400)

    def test_one_region_for_species_without_one(self):
        self.write_scene("rest", "region = [4, 4, 16, 16]\n" + TWO_GASES)
        places = self.places("rest")
        self.check_within(places[:90], (0, 0, 10, 20), 0.25)
        self.check_within(places[150:], (4, 4, 16, 16), 1)

    def test_joule_expansion(self):
        """A gas that begins in the left half fills the box: each half has half of the discs, to
        five standard deviations of a binomial distribution. Its energy is that of the start.
        """
        self.write_scene("joule", "count = 200\nradius = 0.25\nregion = [0, 0, 10, 20]")
        self.check_within(self.places("joule"), (0, 0, 10, 20), 0.25)
        self.run_program(1, "run", "joule.toml", "--quiet", "--steps", 3000, "--report",
                         "joule.json", "--set", "output.text=ends", "-o", "joule")
        report = self.report("joule.json")
        self.assertAlmostEqual(report["kinetic_energy"], 200 * 0.1 ** 2 / 2, delta=1e-13)
        out = self.run_program(1, "convert", "joule/checkpoints/checkpoint-000000003000.h5", "--to",
                               "text").out
        n_left = sum(float(line.split()[2]) < 10 for line in out.splitlines())
        self.assertLess(abs(n_left - 100), 5 * (200 / 4) ** 0.5)

    def test_messages(self):
        count = "count = 20\nradius = 0.5\n"
        self.check_refused(lambda text: self.write_scene("wrong", text), (
                (count + "region = [0, 0, 30, 5]", "inside a box of side 20"),
                (count + "region = [5, 0, 2, 5]", "with x0 < x1 and y0 < y1"),
                (count + "region = [0, 0, nan, 5]", "with x0 < x1 and y0 < y1"),
                (count + "region = [0, 0, 20, 0.9]", "is narrower than a disc of radius 0.5"),
                (count + "region = [0, 0, 5, 5]", "would be covered to 0.6283 by 20 discs"),
                (count + "region = [0, 0, 5]", "must be numbers, [x0, y0, x1, y1]"),
                (count + "region = [[0, 0, 5, 9], [1, 1, 9, 9]]", "must be numbers, [x0, y0, x1"),
                (count + 'region = [0, 0, 9, 9]\ngenerator = "lattice"',
                 'no meaning without discs.generator = "random"'),
                ("species = [{count = 9, radius = 0.5, region = [0, 0, 5, 5]}, "
                 "{count = 9, radius = 0.4}, {count = 9, radius = 0.5, region = [0, 0, 5, 5]}]",
                 "the region [0, 0, 5, 5] would be covered to 0.5655 by 18 discs"),
                ('generator = "compressed"\n' + TWO_GASES, "a region of a species has no meaning"),
                (TWO_GASES.replace("[10, 0, 20, 20]", "[10, 0, 20, 21]"), "[10, 0, 20, 21] must")))


if __name__ == "__main__":
    main()
