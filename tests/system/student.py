# SPDX-License-Identifier: BSD-3-Clause
"""A student's program for the time-stepped method: `student.py SCENE.in [MISTAKE]` writes lines of
discs.

It shares nothing with the program that it is graded by: no stored times, the quadratic formula from
the positions at the start of each step, normal and tangential parts. MISTAKE turns one rule into
what students write by mistake.
"""

import math
import random
import struct
import sys

NEVER = 2.0
MISTAKES = {  # each mistake with the rule that `carrom compare` must name
    "higher-ids": "order",
    "pair-before-wall": "order",
    "ids-first": "order",
    "walls-first": "order",
    "pairs-first": "order",
    "lost-blocks": "order",
    "many": "one collision a step",
    "list": "one collision a step",
    "same-start": "one collision a step",
    "last-start": "one collision a step",
    "half": "impulse",
    "no-stop": "stop at a wall",
    "bounce": "stop at a wall",
    "turn": "stop at a wall",
    "slide": "stop at a wall",
    "overlap": "overlap",
    "overlap-parting": "overlap",
    "overlap-late": "overlap",
    "overlap-end": "overlap",
    "corner": "corner",
    "pair-free": "candidates",
    "wall-free": "candidates",
    "one-disc": "impulse",
    "single": "precision",
    "count-stops": "counters",
    "count-corner": "counters",
    "unsorted": "lines",
    "short": "lines",
    "no-counters": "lines",
}


class Disc:
    def __init__(self, number, x, y, vx, vy):
        self.id, self.x, self.y, self.vx, self.vy = number, x, y, vx, vy
        self.pairs = self.walls = 0


def as_float(number):
    """Rounded to single precision."""
    return struct.unpack("f", struct.pack("f", number))[0]


