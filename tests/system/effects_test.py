# SPDX-License-Identifier: BSD-3-Clause
"""Scenes with effects: the same bits and lines on other ranks and after a restart in the middle of
a sync interval, where coordinates are those of the falling frame; and what shows effects does.
"""
import re
import signal
import subprocess
import time

from program import (ENVIRONMENT, SOURCES, ProgramTest, checkpoint, lines_of, main, ranks_of)

FALL = """
[box]
size = 100
bottom = { restitution = 0.9 }
left = { kind = "thermal", temperature = 0.05 }
right = { kind = "moving", speed = -0.05 }
[discs]
count = 400
packing = 0.15
speed = 0.3
[time]
steps = 150
method = "event-driven"
[effects.contact]
kind = "restitution"
restitution = 0.95
[effects.gravity]
y = -0.005
"""

SPECIES = """
[[discs.species]]
count = 100
radius = 1.5
mass = 2
spin = 0.4
[[discs.species]]
count = 300
radius = 0.8
mass = 0.7
spin = 0.4
"""

GROWING = """
[box]
size = 60
left = { kind = "periodic" }
right = { kind = "periodic" }
top = { restitution = 0.9 }
[discs]
count = 400
packing = 0.3
speed = 0.3
[time]
steps = 150
[effects.growth]
rate = 0.003
"""

MIXTURE = """
[box]
size = 60
[[discs.species]]
count = 5
radius = 4
mass = 20
[[discs.species]]
count = 300
radius = 0.5
[time]
steps = 60
method = "time-stepped"
"""


def sides(scene, kind):
    """The scene with this kind of side left and right."""
    return re.sub("(?m)^(left|right) = .*", rf'\1 = {{ kind = "{kind}" }}', scene)


def leaking():
    """Rough discs of two species, which leave to the left and to the right."""
    scene = re.sub("(?m)^(count|packing) = .*\n", "", sides(FALL, "open"))
    rough = 'kind = "rough"\ntangential_restitution = 0.3'
    return scene.replace('kind = "restitution"', rough) + SPECIES


