# SPDX-License-Identifier: BSD-3-Clause
"""Fields at syncs and gravity in time: free discs against closed forms, the same bits on every
machine shape and over restarts, with the self-check on, and files of potentials.

References are the map of Strang's splitting, which is an ellipse in closed form, and flights in the
box's own frame whose contacts with walls are found by small steps and halving.
"""
import math

from program import ProgramTest, checkpoint, lines_of, main

FREE = """
[box]
size = 40
[discs]
radius = 0.5
list = [[26, 20, 0, 0.5], [20, 12, 0.3, 0.1]]
[time]
steps = {steps}
micro_steps = 64
sync_every = {sync}
method = "{method}"
[effects.contact]
kind = "none"
[effects.field]
kind = "trap"
stiffness_x = 0.01
stiffness_y = 0.04
[output]
text = "ends"
"""
DENSE = """
[box]
size = [36, 30]
left.kind = "periodic"
right.kind = "periodic"
[discs]
speed = 0.6
seed = 5
[[discs.species]]
count = 250
radius = 0.6
[[discs.species]]
count = 150
radius = 0.4
mass = 0.5
[time]
steps = 24
micro_steps = 4
sync_every = 2
[effects.field]
"""
FIELDS = {
    "trap": 'kind = "trap"\nstiffness_y = 0.02\ncentre_y = 13\nstrengths = [1, -0.5]\n',
    "sine": 'kind = "sine"\namplitude = 0.3\nwaves = 2\nphase = 0.7\n',
    "grid": 'kind = "grid"\namplitude = 0.2\nfile = "potential.txt"\n',
}
GRID = "# V\n" + "\n".join(", ".join(str((3 * i * i + 5 * i * j + 7 * j) % 11 / 11)
                                    for i in range(6)) for j in range(5)) + "\n"
SWAYED = """
[box]
size = [{size}]
left.restitution = {restitution}
bottom.restitution = {restitution}
[discs]
{discs}
[time]
steps = {steps}
micro_steps = 4
sync_every = {sync}
method = "event-driven"
[effects.gravity]
x = 0.002
y = -0.004
amplitude_x = 0.01
amplitude_y = 0.013
period = 37
phase_x = 0.3
phase_y = 1.1
[output]
text = "ends"
"""


def on_ellipse(place, speed, stiffness, time, n_syncs):
    """Place and speed after kicks and flights. The frequency c solves sin(c / 2) = w t / 2."""
    turn = 2 * math.asin(math.sqrt(stiffness) * time / 2)
    rate, angle = math.sin(turn) / time, n_syncs * turn
    return (place * math.cos(angle) + speed / rate * math.sin(angle),
            speed * math.cos(angle) - place * rate * math.sin(angle))


class SwayedFlight:
    """Along one axis: steady gravity g and a sin(w t + phase)."""

    def __init__(self, g, a, phase):
        self.g, self.a, self.phase, self.w = g, a, phase, 2 * math.pi / 37

    def state(self, place, speed, begin, time):
        first, last = (self.w * t + self.phase for t in (begin, begin + time))
        gained = self.a / self.w * (math.cos(first) - math.cos(last))
        way = self.a / self.w * (math.cos(first) * time - (math.sin(last) - math.sin(first)) /
                                 self.w)
        return (place + speed * time + self.g * time * time / 2 + way,
                speed + self.g * time + gained)

    def end(self, place, speed, sides, restitutions, end):
        """(place, speed, bounces); the walls are searched in steps of 0.02."""
        begin, bounces = 0, 0
        while True:
            contact = self.contact(place, speed, sides, begin, end)
            if contact is None:
                return (*self.state(place, speed, begin, end - begin), bounces)
            place, speed = self.state(place, speed, begin, contact)
            speed *= -restitutions[0 if place < sum(sides) / 2 else 1]
            begin, bounces = begin + contact, bounces + 1

    def contact(self, place, speed, sides, begin, end):
        def is_inside(time):
            return sides[0] <= self.state(place, speed, begin, time)[0] <= sides[1]
        before = 0
        while begin + before < end:
            after = min(before + 0.02, end - begin)
            if not is_inside(after):
                for _ in range(60):
                    middle = (before + after) / 2
                    before, after = (middle, after) if is_inside(middle) else (before, middle)
                return before
            before = after
        return None


