# SPDX-License-Identifier: BSD-3-Clause
"""Discs from files as other programs write them, and velocities for discs whose places are given.

A file in another form has the state hash of the plain one. Drawn velocities have the energy that
the scene asks for, and reversed ones bring discs back to where they were.
"""
from program import ProgramTest, checkpoint, lines_of, main

SCENE = """
[box]
size = 20
[discs]
radius = 0.5
{}
[time]
steps = 200
sync_every = 16
"""

# Ids in another order than that of the lines.
DISCS = [(2, 3.25, 4, 0.25, -0.5), (0, 10, 11.5, -0.125, 0.375), (3, 6, 15, 0.5, 0),
         (1, 17, 3, 0, 0.25)]
BY_ID = sorted(DISCS)
COUNT = f"count = {len(DISCS)}\n"


def lines(rows, separator=" "):
    return "".join(separator.join(map(str, row)) + "\n" for row in rows)


def without_ids(rows):
    return [row[1:] for row in rows]


# Each is the same four discs.
FORMS = {
    "comments": "# made by hand\n\n" + lines(DISCS).replace("\n", "  # a disc\n\n"),
    "commas": lines(DISCS, ", "),
    "tabs": lines(DISCS, "\t").replace("\n", "\r\n"),
    "mark": "\ufeff" + lines(DISCS),
    "header": "ID,X,Y,VX,VY\n" + lines(DISCS, ","),
    "order": "vx vy id x y\n" + lines([(d[3], d[4], d[0], d[1], d[2]) for d in DISCS]),
    "comment_of_names": "# x, y, vx, vy\n" + lines(without_ids(BY_ID)),
    "header_without_ids": "# discs\nx;y\n".replace("x;y", "x y vx vy") + lines(without_ids(BY_ID)),
    "no_ids": lines(without_ids(BY_ID), ","),
    "radii": "x,y,vx,vy,r\n" + lines([row[1:] + (0.5,) for row in BY_ID], ","),
}

# A file, the line of its mistake (None: of the file as a whole), and the text about it.
WRONG = {
    "few.txt": ("# x\n0 1 2 0 0\n1 3 4 0\n", 3, "found only 4 of the 5 numbers"),
    "twice.txt": ("0 1 2 0 0\n0 3 4 0 0\n", 2, "disc 0 is listed twice"),
    "nan.txt": ("0 1 2 0 0\n1 nan 4 0 0\n", 2, "the position nan is not a finite number"),
    "word.txt": ("0 1 2 0 0\n1 3 four 0 0\n", 2, "'four' is not a number"),
    "outside.txt": ("1 2 0 0\n\n30 4 0 0\n", 3, "disc 1 at (30, 4) is not inside the box"),
    "range.txt": ("1 1 2 0 0\n2 3 4 0 0\n", 2, "disc 2 is out of range: ids are 0 to 1"),
    "name.csv": ("id,x,y,vx,vy,colour\n0,1,2,0,0,1\n", 1, "the header line names 'colour'; col"),
    "no_x.csv": ("id,y,vx,vy\n0,1,2,0\n", 1, "must name x and y"),
    "two_x.csv": ("x,y,x\n0,1,2\n", 1, "names x twice"),
    "empty.txt": ("# nothing\n", None, "has no discs"),
    "dump.lammpstrj": ("ITEM: TIMESTEP\n0\n", 1, "looks like a LAMMPS dump"),
    "picture.png": ("\x00\x01\x02\n", 1, "holds bytes that are no text"),
    "long.txt": ("0 1 2 0 0\n" + "1" * 5000 + "\n", 2, "a line of more than 4096 characters"),
    "rest.txt": ("0 1 2\n1 3 4\n", None, "have no velocity; try: discs.temperature or discs.speed"),
    "empty_field.csv": ("x,y,vx,vy\n1,1,0,0\n3,3,,0,1\n", 3, "'?0' is not a number"),
    "first_field.csv": ("x,y,vx,vy\n,1,1,0,0\n", 2, "'?1' is not a number"),
    "radius.txt": ("0.25 0.5 1\n", 1, "'0.25' is not the id of a disc; lines are 'id x y'"),
}


