# SPDX-License-Identifier: BSD-3-Clause
"""Numbers of contacts with sides and obstacles by species, `box.SIDE.contacts` and
`effects.obstacles.contacts`.

Expected places and velocities follow from free fall, restitution and Coulomb's law by hand.
"""
import math

from program import ProgramTest, lines_of, main

GRAVITY = 0.01
# One disc of each species falls in a lane of its own: height of its lowest point, and restitution.
FALLS = [(20.0, 0.9), (12.0, 0.6), (16.0, 1.0)]
RADII = [1.0, 1.5, 0.5]
DROPS = """
[box]
size = [30, 40]
bottom.restitution = 0.9
bottom.contacts = [{{species = 2, restitution = 0.6}}, {{species = 3, restitution = 1}}]
[discs]
list = [[5, 21, 0, 0], [15, 13.5, 0, 0], [25, 16.5, 0, 0]]
species = [{{count = 1, radius = 1}}, {{count = 1, radius = 1.5, mass = 4}},
           {{count = 1, radius = 0.5}}]
[effects.gravity]
y = -0.01
[time]
steps = {steps}
[output]
text = "ends"
"""

# Discs that hit a segment and a fixed disc from above, in four lanes.
BODIES = """
[box]
size = [40, 40]
[discs]
list = [[5, 25, 0, -0.2], [15, 25, 0, -0.2], [25, 25, 0, -0.2], [35, 25, 0, -0.2]]
species = [{count = 1, radius = 1}, {count = 2, radius = 1}, {count = 1, radius = 1}]
[effects.obstacles]
segments = [[0, 20, 20, 20]]
discs = [[25, 18, 2], [35, 18, 2]]
restitution = 0.5
contacts = [{species = 2, restitution = 0.75}, {species = 3, restitution = 1}]
[time]
steps = 30
[output]
text = "ends"
"""
LEFT = [0.5, 0.75, 0.75, 1]

# One disc of each species hits the floor obliquely.
VELOCITY = (0.2, -0.1)
RUBS = [(0.9, 0.5, math.inf), (0.9, 0.5, 0.1), (0.8, -1, 0), (0.9, 0.25, math.inf)]
ROUGH = """
[box]
size = [80, 20]
bottom.restitution = 0.9
bottom.tangential_restitution = 0.5
bottom.contacts = [{species = 2, friction = 0.1},
                   {species = 3, restitution = 0.8, tangential_restitution = -1},
                   {species = 4, tangential_restitution = 0.25}]
[discs]
list = [[5, 2, 0.2, -0.1], [25, 2, 0.2, -0.1], [45, 2, 0.2, -0.1], [65, 2, 0.2, -0.1]]
species = [{count = 1, radius = 1}, {count = 1, radius = 1}, {count = 1, radius = 1},
           {count = 1, radius = 1}]
[effects.contact]
kind = "KIND"
restitution = 1
tangential_restitution = 1
[time]
steps = 20
[output]
text = "ends"
"""

# Discs at rest on a floor, pulled along it; the second one holds, and the third one slips.
SLOPE = """
[box]
size = [60, 10]
bottom.contacts = [{species = 2, tangential_restitution = 0, friction = 0.5},
                   {species = 3, tangential_restitution = 0, friction = 0.1}]
[discs]
list = [[5, 1, 0, 0], [25, 1, 0, 0], [45, 1, 0, 0]]
species = [{count = 1, radius = 1}, {count = 1, radius = 1}, {count = 1, radius = 1}]
[effects]
gravity = {x = 0.002, y = -0.01}
contact = {kind = "restitution", restitution = 0.5, contact_time = 0.001}
lasting_contacts.speed = 0.02
[time]
steps = 50
micro_steps = 4
sync_every = 2
[output]
text = "ends"
"""

