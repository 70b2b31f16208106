# SPDX-License-Identifier: BSD-3-Clause
"""Threads that are bound to cores have all cores that the program was started with."""
import os
import subprocess
import time
from pathlib import Path

from program import PROGRAM, ProgramTest, main

# Steps that take minutes, so that there is time to inspect the threads.
SCENE = """
[box]
size = 1000
[discs]
count = 20000
packing = 0.3
speed = 0.5
[time]
steps = 1000000
"""


def processors_of(process):
    """The processors that its threads may use, all together; and the number of threads."""
    threads = list(Path(f"/proc/{process}/task").iterdir())
    masks = [os.sched_getaffinity(int(thread.name)) for thread in threads]
    return set().union(*masks), len(threads)


class Binding(ProgramTest):
    def test_bound_threads_share_all_processors(self):
        mine = os.sched_getaffinity(0)
        scene = self.write("scene.toml", SCENE)
        environment = {name: value for name, value in os.environ.items()
                       if name not in ("OMP_WAIT_POLICY", "GOMP_SPINCOUNT")}
        environment |= {"OMP_PROC_BIND": "close", "OMP_PLACES": "cores"}
        with subprocess.Popen([PROGRAM, "run", scene, "--threads", str(len(mine))],
                              cwd=self.folder, env=environment, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as run:
            try:
                seen, threads, patience = set(), 0, time.monotonic() + 60
                while time.monotonic() < patience and threads < len(mine):
                    time.sleep(0.5)
                    seen, threads = processors_of(run.pid)
                time.sleep(1)
                seen, threads = processors_of(run.pid)
            finally:
                run.kill()
        self.assertGreaterEqual(threads, len(mine))
        self.assertEqual(seen, mine)


if __name__ == "__main__":
    main()
