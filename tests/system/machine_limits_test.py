# SPDX-License-Identifier: BSD-3-Clause
"""Limits of a machine: more threads than cores are a warning with the number to take, and where a
library ends the program, its exit code is Carrom's.
"""
import os
import resource
import subprocess

from program import ENVIRONMENT, PROGRAM, ProgramTest, main

SCENE = """
[box]
size = 40
[discs]
count = 200
packing = 0.2
speed = 0.05
[time]
steps = 2
method = "event-driven"
"""


class Limits(ProgramTest):
    n_runs = 0

    def setUp(self):
        super().setUp()
        self.write("scene.toml", SCENE)

    def ended(self, *words, variables=None, memory=None, files=None):
        """The code and the messages of a run with these variables and limits."""
        def limit():
            for kind, most in ((resource.RLIMIT_AS, memory), (resource.RLIMIT_NOFILE, files)):
                if most:
                    resource.setrlimit(kind, (most, most))
        Limits.n_runs += 1
        run = subprocess.run([PROGRAM, *map(str, words)], cwd=self.folder, text=True, timeout=60,
                             env=ENVIRONMENT | (variables or {}), capture_output=True, check=False,
                             preexec_fn=limit)
        return run.returncode, run.stderr

    def run_quietly(self, *words, **limits):
        return self.ended("run", "scene.toml", "--quiet", *words, **limits)

    def test_more_threads_than_cores(self):
        cores = len(os.sched_getaffinity(0))
        advice = f"try: --threads {min(cores, 12)}\n"
        code, words = self.run_quietly("--threads", 20 * cores, "--steps", 0)
        self.assertEqual(code, 0, words)
        self.assertIn(f"share {cores} core", words)
        self.assertIn(advice, words)
        variables = {"OMP_NUM_THREADS": str(20 * cores)}
        self.assertIn(advice, self.run_quietly("--steps", 0, variables=variables)[1])
        self.assertEqual(self.run_quietly("--threads", min(cores, 12)), (0, ""))
        # If threads are bound, the first thread may use only one core, but the rank has all cores.
        bound = {"OMP_PROC_BIND": "true", "OMP_PLACES": "cores"}
        self.assertEqual(self.run_quietly("--threads", min(cores, 12), variables=bound)[1], "")

    def test_libraries_that_end_the_program(self):
        """Without Carrom's guard each of these ends with code 1 or 2."""
        code, words = self.run_quietly("--threads", 2, variables={"OMP_STACKSIZE": "100000G"})
        self.assertEqual(code, 3, words)
        self.assertIn("OMP_STACKSIZE", words)
        cores = sorted(os.sched_getaffinity(0))
        absent = {"GOMP_CPU_AFFINITY": f"{cores[-1] + 1000}-{cores[-1] + 1002}"}
        for memory, variables in ((40_000_000, None), (80_000_000, None), (None, absent)):
            code, words = self.run_quietly("--threads", 2, variables=variables, memory=memory)
            # Other OpenMP or MPI libraries may work with these limits. But no run may return a code
            # that means a result, such as 1 or 2.
            self.assertIn(code, (0, 3, 127), words)
            self.assertTrue(code != 3 or "carrom: " in words or "rank 0" in words, words)

    def test_limits_below_what_libraries_take(self):
        """MPI's library ended these with codes 1, 2, 12, 134 and 139."""
        for kilobytes in (45_000, 61_440, 80_000, 90_000):
            for threads in (1, 2):
                code, words = self.run_quietly("--threads", threads, memory=kilobytes << 10)
                self.assertEqual(code, 3, words)
                self.assertIn(f"only {kilobytes} KiB of memory", words)
        for files in (5, 6, 7, 8, 9, 10, 11, 12, 13, 16, 20):
            code, words = self.run_quietly(files=files)
            self.assertEqual(code, 3, words)
            self.assertIn(f"only {files} files open", words)
            self.assertIn("(ulimit -n 1024)", words)
        self.assertEqual(self.run_quietly("--threads", 2, memory=192 << 20, files=40)[0], 0)

    def test_many_threads_of_few_discs_end_soon(self):
        """Placing woke all threads hundreds of times: 35 s for 1000 threads."""
        self.write("few.toml", SCENE.replace("count = 200", "count = 30"))
        begin = resource.getrusage(resource.RUSAGE_CHILDREN)
        code, words = self.ended("run", "few.toml", "--quiet", "--threads", 400)
        end = resource.getrusage(resource.RUSAGE_CHILDREN)
        self.assertEqual(code, 0, words)
        self.assertIn("try: --threads", words)
        switches = (end.ru_nvcsw + end.ru_nivcsw) - (begin.ru_nvcsw + begin.ru_nivcsw)
        self.assertLess(switches, 250_000)  # now 50,000; earlier 720,000

    def test_on_several_ranks(self):
        self.run_program(2, "run", "scene.toml", "--threads", 9, "--steps", 0, "--quiet",
                         says="try: --threads 1")

    @classmethod
    def tearDownClass(cls):
        print(f"{cls.n_runs} runs of the program")


if __name__ == "__main__":
    main()