MANY = """
[box]
size = 40
left.contacts = [{species = 2, restitution = 0.7, tangential_restitution = 0.5, friction = 0.3}]
right.contacts = [{species = 1, restitution = 0.5}, {species = 2, restitution = 0.9}]
bottom.restitution = 0.8
bottom.tangential_restitution = 0.2
bottom.contacts = [{species = 2, restitution = 1, tangential_restitution = -1}]
[discs]
species = [{count = 60, radius = 0.5}, {count = 90, radius = 0.4}]
speed = 0.3
[effects.contact]
kind = "rough"
restitution = 0.9
tangential_restitution = 0.4
[effects.obstacles]
discs = [[20, 20, 3]]
arcs = [[10, 30, 4, 90, 300]]
contacts = [{species = 2, restitution = 0.6, tangential_restitution = 0.3, friction = 0.2}]
[time]
steps = 60
"""


def fall(height, left, steps):
    """Height and velocity of a point that bounces with the restitution `left`."""
    time, speed, bounces = math.sqrt(2 * height / GRAVITY), 0, 0
    rest = steps
    while rest > time:
        rest -= time
        speed = left * (math.sqrt(2 * height * GRAVITY) if bounces == 0 else speed)
        bounces += 1
        time = 2 * speed / GRAVITY
    start = height if bounces == 0 else 0
    return start + speed * rest - GRAVITY * rest ** 2 / 2, speed - GRAVITY * rest, bounces


