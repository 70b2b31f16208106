#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Hold heaps whose contacts last from sync to sync to soft discs of the same geometry (LAMMPS).

  tests/physics/heaps.py CARROM STUDY [--short] [--friction 0 0.3 0.8]

column     a column beside a wall collapses on a floor, with friction 0, 0.3 and 0.8
heap       a block collapses on a floor of fixed discs into a heap, with the same frictions

Each study prints a row of CSV for each friction: means and scatter of how far, how high and how
steeply the discs lie. Both programs begin from the same five starts. Two sizes of discs do not
crystallize. LAMMPS (lmp, gran/hooke/history) has linear springs, so stiff that discs overlap by
less than 2 % of a radius, and the same restitution and friction. Means that differ by more than the
joint scatter of the starts are named: that is 2.2 standard errors of five starts, which one of 18
exceeds by chance. The code is 1 beyond 1.5 of it (docs/understanding/validation.md), and 77 without
lmp.
"""
import argparse
import json
import math
import os
import random
import shutil
import statistics
import subprocess
import sys
import tempfile

from rough_heaps import G, RADII, RESTITUTION, discs_and_time, effects, surface, write_discs

STIFFNESS = 3000
MOST_SCATTERS = 1.5

COLUMN = {"box": (300, 160), "corner": (1.2, 1.2), "columns": 9, "rows": 26, "steps": 800,
          "fixed": []}
HEAP = {"box": (160, 60), "corner": (62, 2.2), "columns": 16, "rows": 16, "steps": 800,
        "fixed": [(x, 0, 1) for x in range(1, 160, 2)]}


def start_of(case, seed):
    """Rows of x, y and radius, small discs first."""
    draw = random.Random(seed)
    places = []
    for row in range(case["rows"]):
        for column in range(case["columns"]):
            places.append((case["corner"][0] + 2.26 * (column + row % 2 / 2) +
                           draw.uniform(-0.02, 0.02),
                           case["corner"][1] + 2.24 * row + draw.uniform(-0.02, 0.02)))
    draw.shuffle(places)
    half = len(places) // 2
    return [(x, y, RADII[0] if k < half else RADII[1]) for k, (x, y) in enumerate(places)]


def scene_of(case, friction, count, steps, speed):
    rubs = surface(friction)
    obstacles = (f"[effects.obstacles]\n{rubs}"
                 f"discs = {[list(map(float, body)) for body in case['fixed']]}\n"
                 if case["fixed"] else "")
    return f"""[box]
