# SPDX-License-Identifier: BSD-3-Clause
"""Tables of measurements: the same bytes on other ranks and threads and after a restart between two
samples; what is wrong with their keys; and nothing of them in the checkpoint of a run that does
not ask.
"""
import subprocess
import time

from program import ENVIRONMENT, ProgramTest, checkpoint, main

GAS = """
[box]
size = 40
[discs]
count = 400
packing = 0.3
speed = 1
[time]
method = "time-stepped"
steps = 90
"""

METHODS = ("time-stepped", "event-driven")


def settings(**given):
    """The options that set these keys of `output.measurements`."""
    return [word for key, value in given.items()
            for word in ("--set", f"output.measurements.{key}={value}")]


AROUND = [word for side in ("left", "right", "bottom", "top")
          for word in ("--set", f"box.{side}.kind=periodic")] + settings(every_steps=7)
BETWEEN_WALLS = settings(every_steps=7, from_step=10, quantities=[
    "wall_pressure", "radial_distribution", "velocities", "density", "displacement", "pressure",
    "thermo", "psi6"])
FLIGHTS = settings(quantities=["psi6", "structure_factor", "diffusion"], correlation_steps=21)
FIELDS = settings(quantities=["profiles", "correlations", "transport"], profile_columns=7,
                  profile_rows=3, profile_samples=5, hdf5=1)


class Measurements(ProgramTest):
    def setUp(self):
        super().setUp()
        self.write("gas.toml", GAS)

    def measure(self, ranks, *words, **expected):
        return self.run_program(ranks, "run", "gas.toml", "--quiet", *words, **expected)

    def tables(self, folder):
        return {file.name: file.read_bytes()
                for file in (self.folder / folder / "measurements").iterdir()}

    def check_stretches(self, n_tables, *words):
        """Returns the tables, which are those of a run in two stretches on other ranks, too."""
        self.measure(1, *words, "-o", "whole", "--overwrite", "--report", "whole.json")
        self.measure(3, *words, "-o", "kept", "--overwrite", "--threads", 2, "--steps", 50)
        self.measure(2, *words, "-o", "kept", "--restart", "latest")
        tables = self.tables("whole")
        self.assertEqual(len(tables), n_tables)
        self.assertEqual(self.tables("kept"), tables)
        return tables

    def refuse(self, *words, says):
        self.run_program(1, "run", "gas.toml", "-o", "x", *words, code=2, says=says)
        self.assertFalse((self.folder / "x").exists(), "a refused run has made a folder")

    def test_between_walls(self):
        for method in METHODS:
            with self.subTest(method):
                tables = self.check_stretches(16, "--set", f"time.method={method}", *BETWEEN_WALLS)
                self.assertIn("radial_distribution", self.report("whole.json")["measurements"])
                rows = tables["thermo.csv"].decode().splitlines()
                self.assertEqual(sum(not row.startswith("#") for row in rows), 13)
        self.run_program(1, "verify", checkpoint("kept", 50))
        self.run_program(3, "run", "--restart", "kept", *settings(bins=10), code=2,
                         says="begin anew with output.measurements.from_step = 90")
        self.write("file", "")
        self.run_program(1, "run", "gas.toml", *BETWEEN_WALLS, "-o", "file", code=2)

    def test_wave_vectors_and_windows(self):
        """The restart comes within a window of flights."""
        whole = self.check_stretches(9, *AROUND, *FLIGHTS)
        # A run that is too short for a window reports this; a longer run continues the window.
        self.run_program(1, "run", "gas.toml", "--steps", 20, *AROUND, *FLIGHTS, "-o", "short",
                         says="gas.toml: warning: no table of diffusion")
        self.assertNotIn("diffusion.csv", self.tables("short"))
        self.run_program(1, "run", "--restart", "short", "--steps", 90, "--quiet")
        self.assertEqual(self.tables("short"), whole)

    def test_fields(self):
        """The restart comes within a block of profiles."""
        for method in METHODS:
            with self.subTest(method):
                self.check_stretches(6, "--set", f"time.method={method}", *AROUND, *FIELDS)

    def test_wrong_keys(self):
        self.refuse(*FIELDS, says="periodic all round")
        self.refuse(*AROUND, *FIELDS, *settings(profile_rows=300, correlation_points=12), says=[
            'a grid of 2100 cells for "profiles" is more than the 400 discs',
            "must be 4, 8, 16, 32 or 64, not 12"])
        self.refuse(*AROUND, *FLIGHTS, *settings(correlation_steps=20, largest_wavenumber="1e4"),
                    says=["must be a multiple of 'output.measurements.every_steps' = 7, from 14 on",
                          "where a million are, not 10000"])
        # A wave and a distance that no disc in the box can have are errors of one line each.
        for key, value in (("correlation_wavenumber", "1e-9"), ("correlation_wavenumber", "1e9"),
                           ("correlation_wavenumber", "-1"), ("overlap_distance", "1e9")):
            with self.subTest(key, value=value):
                run = self.run_program(1, "run", "gas.toml", "-o", "x", *AROUND, *FIELDS,
                                       *settings(**{key: value}), code=2,
                                       says=f"'output.measurements.{key}'")
                self.assertEqual(run.err.count("--set output.measurements"), 1)
        self.refuse(*settings(quantities=["structure_factor", "diffusion", "displacement"]),
                    says=["make all four sides periodic", "one first place of each disc"])
        self.refuse(*settings(quantities=["density"], largest_distance=3), says="largest_distance")
        self.refuse(*settings(quantities=["radial_distribution"], largest_distance=30),
                    says="cannot reach 30")
        self.run_program(1, "run", "gas.toml", *settings(every_steps=5, quantities=["densty"]),
                         code=2, says=["'output.folder' is missing", 'did you mean "density"?'])

    def test_thermo_grows_as_the_run_goes_on(self):
        words = ["run", "gas.toml", "--quiet", "--steps", 900000, "-o", "endless",
                 *settings(quantities=["thermo"])]
        table = self.folder / "endless/measurements/thermo.csv"

        def n_rows():
            lines = table.read_text(encoding="utf-8").splitlines() if table.exists() else []
            return sum(not line.startswith("#") for line in lines)

        with subprocess.Popen(self.command(1, words), cwd=self.folder, env=ENVIRONMENT,
                              stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as program:
            end = time.monotonic() + 30
            while n_rows() <= 4 and time.monotonic() < end:
                time.sleep(0.1)
            n_before_its_end = n_rows()
            program.terminate()
        self.assertEqual(program.returncode, 75)
        self.assertGreater(n_before_its_end, 4)

    def test_checkpoint_without_measurements(self):
        self.measure(1, "--steps", 50, "-o", "plain")
        self.assertNotIn(b"measurements",
                         (self.folder / checkpoint("plain", 50)).read_bytes())


if __name__ == "__main__":
    main()
