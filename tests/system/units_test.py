# SPDX-License-Identifier: BSD-3-Clause
"""No default of a scene depends on the unit of length or of time: every scene of inputs/, written
in units that are powers of two of its own, ends in the same bits, scaled.

The page of keys says what a key's unit is. A step is the time-stepped method's own time, so that
method is tested in other units of length alone.
"""
import json
import re
import subprocess
import tomllib

from program import PROGRAM, SOURCES, ProgramTest, main

STEPS = 10  # at most, in the scene's own unit of time


def units_of_keys():
    """{key: its unit}, from the page of keys. A side's keys stand there for the left one. Of a
    list of tables: {field: its unit}.
    """
    page = subprocess.run([PROGRAM, "keys"], capture_output=True, text=True, check=True).stdout
    units = {}
    for line in page.splitlines():
        cells = [cell.strip() for cell in line.split("|")]
        if len(cells) > 4 and (name := re.fullmatch(r"`([a-z_.]+\.[a-z_.]+)`", cells[1])):
            units[name[1]] = [unit.strip() for unit in cells[3].split(",")]
            if cells[2].startswith("tables of "):
                units[name[1]] = dict(zip(re.findall(r"(\w+) = ", cells[2]), units[name[1]]))
    units["time.micro_steps"] = ["1"]  # so that syncs follow each other as often in any unit
    for key in [key for key in units if key.startswith("box.left.")]:
        for side in ("right", "bottom", "top"):
            units[key.replace("left", side)] = units[key]
    return units


def factor_of(unit, length, time):
    """The factor of a number: `length` and `time` are the new units' inverse sizes."""
    if unit == "micro-steps":
        return time
    above, _, below = unit.partition("/")

    def product(words):
        factor = 1.0
        for word in words.split():
            name, _, power = word.partition("^")
            size = {"length": length, "step": time, "steps": time}.get(name, 1.0)
            factor *= size ** int(power or 1)
        return factor
    return product(above) / product(below)


def scaled(value, units, length, time):
    """A number, or rows and tables of them, whose units follow each other."""
    if isinstance(value, (bool, str)):
        return value
    if isinstance(value, (int, float)):
        factor = factor_of(units[0], length, time)
        return value * factor if factor != 1 else value
    if isinstance(value, dict):
        return {name: scaled(number, [units[name]], length, time)
                for name, number in value.items()}
    if value and isinstance(value[0], (list, dict)):
        return [scaled(row, units, length, time) for row in value]
    by_place = units * len(value)
    if len(units) > 1:  # rows [x, y, vx, vy, ...] of lengths and velocities
        by_place = [units[0], units[0], units[1], units[1], units[0], "mass"]
    return [scaled(number, [by_place[k]], length, time) for k, number in enumerate(value)]


def flat(table, before=""):
    """{dotted key: value} of a scene. Tables that are one key's value stay whole."""
    keys = {}
    for name, value in table.items():
        if isinstance(value, dict):
            keys |= flat(value, f"{before}{name}.")
        else:
            keys[before + name] = value
    return keys


def toml_of(value):
    if isinstance(value, dict):
        return "{" + ", ".join(f"{k} = {toml_of(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml_of, value)) + "]"
    if isinstance(value, float) and value == int(value) and abs(value) < 1e15:
        return repr(value)
    return json.dumps(value)


class Units(ProgramTest):
    def state_after(self, keys, units, length, time):
        """{disc: [x, y, vx, vy]} at the end, in the scene's own units."""
        changed = {}
        for key, value in keys.items():
            changed[key] = scaled(value, units[key], length, time)
            if isinstance(value, int) and not isinstance(value, bool):
                changed[key] = int(changed[key]) if changed[key] == int(changed[key]) else \
                    changed[key]
        text = "".join(f"{key} = {toml_of(value)}\n" for key, value in changed.items())
        run = self.run_program(1, "run", self.write("scene.toml", text), "--threads", 1)
        last = str(changed["time.steps"]) + " "
        state = {}
        for line in run.out.splitlines():
            if line.startswith(last):
                words = line.split()
                x, y, vx, vy = map(float, words[2:6])
                state[int(words[1])] = [x / length, y / length, vx / length * time,
                                        vy / length * time]
        return state

    def check(self, scene, sizes):
        keys = {key: value for key, value in flat(
            tomllib.loads(scene.read_text(encoding="utf-8"))).items()
            if not key.startswith("output.")}
        keys["output.text"] = "ends"
        keys["time.steps"] = min(keys["time.steps"], STEPS)
        if "time.sync_every" not in keys:  # its default may be shorter in another unit of time
            text = "".join(f"{key} = {toml_of(value)}\n" for key, value in keys.items())
            self.run_program(1, "run", self.write("scene.toml", text), "--steps", 1, "--threads", 1,
                             "--report", "report.json")
            keys["time.sync_every"] = self.report("report.json")["sync_every"]
        units = units_of_keys()
        first = self.state_after(keys, units, 1.0, 1.0)
        self.assertTrue(first)
        length, time = sizes
        if keys.get("time.method") == "time-stepped":
            time = 1.0
        other = self.state_after(keys, units, length, time)
        self.assertEqual([disc for disc in first if first[disc] != other.get(disc)], [])


def add_test(scene, sizes):
    setattr(Units, f"test_{scene.stem}", lambda self: self.check(scene, sizes))


for number, path in enumerate(sorted((SOURCES / "inputs").glob("*.toml"))):
    add_test(path, ((2.0 ** 7, 2.0), (2.0 ** -9, 4.0))[number % 2])

if __name__ == "__main__":
    main()