class Effects(ProgramTest):
    def test_many_at_once(self):
        self.write("fall.toml", FALL)
        frames = ["--set", "output.trajectory.every_steps=30"]
        self.check_restart("fall.toml", frames, first=100, last=150)
        self.run_program(1, "verify", "whole/trajectory.h5")
        kept = checkpoint("kept", 100)
        self.assertIn("gravity (0, -0.005)", self.run_program(1, "info", kept).out)
        stopped = self.run_program(1, "run", "fall.toml", "--steps", 100, "--set",
                                   "output.text=ends", says="right wall moving at -0.05")
        converted = self.run_program(1, "convert", kept, "--to", "text")

        def state(line):
            return line.split()[1:6]

        self.assertEqual([state(line) for line in lines_of(converted.out, 100)],
                         [state(line) for line in lines_of(stopped.out, 100)])
        self.run_program(3, "run", "fall.toml", "--check", "--quiet", "--report", "checked.json")
        self.assertEqual(self.hash_of("checked.json"), self.hash_of("whole.json"))
        self.run_program(1, "run", "fall.toml", "--restart", "kept", "--set",
                         "effects.gravity.y=-0.01", code=2,
                         says="'effects.gravity.y' is -0.005 there and -0.01 here")
        self.run_program(1, "accuracy", "fall.toml", code=2)

    def test_discs_leave(self):
        self.write("leak.toml", leaking())
        frames = ["--set", "output.trajectory.every_steps=30"]
        rest = self.check_restart("leak.toml", frames, first=70, last=150)
        self.assertIn(" of 400 discs: left ", rest.err)
        self.run_program(1, "verify", "whole/trajectory.h5")
        self.run_program(1, "run", "leak.toml", "-o", "measured", "--set",
                         'output.measurements.quantities=["displacement"]', code=2,
                         says="with open sides velocities and densities alone are measured")

    def test_trajectory_says_which_sides_are_open(self):
        """Discs lie a radius beyond open sides, no further, and beyond no wall. 0.53125 is
        3fe1000000000000.
        """
        self.write("out.toml", """
            [box]
            size = 20
            right = { kind = "open" }
            [discs]
            count = 20
            radius = 0.53125
            speed = 1
            [time]
            steps = 100
            method = "time-stepped"
            [output]
            folder = "out"
            [output.trajectory]
            every_steps = 50
            """)
        self.run_program(1, "run", "out.toml", says=" of 20 discs: right ")
        self.run_program(1, "verify", "out/trajectory.h5")
        trajectory = self.folder / "out/trajectory.h5"
        trajectory.write_bytes(trajectory.read_bytes().replace(b"open_sides", b"open_walls"))
        self.run_program(1, "verify", "out/trajectory.h5", code=2,
                         says="its bytes do not have its checksum")

    def test_growing_discs(self):
        """Radii follow from the step, so a restart goes on with them."""
        self.write("growing.toml", GROWING)
        self.check_restart("growing.toml", first=70, last=150)
        self.assertEqual(self.report("whole.json")["overlapping_pairs"], 0)
        self.run_program(3, "run", "growing.toml", "--steps", 70,
                         says="packing 0.3, 0.4392 at the last step")
        self.run_program(2, "run", "growing.toml", "--steps", 40, "--check", "--quiet")
        self.run_program(2, "run", "growing.toml", "--steps", 300, code=2,
                         says="there is room for them up to step 246")

    def test_compressed_start(self):
        self.write("growing.toml", GROWING)
        dense = ["run", "growing.toml", "--set", "discs.packing=0.62", "--steps", 20, "--quiet",
                 "--set", "discs.generator=compressed"]
        self.run_program(2, *dense, "--report", "dense2.json")
        self.run_program(1, *dense, "--report", "dense1.json", "--threads", 2)
        self.assertEqual(self.hash_of("dense1.json"), self.hash_of("dense2.json"))
        self.run_program(2, *dense, "--set", "discs.packing=0.9", "--set", "effects.growth.rate=0",
                         "--set", "discs.growth_rate=0.2", code=2,
                         says="the compression jams at a packing fraction of 0.")

    def test_box_of_trajectory(self):
        """It holds all frames, so it depends on the last step where walls move out; a restart may
        change that.
        """
        self.write("grow.toml", """
            [box]
            size = 20
            right = { kind = "moving", speed = 0.1 }
            [discs]
            count = 60
            radius = 0.5
            speed = 1
            [time]
            steps = 100
            method = "event-driven"
            [output.trajectory]
            every_steps = 5
            """)

        def grow(folder, *options):
            self.run_program(1, "run", "grow.toml", "--quiet", "-o", folder, *options)

        def expect_box(folder, box):
            info = self.run_program(1, "info", f"{folder}/trajectory.h5").out
            self.assertRegex(info, f"(?m)^discs *60 in a box of {box}$")

        grow("whole")
        grow("shorter", "--steps", 60)
        grow("parts", "--steps", 10)
        grow("parts", "--restart", "latest")
        self.run_program(1, "diff", "whole/trajectory.h5", "parts/trajectory.h5")
        expect_box("parts", 30)
        self.run_program(1, "verify", "parts/trajectory.h5")
        grow("parts", "--restart", checkpoint("parts", 10), "--steps", 60)
        self.run_program(1, "diff", "shorter/trajectory.h5", "parts/trajectory.h5")
        expect_box("parts", 26)
        # Along a periodic axis the box is the period, that images are counted in.
        grow("corridor", "--set", "box.bottom.kind=periodic", "--set", "box.top.kind=periodic")
        expect_box("corridor", "30 x 20")

    def test_mixture(self):
        """Radii and masses go into recordings, and come back with a restart."""
        self.write("mixture.toml", MIXTURE)
        frames = ["--set", "output.trajectory.every_steps=1"]
        self.run_program(1, "run", "mixture.toml", "--threads", 2, "--quiet", "-o", "sixty",
                         "--report", "sixty.json")
        self.check_restart("mixture.toml", frames, first=60, last=90)
        self.run_program(3, "run", "mixture.toml", "--quiet", "--report", "sixty3.json")
        self.assertEqual(self.hash_of("sixty.json"), self.hash_of("sixty3.json"))
        self.run_program(1, "verify", "whole/trajectory.h5")
        info = self.run_program(1, "info", checkpoint("kept", 60)).out
        self.assertIn("5 discs of radius 4 and mass 20, 300 discs of radius 0.5 and mass 1", info)
        again = ["run", "--restart", "sixty", "--steps", 90, "--set"]
        self.run_program(1, *again, "time.method=event-driven", code=2)
        self.run_program(1, *again, "discs.file=none.txt", "--set", 'discs.columns=["radius"]',
                         code=2)

    def test_sheared_discs(self):
        """Images that move are where the scene's time says."""
        for method in ("time-stepped", "event-driven"):
            with self.subTest(method):
                scene = SOURCES / "inputs/sheared.toml"
                options = ["--set", "discs.count=300", "--set", "box.size=160", "--set",
                           f"time.method={method}", "--set", "time.sync_every=16", "--quiet",
                           "--overwrite"]
                self.check_restart(scene, options, first=25, last=60)
                self.run_program(2, "run", scene, *options, "--steps", 60, "--check", "-o",
                                 "checked", "--report", "checked.json")
                self.assertEqual(self.hash_of("checked.json"), self.hash_of("whole.json"))

    def test_rough_discs(self):
        """They turn: their spins go into files and come back with a restart."""
        options = ["--set", "discs.count=1200", "--quiet", "--set",
                   "output.trajectory.every_steps=1"]
        self.check_restart(SOURCES / "inputs/rough.toml", options, first=25, last=60)
        for file in ("trajectory.h5", checkpoint(".", 60)):
            self.run_program(1, "diff", f"whole/{file}", f"kept/{file}")
        info = self.run_program(1, "info", "whole/trajectory.h5").out
        self.assertIn("fields      position velocity angular_velocity", info)
        table = self.run_program(1, "convert", checkpoint("kept", 60), "--to", "csv").out
        spins = [float(line.split(",")[8]) for line in table.splitlines()[1:]]
        self.assertGreater(sum(spin != 0 for spin in spins), 600)
        self.run_program(1, "diff", checkpoint("kept", 25), checkpoint("kept", 60), code=1)

    def test_discs_of_their_own(self):
        """Each has a radius, a mass and a spin: from a file, and from the scene itself; a restart
        needs no file.
        """
        rows = {}
        for k in range(144):
            i = k * 59 % 144
            rows[i] = [2.5 + 5 * (i % 12), 2.5 + 5 * (i // 12), (i * 7919 % 1000 - 500) / 1000,
                       (i * 104729 % 1000 - 500) / 1000, 1 + (i * 37 % 100) / 90,
                       0.5 + (i * 53 % 10) / 5, (i * 31 % 7 - 3) / 10]
        lines = [" ".join(map(str, [i, *row])) for i, row in rows.items()]
        self.write("discs.txt", "\n".join(lines) + "\n")
        head = ('[box]\nsize = 60\n[time]\nsteps = 60\n[effects.contact]\nkind = "rough"\n'
                "restitution = 0.9\ntangential_restitution = 0.6\n[discs]\n")
        columns = 'columns = ["radius", "mass", "spin"]\n'
        self.write("each.toml", head + 'count = 144\nfile = "discs.txt"\n' + columns)
        self.write("listed.toml", head + f"list = {[rows[i] for i in sorted(rows)]}\n")
        for method in ("time-stepped", "event-driven"):
            which = ["--set", f"time.method={method}", "--quiet", "--report"]
            self.run_program(3, "run", "each.toml", *which, "each.json", "--set",
                             f"output.folder={method}", "--set", "output.checkpoint.every_steps=25")
            self.run_program(1, "run", "listed.toml", *which, "listed.json", "--threads", 2)
            self.assertEqual(self.hash_of("each.json"), self.hash_of("listed.json"))
        self.assertGreater(self.report("each.json")["pair_collisions"], 200)

        wrong = lines.copy()
        wrong[16] = " ".join(wrong[16].split()[:5]) + " -1 0 x"
        wrong[29] = wrong[29].rsplit(" ", 1)[0]
        self.write("wrong.txt", "\n".join(wrong) + "\n")
        missing = "expected 'id x y vx vy radius mass spin', found only 7 of the 8 numbers"
        self.run_program(2, "run", "each.toml", "--set", "discs.file=wrong.txt", code=2,
                         says=["wrong.txt:17: ", "wrong.txt:30: ", missing])
        self.run_program(1, "run", "each.toml", "--set", "discs.file=none.txt", code=2,
                         says="none.txt: cannot be opened")
        again = ["run", "--restart", checkpoint("event-driven", 50), "--steps", 60]
        self.run_program(1, *again, "--set", "discs.radius=1", code=2)
        (self.folder / "discs.txt").unlink()
        self.run_program(2, *again, "--quiet", "--report", "rest.json", "--set",
                         "output.folder=elsewhere")
        self.assertEqual(self.hash_of("rest.json"), self.hash_of("each.json"))
        self.run_program(1, "diff", checkpoint("elsewhere", 60), checkpoint("event-driven", 60))
        self.run_program(1, "verify", checkpoint("elsewhere", 60))

    def test_kill_between_periodic_sides(self):
        """One of two ranks is killed behind step 30; three go on from there."""
        self.write("ring.toml", sides(FALL, "periodic"))
        quantities = ["displacement", "radial_distribution", "wall_pressure"]
        around = ["--set", "output.trajectory.every_steps=10", "--set",
                  "output.checkpoint.every_steps=30", "--set", "output.checkpoint.keep=1000000",
                  "--set", "output.measurements.every_steps=20", "--set",
                  f"output.measurements.quantities={quantities}"]
        ends = ["--set", "output.text=ends"]
        whole = self.run_program(2, "run", "ring.toml", "--quiet", "--report", "ring.json", *ends,
                                 *around, "-o", "around")
        for file in ("around/trajectory.h5", checkpoint("around", 90)):
            self.run_program(1, "verify", file)
        # The box in H5MD contains the kind of its sides.
        self.assertIn(b"periodic", (self.folder / "around/trajectory.h5").read_bytes())
        self.kill_behind(checkpoint("killed", 30), "run", "ring.toml", "--quiet", "--steps",
                         1000000, *around, "-o", "killed")
        # The killed run may have advanced further than the run with which it is compared.
        for later in (self.folder / "killed/checkpoints").glob("checkpoint-*.h5"):
            if not later.name.endswith("-000000000030.h5"):
                later.unlink()
        rest = self.run_program(3, "run", "--restart", "killed", "--steps", 150, "--report",
                                "rest.json", *around, *ends, says="left side periodic")
        self.assertEqual(self.hash_of("rest.json"), self.hash_of("ring.json"))
        self.assertEqual(lines_of(rest.out, 150), lines_of(whole.out, 150))
        for table in ("displacement", "radial_distribution", "wall_pressure_history"):
            tables = [(self.folder / run / f"measurements/{table}.csv").read_bytes()
                      for run in ("around", "killed")]
            self.assertEqual(*tables)
        for file in ("trajectory.h5", checkpoint(".", 150)):
            self.run_program(1, "diff", f"around/{file}", f"killed/{file}")
        self.run_program(2, "run", "ring.toml", "--check", "--quiet", "--report", "checked.json")
        self.assertEqual(self.hash_of("checked.json"), self.hash_of("ring.json"))

    def kill_behind(self, file, *words):
        """Kills one of two ranks when the file is there."""
        with subprocess.Popen(self.command(2, words), cwd=self.folder, env=ENVIRONMENT,
                              stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as launcher:
            end = time.monotonic() + 60
            while not (self.folder / file).exists() and time.monotonic() < end:
                time.sleep(0.05)
            subprocess.run(["kill", f"-{signal.SIGKILL.value}", ranks_of(launcher.pid)[0]],
                           check=True)


if __name__ == "__main__":
    main()
