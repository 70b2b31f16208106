# SPDX-License-Identifier: BSD-3-Clause
"""Runs with machine.gpu, by a copy of the program whose GPU is the CPU: reports, tables and
checkpoints are those of runs without it. The program itself says in one line what is missing.
"""
from pathlib import Path

import program
from program import PROGRAM, ProgramTest, checkpoint, main

SERIAL = str(Path(PROGRAM).parent / "tests" / "carrom_serial")

GAS = """
[box]
size = 60
{sides}
[discs]
{discs}
speed = 0.2
seed = 57
[time]
steps = 150
micro_steps = 2
method = "time-stepped"
{time}
{effects}
[output.trajectory]
every_steps = 30
[output.measurements]
every_steps = 10
quantities = ["velocities", "displacement", "radial_distribution", "thermo"]
"""
EQUAL = "count = 200\nradius = 1"
SPECIES = """
species = [{ count = 80, radius = 1, mass = 2 }, { count = 150, radius = 0.6, mass = 1 }]
"""
PERIODIC = "\n".join(f'{side}.kind = "periodic"' for side in ("left", "right", "bottom", "top"))
LOSSY = '[effects.contact]\nkind = "restitution"\nrestitution = 0.9'
# Keys of a report that depend on the machine or its load.
OF_MACHINE = ("gpu", "wall_seconds", "ns_per_disc_step", "phase_seconds", "phase_imbalance",
              "imbalance", "peak_bytes_per_disc", "threads", "command", "date", "host")

SCENES = {
    "walls": {"discs": EQUAL, "sides": ""},
    "periodic": {"discs": EQUAL, "sides": PERIODIC},
    "species": {"discs": SPECIES, "sides": PERIODIC, "effects": LOSSY},
    "single": {"discs": EQUAL, "sides": "", "time": 'precision = "single"\narithmetic = "naive"'},
}


class Gpu(ProgramTest):
    def scene(self, name, **other):
        parts = {"sides": "", "time": "", "effects": "", "discs": EQUAL}
        return self.write("scene.toml", GAS.format(**{**parts, **SCENES.get(name, {}), **other}))

    def run_serial(self, *words, **expected):
        program.PROGRAM = SERIAL
        try:
            return self.run_program(1, *words, **expected)
        finally:
            program.PROGRAM = PROGRAM

    def test_same_outputs(self):
        for name in SCENES:
            with self.subTest(name):
                scene = self.scene(name)
                self.run_program(1, "run", scene, "-o", f"{name}-cpu", "--report", "cpu.json")
                self.run_serial("run", scene, "-o", f"{name}-gpu", "--gpu", "--report", "gpu.json")
                cpu, gpu = self.report("cpu.json"), self.report("gpu.json")
                self.assertEqual(gpu["gpu"]["name"], "serial device")
                for key in cpu.keys() - set(OF_MACHINE):
                    self.assertEqual(cpu[key], gpu[key], key)
                tables = sorted((self.folder / f"{name}-cpu/measurements").glob("*.csv"))
                self.assertTrue(tables)
                for table in tables:
                    other = self.folder / f"{name}-gpu/measurements" / table.name
                    self.assertEqual(table.read_text(), other.read_text(), table.name)
                self.run_program(1, "diff", checkpoint(f"{name}-cpu", 150),
                                 checkpoint(f"{name}-gpu", 150))

    def test_to_a_gpu_and_back(self):
        """Averages depend on where a run stops, so the other run stops at the same steps."""
        scene = self.scene("periodic")
        last = ["--resume", "--steps", 150, "--report"]
        self.run_program(1, "run", scene, "-o", "cpu", "--steps", 40)
        self.run_program(1, "run", "-o", "cpu", "--resume", "--steps", 90)
        self.run_program(1, "run", "-o", "cpu", *last, "cpu.json")
        self.run_serial("run", scene, "-o", "parts", "--gpu", "--steps", 40)
        self.run_program(1, "run", "-o", "parts", "--resume", "--steps", 90, "--set",
                         "machine.gpu=false")
        self.run_serial("run", "-o", "parts", "--gpu", *last, "parts.json")
        cpu, parts = self.report("cpu.json"), self.report("parts.json")
        for key in ("state_hash", "averages", "pair_collisions", "rejected_candidates"):
            self.assertEqual(cpu[key], parts[key], key)

    def test_what_a_gpu_does_not_do(self):
        gravity = "[effects.gravity]\ny = -0.001"
        wall = 'left.restitution = 0.5'
        for other, says in (
            ({"effects": gravity}, "gravity"),
            ({"sides": wall}, "left wall of restitution 0.5"),
            ({"time": "accuracy = 0.1"}, "time.accuracy"),
        ):
            self.run_serial("run", self.scene("", **other), "-o", "wrong", "--gpu", code=2,
                            says=[says])
        scene = self.scene("walls")
        self.run_serial("run", scene, "-o", "wrong", "--gpu", "--set",
                        "time.method=event-driven", code=2,
                        says=["event-driven"])
        self.run_serial("run", scene, "-o", "wrong", "--gpu", "--set",
                        'output.measurements.quantities=["wall_pressure"]', code=2,
                        says=["wall_pressure", "single collisions"])
        self.run_serial("run", scene, "--gpu", "--check", "-o", "checked", code=2,
                        says=["--check", "single collisions"])

    def test_no_gpu(self):
        """The ordinary program has no CUDA, or there is no GPU here; both are one line."""
        done = self.run_program(1, "run", self.scene("walls"), "-o", "none", "--gpu",
                                code=(0, 3))
        if done.code == 3:
            self.assertRegex(done.err, "built without CUDA|no NVIDIA driver|no GPU|driver is for")


if __name__ == "__main__":
    main()
