# SPDX-License-Identifier: BSD-3-Clause
"""Keys that people try, as they know them from other programs: one line says what there is instead.
The scene with what the line says is right.
"""
from program import ProgramTest, main

SCENE = """
[box]
size = 20
[discs]
count = 4
radius = 0.5
[time]
steps = 2
"""

# Keys that users try, their values, the message about them, and settings with the same meaning.
TRIED = [
    ("discs.mass", "2", "discs.species = [{count = N, radius = r, mass = m}] in place of",
     ["discs.species=[{count = 4, radius = 0.5, mass = 2}]"]),
    ("discs.density", "0.3", "try: discs.packing, the share of the box", ["discs.packing=0.3"]),
    ("discs.N", "5", "try: discs.count", ["discs.count=5"]),
    ("time.dt", "0.1", "a step is the unit of time", ["discs.speed=0.1"]),
    ("time.collisions", "1000", "try: time.stop.collisions", ["time.stop.collisions=1000"]),
    ("box.left", '"periodic"', 'is a table, not a value; try: box.left.kind = "periodic"',
     ["box.left.kind=periodic", "box.right.kind=periodic"]),
    ("effects.gravity", "-9.81", "is a table, not a value; try: effects.gravity.y = -9.81",
     ["effects.gravity.y=-0.01"]),
    ("discs.radius", "0", "two points never meet, and only the event-driven method has them; try: "
     "effects.contact.kind = \"none\"",
     ["discs.radius=0", "effects.contact.kind=none"]),
    ("time.stop", "5", "'time.stop' is a table, not a value; [time.stop] has collisions",
     ["time.stop.collisions=5"]),
]


class TriedKeys(ProgramTest):
    def test_on_the_command_line(self):
        for key, value, says, right in TRIED:
            with self.subTest(key):
                self.write("scene.toml", SCENE)
                run = self.run_program(1, "run", "scene.toml", "--set", f"{key}={value}", code=2,
                                       says=says)
                self.assertEqual(len([line for line in run.err.splitlines() if key in line]), 1)
                if key == "discs.mass":
                    self.write("scene.toml", SCENE.replace("radius = 0.5\n", ""))
                settings = [word for setting in right for word in ("--set", setting)]
                self.run_program(1, "run", "scene.toml", "--quiet", *settings)

    def test_in_a_scene(self):
        """The line of the scene is named, once."""
        for key, value, says, _ in TRIED:
            with self.subTest(key):
                scene = SCENE.replace("radius = 0.5\n", "") if key == "discs.radius" else SCENE
                self.write("scene.toml", f"{key} = {value}\n" if key.startswith("effects") else "")
                table, name = key.split(".")
                if f"[{table}]" in scene:
                    scene = scene.replace(f"[{table}]", f"[{table}]\n{name} = {value}")
                else:
                    scene += f"[{table}]\n{name} = {value}\n"
                self.write("scene.toml", scene)
                run = self.run_program(2, "run", "scene.toml", code=2, says=says)
                line = 1 + scene.splitlines().index(f"{name} = {value}")
                self.assertIn(f"scene.toml:{line}: ", run.err)

    def test_rows_of_species(self):
        for name, says in (("restitution", "effects.contact.restitution"),
                           ("radios", "did you mean 'radius'?")):
            self.write("scene.toml", SCENE.replace("radius = 0.5", "") + "[[discs.species]]\n"
                       f"count = 4\nradius = 0.5\n{name} = 0.9\n")
            self.run_program(1, "run", "scene.toml", code=2,
                             says=[f"row 1 of 'discs.species' has no '{name}'", says])

    def test_old_words_of_the_method(self):
        """A word of the method that had this name is still one."""
        self.write("scene.toml", SCENE)
        self.run_program(1, "run", "scene.toml", "--set", "time.collisions=one", code=2,
                         says="'time.collisions' is now 'time.method'; write time.method = "
                              '"time-stepped" for "one"')


if __name__ == "__main__":
    main()