class SurfaceContacts(ProgramTest):
    def rows(self, text, last, *words):
        """x, y, vx and vy of each disc at the last step."""
        run = self.run_program(1, "run", self.write("scene.toml", text), "--report", "r.json",
                               "--check", *words)
        return [list(map(float, line.split()[2:6])) for line in lines_of(run.out, last)]

    def test_drops(self):
        """Each species rebounds to its own heights, two to five times."""
        steps = 180
        rows = self.rows(DROPS.format(steps=steps), steps)
        for (_, y, _, vy), (height, left), radius in zip(rows, FALLS, RADII):
            place, velocity, bounces = fall(height, left, steps)
            self.assertGreaterEqual(bounces, 2)
            self.assertAlmostEqual(y - radius, place, delta=1e-10)
            self.assertAlmostEqual(vy, velocity, delta=1e-12)

    def test_obstacles(self):
        for method in ("event-driven", "time-stepped"):
            rows = self.rows(BODIES, 30, "--set", f"time.method={method}")
            for (_, _, vx, vy), left in zip(rows, LEFT):
                self.assertAlmostEqual(vy, 0.2 * left, delta=1e-15)
                self.assertEqual(vx, 0)

    def test_rubbing(self):
        """Sticking, sliding and smooth floors for discs that turn, and for discs that do not."""
        for kind, inertia in (("rough", 0.5), ("restitution", math.inf)):
            text = ROUGH.replace("KIND", kind)
            if kind != "rough":
                text = text.replace("\ntangential_restitution = 1\n", "\n")
            share = inertia / (1 + inertia) if kind == "rough" else 1
            turning = 0
            for (_, _, vx, vy), (normal, tangential, friction) in zip(self.rows(text, 20), RUBS):
                pushed = (1 + normal) * -VELOCITY[1]
                rubbed = min((1 + tangential) * share * VELOCITY[0], friction * pushed)
                self.assertAlmostEqual(vx, VELOCITY[0] - rubbed, delta=1e-15)
                self.assertAlmostEqual(vy, pushed + VELOCITY[1], delta=1e-15)
                if kind == "rough":
                    turning += inertia * (rubbed / inertia) ** 2 / 2
            if kind == "rough":
                self.assertAlmostEqual(self.report("r.json")["rotational_energy"], turning,
                                       delta=1e-15)

    def test_lasting_contacts(self):
        """On the slope the friction of each species decides: g sin - mu g cos, or rest. Discs that
        rest hop by less than 1e-3, and start within two syncs."""
        rows = self.rows(SLOPE, 50)
        for (x, _, vx, _), start, pull in zip(rows, (5, 25, 45), (0.002, 0, 0.001)):
            self.assertAlmostEqual(vx, pull * 50, delta=0.002)
            self.assertAlmostEqual(x - start, pull * 50 ** 2 / 2, delta=0.05)

    def test_equal_numbers(self):
        """Rows that repeat the common numbers change no bit."""
        hashes = set()
        for number in ("restitution = 0.9", "friction = 1e6"):
            text = ROUGH.replace("KIND", "rough")
            head, tail = text.index("bottom.contacts"), text.index("[discs]")
            self.rows(f"{text[:head]}bottom.contacts = [{{species = 2, {number}}}]\n{text[tail:]}",
                      20)
            hashes.add(self.hash_of("r.json"))
            self.rows(text[:head] + text[tail:], 20)
            hashes.add(self.hash_of("r.json"))
        self.assertEqual(len(hashes), 1)

    def test_every_shape(self):
        """The same bits on 1 to 5 ranks, over a restart, and under the check."""
        scene = self.write("many.toml", MANY)
        for method in ("event-driven", "time-stepped"):
            with self.subTest(method):
                options = ["--quiet", "--overwrite", "--set", f"time.method={method}"]
                self.check_restart(scene, options, first=25, last=60)
                for ranks in (1, 4, 5):
                    self.run_program(ranks, "run", scene, *options, "--check", "--threads",
                                     1 + ranks // 4, "-o", "checked", "--report", "c.json")
                    self.assertEqual(self.hash_of("c.json"), self.hash_of("whole.json"))

    def test_restart_with_other_numbers(self):
        scene = self.write("many.toml", MANY)
        self.run_program(1, "run", scene, "--quiet", "-o", "kept")
        self.write("other.toml", MANY.replace("restitution = 0.6,", "restitution = 0.5,"))
        self.run_program(1, "run", "other.toml", "--restart", "kept", "--steps", 70, code=2,
                         says="effects.obstacles.contacts")

    def test_refused(self):
        def scene(contacts):
            head, tail = DROPS.index("bottom.contacts"), DROPS.index("[discs]")
            text = f"{DROPS[:head]}bottom.contacts = [{contacts}]\n{DROPS[tail:]}"
            self.write("wrong.toml", text.replace("{{", "{").replace("}}", "}")
                       .replace("{steps}", "1"))
        self.check_refused(scene, (
            ("{species = 4, restitution = 0}", "from 1 to 3, not 4"),
            ("{species = 1.5, restitution = 0}", "from 1 to 3, not 1.5"),
            ("{species = 2}", "it gives no number"),
            ("{species = 2, restitution = 1.5}", "must be from 0 to 1, not 1.5"),
            ("{species = 2, tangential_restitution = 2}", "must be from -1 to 1, not 2"),
            ("{species = 2, friction = 1}",
             "friction has no meaning without a tangential_restitution above -1"),
            ("{species = 2, tangential_restitution = -1, friction = 1}",
             "friction has no meaning with tangential_restitution = -1"),
            ("{species = 2, restitution = nan, friction = 1}",
             "restitution must be a number, not nan"),
            ("{restitution = 1}", "needs species"),
            ("{species = 2, restitution = 1}, {species = 2, restitution = 0}",
             "row 2 of 'box.bottom.contacts': row 1 has this species already")))

    def test_without_meaning(self):
        text = DROPS.format(steps=1)
        for more, says in (
                ("bottom.kind=\"thermal\"", "box.bottom.contacts"),
                ("top.contacts=[{species = 1, restitution = 1}]", None)):
            self.run_program(1, "run", self.write("scene.toml", text), "--set", f"box.{more}",
                             "--set", "box.bottom.temperature=1" if says else "time.steps=2",
                             code=2 if says else 0, says=says or ())
        species = "[{count = 1, radius = 1}, {count = 1, radius = 1}]"
        for shape in ("round", "stadium"):
            text = (f"[box]\nsize = 20\nshape = \"{shape}\"\nbottom.contacts = [{{species = 1, "
                    "restitution = 0.5}]\n[discs]\nlist = [[8, 10, 0, 0], [12, 10, 0, 0]]\n"
                    f"species = {species}\n[time]\nsteps = 1\n")
            self.run_program(1, "run", self.write("shape.toml", text), code=2,
                             says="sides that are not plain walls")
        equal = self.write("equal.toml", "[box]\nsize = 20\n[discs]\ncount = 3\nradius = 1\n"
                           "[time]\nsteps = 1\n[effects.obstacles]\ndiscs = [[10, 10, 1]]\n"
                           "contacts = [{species = 1, restitution = 0.5}]\n")
        self.run_program(1, "run", equal, code=2, says="has no meaning without 'discs.species'")


if __name__ == "__main__":
    main()