class Fields(ProgramTest):
    def discs(self, text, steps, *words):
        """(x, y, vx, vy) of each disc at the end."""
        run = self.run_program(1, "run", self.write("scene.toml", text), "--report", "r.json",
                               "--check", *words)
        return [tuple(map(float, line.split()[2:6])) for line in lines_of(run.out, steps)]

    def test_free_discs_in_a_trap_stay_on_ellipses(self):
        starts = [(6, 0, 0, 0.5), (0, -8, 0.3, 0.1)] # about the middle
        for method in ("event-driven", "time-stepped"):
            for sync in (16, 64, 128):
                found = self.discs(FREE.format(steps=200, sync=sync, method=method), 200)
                for disc, start in zip(found, starts):
                    for axis, stiffness in ((0, 0.01), (1, 0.04)):
                        place, speed = on_ellipse(start[axis], start[axis + 2], stiffness,
                                                  sync / 64, 200 * 64 // sync)
                        self.assertAlmostEqual(disc[axis] - 20, place, delta=1e-10)
                        self.assertAlmostEqual(disc[axis + 2], speed, delta=1e-11)
                        # The true ellipse, to the second order: w t^2 / 24 of the phase.
                        w = math.sqrt(stiffness)
                        true = (start[axis] * math.cos(200 * w) +
                                start[axis + 2] / w * math.sin(200 * w))
                        self.assertAlmostEqual(disc[axis] - 20, true,
                                               delta=11 * 200 * w ** 3 * (sync / 64) ** 2 / 24)

    def test_energy_does_not_drift(self):
        """Over 2,500 periods along x and 5,000 along y: it is symplectic, so that energy keeps
        within its bound."""
        steps = 160_000
        self.discs(FREE.format(steps=steps, sync=64, method="event-driven"), steps)
        report = self.report("r.json")
        energy = report["kinetic_energy"] + report["potential_energy"]
        first = 0.5 * (0.25 + 0.1) + 0.5 * (0.01 * 36 + 0.04 * 64)
        self.assertAlmostEqual(energy / first, 1, delta=0.04 / 4)

    def test_bits_of_fields(self):
        self.write("potential.txt", GRID)
        for name, field in FIELDS.items():
            for method in ("event-driven", "time-stepped"):
                scene = self.write(f"{name}.toml", DENSE + field)
                hashes = set()
                for ranks, threads in ((1, 1), (2, 3), (3, 2), (5, 1)):
                    self.run_program(ranks, "run", scene, "--set", f"time.method={method}",
                                     "--threads", threads, "--check", "--report", "r.json")
                    hashes.add(self.hash_of("r.json"))
                self.assertEqual(len(hashes), 1, f"{name}, {method}")

    def test_restarts(self):
        self.write("potential.txt", GRID)
        for name, field in FIELDS.items():
            for first in (12, 13): # at a sync, and half way between two
                scene = self.write(f"{name}.toml", DENSE.replace("sync_every = 2", "sync_every = 8")
                                   + field)
                self.check_restart(scene, ("--overwrite",), first=first, last=24)
                (self.folder / "potential.txt").unlink(missing_ok=True) # restarts do not need it
                self.write("potential.txt", GRID)

    def test_files_of_potentials(self):
        scene = self.write("grid.toml", DENSE + FIELDS["grid"])
        self.run_program(2, "run", scene, code=2, says="potential.txt")
        for text, problem in (("1 2\n3\n", "potential.txt:2: a row of 1 numbers"),
                              ("1 2\n3 x\n", "potential.txt:2: 'x' is not a number"),
                              ("# none\n", "has no numbers")):
            self.write("potential.txt", text)
            self.run_program(2, "run", scene, code=2, says=problem)
        self.write("potential.txt", GRID)
        values = ", ".join(f"[{line}]" for line in GRID.splitlines()[1:])
        hashes = []
        for words in ((), ("--set", f"effects.field.values=[{values}]")):
            self.run_program(1, "run", scene, *words, "--report", "r.json")
            hashes.append(self.hash_of("r.json"))
        self.assertEqual(*hashes)

    def test_what_does_not_go_together(self):
        scene = self.write("scene.toml", DENSE + FIELDS["trap"])
        for setting, problem in (
                ("effects.field.stiffness_x=0.1", "a trap along x together with periodic sides"),
                ("effects.field.strengths=[1]", "has 1 numbers, and the scene has 2 species"),
                ("effects.field.amplitude=1", "has no meaning without effects.field.kind"),
                ("effects.field.stiffness_y=10", "radians from sync to sync"),
                ("effects.lasting_contacts.speed=0.1", "contacts that last")):
            self.run_program(1, "run", scene, "--set", setting, code=2, says=problem)


class GravityInTime(ProgramTest):
    def test_a_ball_between_walls(self):
        for steps, restitution in ((100, 1), (300, 0.9)):
            x = SwayedFlight(0.002, 0.01, 0.3).end(3, 0.21, (0.5, 10.5), (restitution, 1), steps)
            y = SwayedFlight(-0.004, 0.013, 1.1).end(4, 0.13, (0.5, 6.5), (restitution, 1), steps)
            for sync in (1, 4, 16):
                scene = self.write("scene.toml", SWAYED.format(
                    size="11, 7", restitution=restitution, steps=steps, sync=sync,
                    discs="radius = 0.5\nlist = [[3, 4, 0.21, 0.13]]"))
                run = self.run_program(1, "run", scene, "--check", "--report", "r.json")
                found = tuple(map(float, lines_of(run.out, steps)[0].split()[2:6]))
                for value, known in zip(found, (x[0], y[0], x[1], y[1])):
                    self.assertAlmostEqual(value, known, delta=2e-10)
                self.assertEqual(self.report("r.json")["wall_collisions"], x[2] + y[2])

    def test_pairs_do_not_know_of_it(self):
        """In a periodic box the field moves all discs alike: relative places are those without."""
        scene = self.write("scene.toml", """
            [box]
            size = 30
            left.kind = "periodic"
            right.kind = "periodic"
            bottom.kind = "periodic"
            top.kind = "periodic"
            [discs]
            count = 150
            radius = 0.7
            speed = 0.3
            [time]
            steps = 37
            micro_steps = 4
            sync_every = 4
            method = "event-driven"
            """)
        found = []
        for words in ((), ("--set", "effects.gravity={amplitude_x = 0.01, amplitude_y = 0.02, "
                                    "period = 37, phase_x = 1.5707963267948966, "
                                    "phase_y = 1.5707963267948966}")):
            self.run_program(1, "run", scene, *words, "--report", "r.json")
            found.append(self.report("r.json"))
        # A phase of a quarter turn leaves no mean velocity after a period.
        self.assertEqual(found[0]["pair_collisions"], found[1]["pair_collisions"])
        self.assertAlmostEqual(found[0]["kinetic_energy"], found[1]["kinetic_energy"], delta=1e-9)

    def test_bits(self):
        scene = self.write("scene.toml", SWAYED.format(
            size="30, 24", restitution=0.9, steps=40, sync=8,
            discs="count = 300\nradius = 0.6\nspeed = 0.3"))
        hashes = set()
        for ranks, threads in ((1, 1), (1, 3), (2, 2), (3, 1), (5, 1)):
            self.run_program(ranks, "run", scene, "--threads", threads, "--check", "--report",
                             "r.json")
            hashes.add(self.hash_of("r.json"))
        self.assertEqual(len(hashes), 1)
        for first in (20, 21):
            self.check_restart(scene, ("--overwrite",), first=first, last=40)

    def test_check_beside_other_effects(self):
        """Kicks at syncs give an energy that depends on the frame, and drag takes a part of it."""
        scene = self.write("scene.toml", SWAYED.format(
            size="30, 24", restitution=1, steps=20, sync=2,
            discs="count = 100\nradius = 0.6\nspeed = 0.3"))
        for tables in ("thermostat={kind = \"langevin\", rate = 0.5, temperature = 0.1}",
                       "field={kind = \"trap\", stiffness_x = 0.01}"):
            self.run_program(1, "run", scene, "--set", f"effects.{tables}", "--check")
        # Discs that begin at rest, so that a part of the first kicks is a large share.
        scene = self.write("drag.toml", DENSE.replace("speed = 0.6", "speed = 0") +
                           FIELDS["sine"] + "[effects.drag]\nrate = 0.01\n")
        self.run_program(1, "run", scene, "--check")

    def test_what_does_not_go_together(self):
        scene = self.write("scene.toml", SWAYED.format(
            size="30, 24", restitution=0.9, steps=40, sync=8,
            discs="count = 300\nradius = 0.6\nspeed = 0.3"))
        for setting, problem in (
                ("time.method=time-stepped", "cannot have gravity together"),
                ("effects.drag.rate=0.1", "cannot have gravity that changes together with drag"),
                ("effects.obstacles.discs=[[15, 12, 1]]", "together with obstacles"),
                ("effects.gravity.period=10", "is less than 8 times between syncs"),
                ("box.top={kind = \"oscillating\", amplitude = 0.1, period = 10}",
                 "cannot have an oscillating wall together with drag, or a force that changes")):
            self.run_program(1, "run", scene, "--set", setting, code=2, says=problem)


if __name__ == "__main__":
    main()