class Files(ProgramTest):
    def run_form(self, name, text, ranks=1, more=""):
        self.write(f"{name}.txt", text)
        scene = SCENE.format(f'file = "{name}.txt"\n{more}')
        if "radi" in name:
            scene = scene.replace("radius = 0.5\n", "")
        self.write(f"{name}.toml", scene)
        self.run_program(ranks, "run", f"{name}.toml", "--quiet", "--report", f"{name}.json")
        return self.hash_of(f"{name}.json")

    def test_forms(self):
        plain = self.run_form("plain", lines(DISCS), more=COUNT)
        for name, text in FORMS.items():
            with self.subTest(name):
                self.assertEqual(self.run_form(name, text), plain)
        for name in ("order", "no_ids", "radii"):
            for ranks in (2, 3, 5):
                with self.subTest(name, ranks=ranks):
                    self.assertEqual(self.run_form(name, FORMS[name], ranks), plain)

    def test_many_lines_on_many_ranks(self):
        """More lines than one chunk, so that all ranks take parts of the file with a header."""
        n = 300
        rows = [(n * n - 1 - k, 0.5 + k % n, 0.5 + k // n, (k % 7) / 8, 0) for k in range(n * n)]
        scene = SCENE.replace("size = 20", f"size = {n}").replace("steps = 200", "steps = 1")
        scene = scene.replace("radius = 0.5", "radius = 0.25")
        hashes = set()
        for name, text in (("plain", lines(rows)), ("csv", "id,x,y,vx,vy\n" + lines(rows, ","))):
            self.write(f"{name}.txt", "# a comment\n" + text)
            self.write("many.toml", scene.format(f'file = "{name}.txt"'))
            for ranks in (1, 3):
                self.run_program(ranks, "run", "many.toml", "--quiet", "--report", "many.json")
                hashes.add(self.hash_of("many.json"))
        self.assertEqual(len(hashes), 1)

    def test_restart_without_the_file(self):
        """A checkpoint keeps what the file says of its columns and of its number of discs."""
        rows = [row + (0.25 + 0.125 * row[0], 1 + row[0]) for row in DISCS]
        self.write("csv.txt", "id,x,y,vx,vy,radius,mass\n" + lines(rows, ","))
        self.write("csv.toml", SCENE.format('file = "csv.txt"').replace("radius = 0.5", ""))
        self.check_restart("csv.toml", first=70, last=200)
        self.run_program(1, "run", "csv.toml", "-o", "moved", "--steps", 70, "--quiet")
        (self.folder / "csv.txt").unlink()
        self.run_program(2, "run", "-o", "moved", "--resume", "--steps", 200, "--quiet", "--report",
                         "moved.json")
        self.assertEqual(self.hash_of("moved.json"), self.hash_of("whole.json"))

    def test_wrong_files(self):
        for name, (text, line, says) in WRONG.items():
            self.write(name, text)
            self.write("wrong.toml", SCENE.format(f'file = "{name}"'))
            place = name if line is None else f"{name}:{line}"
            if name == "rest.txt":
                place = "wrong.toml:6"
            for ranks in (1, 3):
                with self.subTest(name, ranks=ranks):
                    run = self.run_program(ranks, "run", "wrong.toml", code=2, says=says)
                    self.assertTrue([line for line in run.err.splitlines()
                                     if f"{place}: " in line and says in line], run.err)
        self.write("wrong.toml", SCENE.format('file = "nowhere.txt"'))
        run = self.run_program(1, "run", "wrong.toml", code=2, says="nowhere.txt")
        self.assertEqual(run.err.count("nowhere.txt"), 1, run.err)

    def test_wrong_numbers_of_discs(self):
        self.write("discs.txt", lines(without_ids(BY_ID)))
        for count, says in ((3, "discs.txt:4: one line too many: the scene is of 3 discs"),
                            (5, "1 of 5 discs is missing: 4")):
            self.write("count.toml", SCENE.format(f'file = "discs.txt"\ncount = {count}'))
            self.run_program(2, "run", "count.toml", code=2, says=says)

    def test_overlaps(self):
        """An overlap in the file is an error of the discs that overlap an obstacle, and a warning
        between discs, as it is for a list.
        """
        self.write("discs.txt", lines([(5, 5, 0, 0), (9, 9, 0.1, 0)]))
        self.write("overlap.toml", SCENE.format('file = "discs.txt"')
                   + "[effects.obstacles]\ndiscs = [[9, 9.25, 1]]\n")
        self.run_program(2, "run", "overlap.toml", code=2, says="disc 1 at (9, 9) overlaps")

    def test_columns_of_a_file_without_names(self):
        """`discs.columns` names all columns of a line, in any order."""
        plain = self.run_form("plain", lines(DISCS))
        self.write("rows.txt", lines([(d[3], d[4], d[2], d[1]) for d in BY_ID]))
        self.write("rows.toml",
                   SCENE.format('file = "rows.txt"\ncolumns = ["vx", "vy", "y", "x"]'))
        self.run_program(2, "run", "rows.toml", "--quiet", "--report", "rows.json")
        self.assertEqual(self.hash_of("rows.json"), plain)
        for columns, says in (('["id", "radius"]', "names no x or no y"),
                              ('["x", "y", "vx"]', "names one of vx and vy")):
            self.write("rows.toml", SCENE.format(f'file = "rows.txt"\ncolumns = {columns}'))
            self.run_program(1, "run", "rows.toml", code=2, says=says)
        self.write("named.txt", "x y vx vy\n" + lines(without_ids(BY_ID)))
        self.write("rows.toml", SCENE.format('file = "named.txt"\ncolumns = ["mass", "radius"]'))
        self.run_program(1, "run", "rows.toml", code=2,
                         says=["named.txt:1:", "leave discs.columns out"])


PLACES = [(2 + 3 * (k % 6), 2 + 3 * (k // 6)) for k in range(30)]
LIST = f"list = {[list(place) for place in PLACES]}\n"


class Velocities(ProgramTest):
    def report_of(self, name, discs, ranks=1, steps=0):
        self.write(f"{name}.toml", SCENE.format(discs))
        self.run_program(ranks, "run", f"{name}.toml", "--quiet", "--steps", steps, "--report",
                         f"{name}.json", "-o", f"{name}_{ranks}")
        return self.report(f"{name}.json")

    def test_temperature_and_speed(self):
        """The energy of N discs of mass 1 is N kT, or N v^2 / 2."""
        warm = self.report_of("warm", LIST + "temperature = 0.25")
        self.assertAlmostEqual(warm["kinetic_energy"], 30 * 0.25, delta=1e-13)
        fast = self.report_of("fast", LIST + "speed = 0.5\nvelocities = \"uniform\"\nseed = 7")
        self.assertAlmostEqual(fast["kinetic_energy"], 30 * 0.5 ** 2 / 2, delta=1e-13)
        still = self.report_of("still", LIST + "speed = 0")
        self.assertEqual(still["kinetic_energy"], 0)

    def test_masses(self):
        """All species have one kT on average, and all discs together have it exactly."""
        species = "species = [{count = 10, radius = 0.5, mass = 4}, {count = 20, radius = 0.25}]\n"
        scene = (LIST + species + "temperature = 0.25").replace("radius = 0.5\n{}", "{}")
        self.write("mixed.toml", SCENE.replace("radius = 0.5\n{}", "{}").format(scene))
        self.run_program(3, "run", "mixed.toml", "--quiet", "--steps", 0, "--report", "mixed.json")
        self.assertAlmostEqual(self.report("mixed.json")["kinetic_energy"], 7.5, delta=1e-13)

    def test_list_file_and_from_draw_the_same(self):
        """Velocities depend on ids and the seed, whatever gives the places, and however many ranks
        there are. Velocities that the places come with are replaced.
        """
        drawn = "temperature = 0.25\nseed = 11"
        hashes = {self.report_of("list", LIST + drawn, steps=200)["state_hash"]}
        self.write("places.txt", lines(PLACES))
        self.write("moving.csv", "y,x,id,vx,vy\n"
                   + lines([(y, x, k, 1, 2) for k, (x, y) in enumerate(PLACES)][::-1], ","))
        files = {"places": 'file = "places.txt"\n', "moving": 'file = "moving.csv"\n',
                 "from": f'from = "{checkpoint("list_1", 0)}"\n'}
        self.run_program(1, "run", "list.toml", "--steps", 0, "-o", "list_1", "--overwrite",
                         "--quiet")
        for name, source in files.items():
            for ranks in (1, 2, 5):
                with self.subTest(name, ranks=ranks):
                    hashes.add(self.report_of(name, source + drawn, ranks, 200)["state_hash"])
        self.assertEqual(len(hashes), 1)
        other = self.report_of("other", LIST + drawn.replace("11", "12"), steps=200)["state_hash"]
        self.assertNotIn(other, hashes)

    def test_restart(self):
        self.write("drawn.toml", SCENE.format(LIST + "temperature = 0.25"))
        self.check_restart("drawn.toml", first=90, last=200)
        self.run_program(1, "run", "drawn.toml", "--set", "discs.temperature=0.3", "--restart",
                         "kept", "--steps", 200, code=2, says="'discs.temperature' is 0.25 there")

    def test_check_holds(self):
        self.write("drawn.toml", SCENE.format(LIST + "speed = 0.3"))
        self.run_program(2, "run", "drawn.toml", "--check", "--quiet")

    def test_command_line(self):
        """A speed of a scene that generates its discs is none for discs that the command line
        lists; a speed of a scene that lists discs stays.
        """
        self.write("gas.toml", SCENE.format("count = 4\nspeed = 0.125"))
        self.write("discs.txt", lines(DISCS))
        self.run_program(1, "run", "gas.toml", "--set", "discs.file=discs.txt", "--steps", 0,
                         "--quiet", "--report", "file.json")
        given = sum(vx * vx + vy * vy for _, _, _, vx, vy in DISCS) / 2
        self.assertEqual(self.report("file.json")["kinetic_energy"], given)
        self.run_program(1, "run", "gas.toml", "--set", "discs.file=discs.txt", "--set",
                         "discs.speed=0.5", "--steps", 0, "--quiet", "--report", "file.json")
        self.assertAlmostEqual(self.report("file.json")["kinetic_energy"], 0.5, delta=1e-14)
        self.write("listed.toml", SCENE.format(LIST + "speed = 0.5"))
        self.run_program(1, "run", "listed.toml", "--set", "discs.file=discs.txt", "--steps", 0,
                         "--quiet", "--report", "file.json")
        self.assertAlmostEqual(self.report("file.json")["kinetic_energy"], 0.5, delta=1e-14)

    def test_messages(self):
        for discs, says in ((LIST, "row 1 of 'discs.list': no velocity; try: discs.temperature"),
                            ("list = [[1, 2, 3]]", "three numbers; it takes [x, y] or [x, y, vx"),
                            ("list = [[1, 2, 0, 0]]\nseed = 3", "where discs are listed with th"),
                            ("list = [[1, 2, 0, 0]]\nvelocities = \"uniform\"",
                             "neither 'discs.speed' nor 'discs.temperature' draws"),
                            ("list = [[1, 2]]\nspeed = 1\ntemperature = 1", "exclude each other"),
                            (LIST + "speed = 1\nvelocities = \"reversed\"", "it turns listed ones"),
                            ("count = 3\nvelocities = \"reversed\"", "it turns listed ones")):
            with self.subTest(says):
                self.write("wrong.toml", SCENE.format(discs))
                self.run_program(1, "run", "wrong.toml", code=2, says=says)


ROUGH = """
[effects.contact]
kind = "rough"
restitution = 1
tangential_restitution = 1
"""


class Reversed(ProgramTest):
    def states(self, name, step, *words):
        out = self.run_program(2, "run", f"{name}.toml", "--set", "output.text=ends", *words).out
        return [list(map(float, line.split()[2:6])) for line in lines_of(out, step)]

    def go_and_return(self, effects):
        discs = [[x, y, 0.03 * (k % 5) - 0.06, 0.04 * (k % 3) - 0.04] + [0.02 * (k % 4)]
                 * bool(effects) for k, (x, y) in enumerate(PLACES)]
        self.write("go.toml", SCENE.format(f"list = {discs}") + effects)
        start = self.states("go", 0, "--steps", 300, "-o", "go", "--report", "go.json")
        self.assertGreater(self.report("go.json")["pair_collisions"], 30)
        self.write("back.toml", SCENE.format(f'from = "{checkpoint("go", 300)}"\n'
                                             'velocities = "reversed"') + effects)
        back = self.states("back", 300, "--steps", 300)
        for (x, y, vx, vy), (x0, y0, vx0, vy0) in zip(back, start):
            for now, then in ((x, x0), (y, y0), (vx, -vx0), (vy, -vy0)):
                self.assertAlmostEqual(now, then, delta=1e-7)
        self.assertEqual(len(start), 30)

    def test_discs_return(self):
        """An elastic gas goes back to where it was; 1e-7 is left for roundings that
        grow with each of the collisions.
        """
        self.go_and_return("")

    def test_rough_discs_return(self):
        """They do so only if spins turn as well."""
        self.go_and_return(ROUGH)

    def test_list_and_restart(self):
        rows = [[x, y, 0.25 * (-1) ** k, 0.125] for k, (x, y) in enumerate(PLACES)]
        turned = [[x, y, -vx, -vy] for x, y, vx, vy in rows]
        self.write("reversed.toml", SCENE.format(f'list = {rows}\nvelocities = "reversed"'))
        self.write("turned.toml", SCENE.format(f"list = {turned}"))
        self.check_restart("reversed.toml", first=50, last=200)
        self.run_program(1, "run", "turned.toml", "--quiet", "--report", "turned.json")
        self.assertEqual(self.hash_of("turned.json"), self.hash_of("whole.json"))


if __name__ == "__main__":
    main()
