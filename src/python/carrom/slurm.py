# SPDX-License-Identifier: BSD-3-Clause
"""An array job of Slurm for the runs of a sweep."""

from __future__ import annotations

import shlex
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from carrom.errors import CarromError, ProgramNotFoundError
from carrom.plain import read_text
from carrom.scene import SCENE_FILES, set_words, to_toml
from carrom.sweeps import Point

_SCRIPT = r"""#!/bin/bash
# Runs line SLURM_ARRAY_TASK_ID of {commands}. Written by carrom.sweep.
{options}
# A job that has to stop stores a checkpoint, leaves with code 75 and goes back into the queue.
line=$(sed -n "${{SLURM_ARRAY_TASK_ID}}p" {commands})
export OMP_NUM_THREADS={threads}
child=
trap '[ -z "$child" ] || kill -USR1 "$child" 2>/dev/null' USR1 TERM
eval "$line &"
child=$!
while kill -0 "$child" 2>/dev/null; do wait "$child"; done
wait "$child"
code=$?
[ "$code" -ne 75 ] || scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_${{SLURM_ARRAY_TASK_ID}}"
exit "$code"
"""


class SlurmError(CarromError):
    """Slurm did not take the job."""


def submit(
    folder: Path,
    points: Sequence[Point],
    program: Path,
    launcher: str,
    ranks: int,
    threads: int,
    options: Mapping[str, Any],
) -> str:
    """Write `commands.txt` and `array.sbatch` into the folder and submit; return the job's number.

    Raises:
        SlurmError: sbatch refused, or the folder has runs of an earlier job that may go on
        ProgramNotFoundError: there is no sbatch
    """
    if shutil.which("sbatch") is None:
        raise ProgramNotFoundError("there is no sbatch: slurm=True works where jobs are submitted")
    folder = folder.absolute()
    folder.mkdir(parents=True, exist_ok=True)
    _check_queue(folder)
    lines = [_command(folder, point, program, launcher, ranks, threads) for point in points]
    commands = folder / "commands.txt"
    commands.write_text("\n".join(lines) + "\n", encoding="utf-8")
    script = folder / "array.sbatch"
    text = _script(folder, commands, len(points), ranks, threads, options)
    script.write_text(text, encoding="utf-8")
    done = subprocess.run(
        ["sbatch", "--parsable", str(script)], capture_output=True, text=True, check=False
    )
    if done.returncode != 0:
        raise SlurmError(f"sbatch refused {script}: {done.stderr.strip()}")
    job = done.stdout.strip().partition(";")[0]
    (folder / "job.txt").write_text(job + "\n")
    return job


def _check_queue(folder: Path) -> None:
    """Refuse a second job for runs that a first one still works at."""
    note = folder / "job.txt"
    job = read_text(note).strip() if note.exists() else ""
    if not job:
        return
    queue = subprocess.run(
        ["squeue", "-h", "-j", job, "-o", "%A"], capture_output=True, text=True, check=False
    )
    if queue.returncode == 0 and queue.stdout.strip():
        raise SlurmError(f"{folder}: job {job} still works at this sweep; cancel it or wait")


def _command(
    folder: Path, point: Point, program: Path, launcher: str, ranks: int, threads: int
) -> str:
    """Return a line of shell: begin the run, or go on with what is there."""
    run_folder = folder / point.name
    if isinstance(point.scene, Path):
        words = [str(point.scene.absolute())]
        words += [w for word in set_words(point.overrides) for w in ("--set", word)]
    else:
        (folder / "scenes").mkdir(exist_ok=True)
        scene = folder / "scenes" / f"{point.name}.toml"
        scene.write_text(to_toml(point.scene), encoding="utf-8")
        words = [str(scene)]
    launch = [launcher, "-n", str(ranks)] if ranks > 1 else []
    start = [*launch, str(program), "run"]
    common = ["-o", str(run_folder), "--threads", str(threads)]
    begin = shlex.join(["exec", *start, *words, *common])
    steps = [] if point.steps is None else ["--steps", str(point.steps)]
    resume = shlex.join(["exec", *start, "--resume", *common, *steps])
    begun = shlex.join(["ls", *(str(run_folder / name) for name in SCENE_FILES)])
    return f"{{ if {begun} 2>/dev/null | grep -q .; then {resume}; else {begin}; fi; }}"


def _script(
    folder: Path, commands: Path, n: int, ranks: int, threads: int, options: Mapping[str, Any]
) -> str:
    known: dict[str, Any] = {
        "job-name": "carrom-sweep",
        "array": f"1-{n}",
        "ntasks": ranks,
        "cpus-per-task": threads,
        "signal": "B:USR1@60",
        "requeue": True,
        "open-mode": "append",
        "output": str(folder / "slurm-%A_%a.log"),
    }
    known |= {str(key).replace("_", "-"): value for key, value in options.items()}
    lines = []
    for key, value in known.items():
        if value is not False and value is not None:
            word = str(value)
            word = f'"{word}"' if " " in word and '"' not in word else word
            lines.append(f"#SBATCH --{key}" + ("" if value is True else f"={word}"))
    return _SCRIPT.format(
        commands=shlex.quote(str(commands)), options="\n".join(lines), threads=threads
    )