class Box:
    def __init__(self, length, radius, discs, mistake):
        self.low, self.high, self.band = radius, length - radius, 1e-8 * radius
        self.sigma, self.discs, self.mistake = 2 * radius, discs, mistake
        self.n_seen = 0  # pairs or walls, for mistakes that happen once

    def axis_time(self, x, v, rest=1.0):
        if v < 0 and x + v * rest < self.low + self.band:
            return min(max((self.low - x) / v, 0.0), rest)
        if v > 0 and x + v * rest > self.high - self.band:
            return min(max((self.high - x) / v, 0.0), rest)
        return NEVER

    def wall_time(self, disc, rest=1.0):
        return min(self.axis_time(disc.x, disc.vx, rest), self.axis_time(disc.y, disc.vy, rest))

    def pair_time(self, p, q, rest=1.0):
        dx, dy, wx, wy = p.x - q.x, p.y - q.y, p.vx - q.vx, p.vy - q.vy
        a, half_b, c = wx * wx + wy * wy, dx * wx + dy * wy, dx * dx + dy * dy - self.sigma**2
        if c < -1e-9 * self.sigma**2:
            return self.overlap_time(a, half_b, c)
        if self.mistake == "overlap-end":
            ex, ey = dx + wx, dy + wy
            return 1.0 if math.hypot(ex, ey) < self.sigma and ex * wx + ey * wy < 0 else NEVER
        root = half_b * half_b - a * c
        if half_b >= 0 or root <= 0:
            return NEVER
        t = max((-half_b - math.sqrt(root)) / a, 0.0)
        return t if t <= rest else NEVER

    def overlap_time(self, a, half_b, c):
        if self.mistake == "overlap":
            return 0.0 if half_b < 0 else NEVER
        if self.mistake == "overlap-parting":
            return 0.0
        if self.mistake == "overlap-late" and a > 0:
            t = (-half_b + math.sqrt(half_b * half_b - a * c)) / a
            return t if t <= 1 else NEVER
        return NEVER

    def candidates(self):
        found = []
        for p in self.discs:
            t = self.wall_time(p)
            if t <= 1:
                found.append((t, p.id, -1))
            for q in self.discs[p.id + 1 :]:
                t = self.pair_time(p, q)
                if t <= 1:
                    found.append((t, p.id, q.id))
        return sorted(found, key=self.place)

    def place(self, candidate):
        t, p, q = candidate
        return {
            "higher-ids": (t, -p, q >= 0, -q),
            "pair-before-wall": (t, q < 0, p, q),
            "ids-first": (p, q, t, 0),
            "walls-first": (q >= 0, t, p, q),
            "pairs-first": (q < 0, t, p, q),
        }.get(self.mistake, (t, p, q >= 0, q))

    def step(self):
        taken, moved = set(), set()
        self.start = {disc.id: (disc.x, disc.y, disc.vx, disc.vy) for disc in self.discs}
        for t, p, q in self.candidates():
            both = {p} if q < 0 else {p, q}
            is_free = not both & taken
            if is_free and self.mistake == ("wall-free" if q < 0 else "pair-free"):
                self.n_seen += 1
                if self.n_seen == 3:
                    continue
            if is_free or self.mistake == "lost-blocks":
                taken |= both
            if is_free or self.mistake in ("list", "same-start", "last-start"):
                self.happen(t, p, q, moved)
        for disc in self.discs:
            if disc.id not in moved:
                disc.x, disc.y = disc.x + disc.vx, disc.y + disc.vy

    def happen(self, t, p, q, moved):
        """Discs that have moved are at the end of the step: taken back to the time of the
        collision.
        """
        discs = [self.discs[p]] if q < 0 else [self.discs[p], self.discs[q]]
        if self.mistake in ("same-start", "last-start"):
            self.happen_from_start(t, discs, moved)
            return
        for disc in discs:
            elapsed = t - 1 if disc.id in moved else t
            disc.x, disc.y = disc.x + disc.vx * elapsed, disc.y + disc.vy * elapsed
        if q < 0:
            self.bounce(discs[0])
        else:
            self.collide(*discs)
        for disc in discs:
            moved.add(disc.id)
            self.finish(disc, 1 - t)
        if self.mistake == "one-disc" and q >= 0:
            self.n_seen += 1
            if self.n_seen == 3:
                disc = self.discs[q]
                x, y, disc.vx, disc.vy = self.start[q]
                disc.x, disc.y = x + disc.vx, y + disc.vy

    def happen_from_start(self, t, discs, moved):
        """A collision as if it were the only one of the step. Changes of velocity add up, or the
        last one replaces those before.
        """
        before = [(disc.vx, disc.vy) for disc in discs]
        for disc in discs:
            x, y, disc.vx, disc.vy = self.start[disc.id]
            disc.x, disc.y = x + disc.vx * t, y + disc.vy * t
        self.bounce(discs[0]) if len(discs) == 1 else self.collide(*discs)
        for disc, (vx, vy) in zip(discs, before, strict=True):
            if self.mistake == "same-start":
                disc.vx += vx - self.start[disc.id][2]
                disc.vy += vy - self.start[disc.id][3]
            moved.add(disc.id)
            self.finish(disc, 1 - t)

    def step_all(self):
        """Every collision happens: "many"."""
        now = 0.0
        while True:
            rest = 1 - now
            due = [(self.wall_time(p, rest), p.id, -1) for p in self.discs]
            due += [
                (self.pair_time(p, q, rest), p.id, q.id)
                for p in self.discs
                for q in self.discs[p.id + 1 :]
            ]
            t, p, q = min(due)
            t = min(t, rest)
            for disc in self.discs:
                disc.x, disc.y = disc.x + disc.vx * t, disc.y + disc.vy * t
            now += t
            if now >= 1:
                return
            if q < 0:
                self.bounce(self.discs[p])
            else:
                self.collide(self.discs[p], self.discs[q])

    def bounce(self, disc):
        def touches(x, v):
            return (v < 0 and x <= self.low + self.band) or (v > 0 and x >= self.high - self.band)

        is_x, is_y = touches(disc.x, disc.vx), touches(disc.y, disc.vy)
        if not is_x and not is_y:  # within rounding of the wall that is nearer
            gap_x = (
                (disc.x - self.low if disc.vx < 0 else self.high - disc.x) if disc.vx else math.inf
            )
            gap_y = (
                (disc.y - self.low if disc.vy < 0 else self.high - disc.y) if disc.vy else math.inf
            )
            is_x, is_y = gap_x <= gap_y, gap_y < gap_x
        if self.mistake == "corner" and is_x:
            is_y = False
        disc.vx, disc.vy = -disc.vx if is_x else disc.vx, -disc.vy if is_y else disc.vy
        disc.walls += 2 if is_x and is_y and self.mistake == "count-corner" else 1

    def collide(self, p, q):
        distance = math.hypot(q.x - p.x, q.y - p.y)
        nx, ny = (q.x - p.x) / distance, (q.y - p.y) / distance
        pn, pt = p.vx * nx + p.vy * ny, p.vy * nx - p.vx * ny
        qn, qt = q.vx * nx + q.vy * ny, q.vy * nx - q.vx * ny
        if self.mistake == "half":
            pn = qn = (pn + qn) / 2
        p.vx, p.vy = qn * nx - pt * ny, qn * ny + pt * nx
        q.vx, q.vy = pn * nx - qt * ny, pn * ny + qt * nx
        p.pairs, q.pairs = p.pairs + 1, q.pairs + 1

    def finish(self, disc, rest):
        """The rest of the step after a collision, or the stop at a wall."""

        def time_to_wall(x, v):
            if v < 0 and x + v * rest < self.low:
                return max((self.low - x) / v, 0.0)
            if v > 0 and x + v * rest > self.high:
                return max((self.high - x) / v, 0.0)
            return NEVER

        sx, sy = time_to_wall(disc.x, disc.vx), time_to_wall(disc.y, disc.vy)
        first = min(sx, sy)
        if first == NEVER or self.mistake == "no-stop":
            disc.x, disc.y = disc.x + disc.vx * rest, disc.y + disc.vy * rest
            return
        if self.mistake == "slide":
            disc.x, disc.y = disc.x + disc.vx * min(sx, rest), disc.y + disc.vy * min(sy, rest)
            return
        disc.x, disc.y = disc.x + disc.vx * first, disc.y + disc.vy * first
        if self.mistake == "count-stops":
            disc.walls += 1
        if self.mistake in ("turn", "bounce"):
            disc.vx, disc.vy = (
                -disc.vx if sx == first else disc.vx,
                (-disc.vy if sy == first else disc.vy),
            )
        if self.mistake == "bounce":
            disc.x, disc.y = disc.x + disc.vx * (rest - first), disc.y + disc.vy * (rest - first)