size = [{case["box"][0]}, {case["box"][1]}]
left.restitution = {RESTITUTION}
right.restitution = {RESTITUTION}
[box.bottom]
{rubs}
{discs_and_time(count, steps, sync_every=1)}
{effects(friction, speed)}
{obstacles}"""


def carrom(options, case, friction, discs):
    """The places at the end, and the report."""
    with tempfile.TemporaryDirectory() as folder:
        scene = os.path.join(folder, "scene.toml")
        with open(scene, "w", encoding="utf-8") as file:
            file.write(scene_of(case, friction, len(discs), case["steps"], options.speed))
        write_discs(os.path.join(folder, "discs.txt"), discs)
        report = os.path.join(folder, "report.json")
        done = subprocess.run([options.program, "run", scene, "--quiet", "--threads", "1",
                               "--report", report, "--set", "output.text=ends"],
                              check=True, stdout=subprocess.PIPE, text=True)
        rows = [line.split() for line in done.stdout.splitlines()]
        with open(report, encoding="utf-8") as file:
            result = json.load(file)
        return [(float(row[2]), float(row[3])) for row in rows[-len(discs):]], result


LAMMPS = """units lj
dimension 2
atom_style sphere
comm_modify vel yes
boundary f f p
newton off
region all block 0 {width} -2 {height} -0.5 0.5
create_box 3 all
{atoms}
set type 1 diameter {d1} mass {m1}
set type 2 diameter {d2} mass {m2}
set type 3 diameter {d3} mass {m3}
group moving type 1 2
pair_style gran/hooke/history {kn} {kt} {gn} {gt} {mu} 1
pair_coeff * *
neighbor 0.4 bin
neigh_modify delay 0 every 10 check yes exclude type 3 3
fix gravity moving gravity {g} vector 0 -1 0
fix motion moving nve/sphere disc
fix plane all enforce2d
fix floor moving wall/gran hooke/history {kn} {kt} {wall_gn} {wall_gt} {mu} 1 yplane 0 NULL
fix sides moving wall/gran hooke/history {kn} {kt} {wall_gn} 0 0 1 xplane 0 {width}
timestep {dt}
thermo 100000
run {steps}
write_dump all custom {dump} id type x y modify sort id
"""


def lammps(case, friction, discs):
    """The places at the end."""
    frequency = math.sqrt(2 * STIFFNESS)
    decay = -math.log(RESTITUTION)
    damping = 2 * frequency * decay / math.hypot(math.pi, decay)
    dt = math.pi / frequency / 30
    atoms = [f"create_atoms {1 if radius < 1 else 2} single {x:.12g} {y:.12g} 0"
             for x, y, radius in discs]
    atoms += [f"create_atoms 3 single {x} {y} 0" for x, y, _ in case["fixed"]]
    # LAMMPS multiplies damping by the reduced mass, which is the disc's own at walls. With these
    # numbers walls and fixed discs have the same restitution as pairs, too.
    of_walls = damping / math.sqrt(2)
    fixed_mass = 1 / (math.sqrt(2) - 1)
    springs = {"kn": STIFFNESS, "kt": STIFFNESS * 2 / 7, "gn": damping, "gt": damping / 2,
               "wall_gn": of_walls, "wall_gt": of_walls / 2, "mu": friction}
    with tempfile.TemporaryDirectory() as folder:
        dump = os.path.join(folder, "last")
        script = os.path.join(folder, "in.heap")
        with open(script, "w", encoding="utf-8") as file:
            file.write(LAMMPS.format(
                width=case["box"][0], height=case["box"][1], atoms="\n".join(atoms),
                d1=2 * RADII[0], d2=2 * RADII[1], m1=RADII[0] ** 2, m2=RADII[1] ** 2,
                d3=2 * (case["fixed"][0][2] if case["fixed"] else 1), m3=fixed_mass, g=G, dt=dt,
                steps=round(case["steps"] / dt), dump=dump, **springs))
        subprocess.run(["lmp", "-in", script, "-log", "none", "-screen", "none"], check=True)
        with open(dump, encoding="utf-8") as file:
            rows = [line.split() for line in file.read().splitlines()[9:]]
    return [(float(x), float(y)) for _, kind, x, y in rows if kind != "3"]


def shape_of(case, places):
    """How far and how high the discs lie, and the slope of the surface in degrees."""
    middle = case["box"][0] / 2 if case is HEAP else 0
    far = sorted(abs(x - middle) for x, _ in places)
    highest = {}
    for x, y in places:
        column = int(abs(x - middle) / 4)
        highest[column] = max(highest.get(column, 0), y)
    flank = [(4 * k + 2, y) for k, y in sorted(highest.items()) if y > 3 and k > 0]
    slope = float("nan")
    if len(flank) > 2:
        mean_x, mean_y = (statistics.fmean(values) for values in zip(*flank))
        slope = -math.degrees(math.atan(
            sum((x - mean_x) * (y - mean_y) for x, y in flank) /
            sum((x - mean_x) ** 2 for x, _ in flank)))
    return {"runout": far[int(0.95 * len(far))],
            "height": 2 * statistics.fmean(y for _, y in places), "slope": slope}


def collapse(options, case):
    for friction in options.friction:
        found = {"carrom": [], "lammps": []}
        for seed in range(1, 3 if options.short else 6):
            discs = start_of(case, seed)
            found["carrom"].append(shape_of(case, carrom(options, case, friction, discs)[0]))
            found["lammps"].append(shape_of(case, lammps(case, friction, discs)))
        yield row_of(options.study, friction, found)


def row_of(study, friction, found):
    row = {"study": study, "friction": friction}
    for quantity in found["carrom"][0]:
        for who, shapes in found.items():
            values = [shape[quantity] for shape in shapes]
            row[f"{quantity}_{who}"] = statistics.fmean(values)
            row[f"{quantity}_{who}_scatter"] = statistics.stdev(values)
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", metavar="CARROM")
    parser.add_argument("study", choices=("column", "heap"))
    parser.add_argument("--short", action="store_true", help="two starts")
    parser.add_argument("--friction", type=float, nargs="+", default=[0, 0.3, 0.8])
    parser.add_argument("--speed", type=float, default=0.05)
    options = parser.parse_args()
    if not shutil.which("lmp"):
        print("left out: there is no LAMMPS (lmp)", file=sys.stderr)
        return 77
    code, rows = 0, []
    for row in collapse(options, COLUMN if options.study == "column" else HEAP):
        if not rows:
            print(",".join(row))
        rows.append(row)
        print(",".join(value if isinstance(value, str) else f"{value:.4g}"
                       for value in row.values()), flush=True)
        for name in [key[:-7] for key in row if key.endswith("_carrom")]:
            scatter = math.hypot(row[f"{name}_carrom_scatter"], row[f"{name}_lammps_scatter"])
            away = abs(row[f"{name}_carrom"] - row[f"{name}_lammps"])
            if away > scatter and not math.isnan(away):
                print(f"friction {row['friction']:g}: {name} differs by {away / scatter:.2f} "
                      "scatters", file=sys.stderr)
            if away > MOST_SCATTERS * scatter:
                code = 1
    return code


if __name__ == "__main__":
    sys.exit(main())
