# SPDX-License-Identifier: BSD-3-Clause
"""Distributions of radii, in the middle of the distribution, in its tails and beyond: each scene
runs or is an error of the input that names keys and values, in bounded time.
"""
import itertools

from program import ProgramTest, main

PERIODIC = "\n".join(f'{side}.kind = "periodic"' for side in ("left", "right", "bottom", "top"))
KINDS = ("uniform", "normal", "lognormal")
RANGES = ((None, None), (0.9, 1.1), (1, 1), (1, 1.0000001), (0.5, 0.6), (1.39, 1.5), (2, 3),
          (0.000001, 1000000), (1, 1000), (0.001, 0.002))


def scene(kind, polydispersity, limits=(None, None), generator="random", packing=0.3):
    cut = "".join(f"{name} = {limit!r}\n" for name, limit in zip(("smallest", "largest"), limits)
                  if limit is not None)
    # A box of sqrt(3) / 2 as an edge ratio takes ten columns and ten rows of a triangular lattice.
    return f"""
[box]
size = [10, 8.660254037844386]
{PERIODIC}
[discs]
count = 100
packing = {packing}
generator = "{generator}"
speed = 0.01
[discs.radius]
distribution = "{kind}"
polydispersity = {polydispersity!r}
{cut}
[time]
steps = 1
"""


class Sizes(ProgramTest):
    n_runs = 0

    def outcome(self, text):
        """The code and the words of a run that must not take long."""
        self.write("scene.toml", text)
        Sizes.n_runs += 1
        run = self.run_program(1, "run", "scene.toml", "--threads", 1, code=(0, 2), patience=20)
        return run.code, run.err

    def test_ranges_and_deviations(self):
        outcomes = {}
        for kind, deviation, limits in itertools.product(KINDS, (1e-8, 0.01, 0.3), RANGES):
            code, words = outcomes[kind, deviation, limits] = self.outcome(
                scene(kind, deviation, limits))
            if code == 2:
                self.assertIn("discs.", words)
                self.assertRegex(words, r"times the mean|cannot fit|no lattice|radii wide")
        codes = {key: code for key, (code, _) in outcomes.items()}
        for kind in KINDS:  # what has always run, and a distribution so narrow that all are equal
            self.assertEqual(codes[kind, 1e-8, (None, None)], 0)
            self.assertEqual(codes[kind, 0.01, (0.9, 1.1)], 0)
            self.assertEqual(codes[kind, 0.3, (0.9, 1.1)], 0)
            self.assertEqual(codes[kind, 0.01, (2, 3)], 2)
        self.assertIn("radii from 2 to 3 times the mean", outcomes["normal", 0.01, (2, 3)][1])

    def test_generators(self):
        for generator, limits in itertools.product(("lattice", "triangular", "compressed"),
                                                   ((2, 3), (1.39, 1.5), (0.99, 1.01))):
            code, words = self.outcome(scene("normal", 0.01, limits, generator))
            self.assertEqual(code, 0 if limits[0] < 1 else 2, words)

    @classmethod
    def tearDownClass(cls):
        print(f"{cls.n_runs} runs of the program")


if __name__ == "__main__":
    main()