def read(path):
    with open(path, encoding="ascii") as file:
        words = file.read().split()
    length, radius, steps, wanted = float(words[1]), float(words[2]), int(words[3]), words[4]
    numbers = words[5:]
    discs = [
        Disc(int(numbers[i]), *(float(word) for word in numbers[i + 1 : i + 5]))
        for i in range(0, len(numbers), 5)
    ]
    return length, radius, steps, wanted, sorted(discs, key=lambda disc: disc.id)


def main():
    length, radius, steps, wanted, discs = read(sys.argv[1])
    mistake = sys.argv[2] if len(sys.argv) > 2 else ""
    digits = sys.argv[3] if len(sys.argv) > 3 else ".8f"
    box = Box(length, radius, discs, mistake)
    for step in range(steps + 1):
        if mistake == "single":
            for disc in discs:
                disc.x, disc.y, disc.vx, disc.vy = map(
                    as_float, (disc.x, disc.y, disc.vx, disc.vy)
                )
        if step > 0:
            (box.step_all if mistake == "many" else box.step)()
        if wanted == "perf" and 0 < step < steps:
            continue
        order = sorted(discs, key=lambda disc: -disc.id) if mistake == "unsorted" else discs
        if mistake == "short" and step == steps:
            order = order[:-1]
        for disc in order:
            numbers = (format(number, digits) for number in (disc.x, disc.y, disc.vx, disc.vy))
            counters = (
                f" {disc.pairs} {disc.walls}"
                if step == steps > 0 and mistake != "no-counters"
                else ""
            )
            print(step, disc.id, *numbers, sep=" ", end=counters + "\n")


if __name__ == "__main__":
    if sys.argv[1] == "--mistakes":
        for name, rule in MISTAKES.items():
            print(name, rule)
    elif sys.argv[1] == "--scene":  # N SPEED STEPS SEED: discs at random that may overlap
        n_discs, speed, n_steps, seed = (
            int(sys.argv[2]),
            float(sys.argv[3]),
            int(sys.argv[4]),
            int(sys.argv[5]),
        )
        chance = random.Random(seed)
        print(n_discs, 16, 0.5, n_steps, "print", sep="\n")
        for number in range(n_discs):
            x, y = chance.uniform(0.5, 15.5), chance.uniform(0.5, 15.5)
            print(number, x, y, chance.uniform(-speed, speed), chance.uniform(-speed, speed))
    else:
        main()
