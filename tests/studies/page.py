#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Put what has been measured into docs/understanding/performance.md: tables between its markers,
pictures beside its CSV files.

  tests/studies/page.py [--folder docs/data/performance] [--page docs/understanding/performance.md]

Reads rates.csv and sizes.csv (compare.py), cluster.csv (simulate.py --study), large_cluster.csv
(cluster_model.py --study), effects.csv (effects.py), kernels.json (carrom_benchmarks) and peaks.txt
(machine_peaks); measure_all.sh writes all but sizes.csv and effects.csv. Other machines' rates, as
rates_xeon.csv, are further rows of the tables. A part whose file is missing keeps what it says.
Words around the markers are the page's own. Needs the Python environment of docs/tools/README.md.
"""

import argparse
import csv
import json
import pathlib
import re
import sys

import page_pictures

def read_csv(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def table(heading, rows):
    return "\n".join(
        ["| " + " | ".join(heading) + " |", "|" + "---|" * len(heading)]
        + ["| " + " | ".join(row) + " |" for row in rows]
    )


def short(value, digits=3):
    return f"{float(value):.{digits}g}" if value not in ("", None) else ""


def rate_text(row):
    value = float(row["rate"])
    return f"{value / 1e6:.3g}" if value > 0 else ""


PEERS = (("LAMMPS", "over_lammps", 3), ("stream", "over_stream", 2))
WAYS = ("threads", "ranks")  # ways to use two cores


def processor_of(rows):
    """With its vectors, where they are known, and Carrom's version."""
    first = rows[0]
    vectors = re.search(r"vectors (\w+)", first["compiler"])
    words = [re.sub(r", \d+ cores$", "", first["machine"]), vectors and vectors.group(1)]
    return ", ".join([*filter(None, words), first["version"]])


def by_processor(files, cell, name):
    """A row for each file, which is of one processor, and a column for each case. `cell(row)` is
    the text of a case, and `name(case)` that of its column.
    """
    cases = list(dict.fromkeys(r["case"] for rows in files for r in rows))
    found = [{r["case"]: cell(r) for r in rows} for rows in files]
    return table(
        ["processor", *map(name, cases)],
        [
            [processor_of(rows), *(texts.get(case, "") for case in cases)]
            for rows, texts in zip(files, found)
        ],
    )


def is_of_one_core(row):
    return row["ranks"] == row["threads"] == "1" and "generated" not in row["case"]


def name_of(case):
    return case.replace("all, ", "event-driven, ")


def edmd_part(files):
    """A table for each packing fraction, whose columns are numbers of discs."""
    beside = [[r for r in rows if r.get("over_edmd")] for rows in files]
    packings = dict.fromkeys(r["case"].rsplit(", ", 1)[0] for rows in beside for r in rows)
    parts = []
    for packing in packings:
        chosen = [[r for r in rows if r["case"].startswith(packing)] for rows in beside]
        body = by_processor(
            [rows for rows in chosen if rows],
            lambda r: f"{short(r['over_edmd'])} ({rate_text(r)})",
            lambda case: case.rsplit(", ", 1)[1],
        )
        parts.append(body.replace("processor", packing, 1))
    return "\n\n".join(parts)


def sizes_part(rows):
    """Mixtures with their rate, its share of equal discs' and how it stands to EDMD."""
    rate = {r["case"]: float(r["rate"]) for r in rows}

    def share(row):
        return rate[row["case"]] / rate[f"sizes 1 and 1, {row['case'].split(', ')[1]}"]

    return table(
        ["case", "million collisions per second", "share of equal discs' rate", "x EDMD"],
        [
            [r["case"], rate_text(r), f"{share(r):.2f}", short(r.get("over_edmd"))]
            for r in rows
            if r["case"].startswith("sizes")
        ],
    )


def two_cores_part(files):
    def gains(rows):
        rate = {r["case"]: float(r["rate"]) for r in rows}
        return [
            r | {"gain": [rate[f"{r['case']}, 2 {word}"] / rate[r["case"]] for word in WAYS]}
            for r in rows
            if all(f"{r['case']}, 2 {word}" in rate for word in WAYS)
        ]

    found = [gains(rows) for rows in files]
    return by_processor(
        [rows for rows in found if rows],
        lambda r: " / ".join(f"{g:.2f}" for g in r["gain"]),
        name_of,
    )


def spread_text(row):
    least, most = (short(float(row[name]) / 1e6) for name in ("least", "most"))
    return f"{rate_text(row)} ({least} to {most})"


def rates_part(files):
    """A table of rates, and one for each peer."""
    parts = [by_processor(files, spread_text, lambda case: case_with_unit(case, files))]
    for peer, column, digits in PEERS:
        beside = [[r for r in rows if r.get(column)] for rows in files]
        body = by_processor(
            [rows for rows in beside if rows],
            lambda r, column=column, digits=digits: short(r[column], digits),
            name_of,
        )
        parts.append(body.replace("processor", f"rate over that of {peer}", 1))
    compilers = {rows[0]["compiler"].split(", vectors")[0] for rows in files}
    rounds = [min(int(r["rounds"]) for r in rows) for rows in files]
    parts.append(
        f"Medians of {min(rounds)} to {max(rounds)} rounds, with the least and the most; compiled"
        f" by {' and '.join(sorted(compilers))}."
    )
    return "\n\n".join(parts)


def case_with_unit(case, files):
    units = {r["case"]: r["unit"] for rows in files for r in rows}
    return f"{name_of(case)}, {units[case]}"


def cluster_part(rows):
    """Efficiency by case and ranks; cluster.csv has the rest."""
    ranks = sorted({int(r["ranks"]) for r in rows})
    cases = {}
    for r in rows:
        cases.setdefault(r["case"], {})[int(r["ranks"])] = f"{float(r['efficiency']):.3f}"
    return table(
        ["efficiency, by ranks", *map(str, ranks)],
        [[case, *(found.get(n, "") for n in ranks)] for case, found in cases.items()],
    )


def range_text(values):
    low, high = (f"{value:.2f}" for value in (min(values), max(values)))
    return low if low == high else f"{low} to {high}"


def effects_part(rows):
    """What an effect costs by instructions and by the clock, over all packing fractions."""
    cases = {}
    for r in rows:
        cases.setdefault((r["effect"], r["method"], r["discs"]), []).append(r)
    return table(
        ["effect", "method", "discs", "instructions", "time"],
        [
            [
                *case,
                *(
                    range_text([float(r[column]) for r in found])
                    for column in ("instructions_ratio", "time_ratio")
                ),
            ]
            for case, found in cases.items()
        ],
    )


def read_kernels(path):
    with open(path, encoding="utf-8") as file:
        found = json.load(file)["benchmarks"]
    return [
        b for b in found if b.get("run_type") != "aggregate" or b.get("aggregate_name") == "median"
    ]


def read_peaks(path):
    return {
        name: float(value)
        for name, value in (line.split() for line in path.read_text(encoding="utf-8").splitlines())
    }


def kernels_part(peaks):
    return (
        f"The machine's peaks on one core are {peaks['double']:.3g} x 10^9 operations a second in"
        f" double precision and {peaks['single']:.3g} x 10^9 in single. A stream in place moves"
        f" {peaks['stream_memory']:.3g} GB/s from memory and {peaks['stream_cache']:.3g} GB/s in"
        " the second level of cache, read and written bytes."
    )


def replace_part(text, name, part):
    begin, end = f"<!-- {name} -->", f"<!-- end of {name} -->"
    if begin not in text or end not in text:
        sys.exit(f"the page has no markers '{begin}' and '{end}'")
    return text[: text.index(begin) + len(begin)] + "\n" + part + "\n" + text[text.index(end) :]


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--folder", type=pathlib.Path, default="docs/data/performance")
    parser.add_argument(
        "--page", type=pathlib.Path, default=pathlib.Path("docs/understanding/performance.md")
    )
    options = parser.parse_args()
    page_pictures.plot_style.use()
    folder, text = options.folder, options.page.read_text(encoding="utf-8")
    if (folder / "rates.csv").exists():
        rows = read_csv(folder / "rates.csv")
        files = [rows, *(read_csv(path) for path in sorted(folder.glob("rates_*.csv")))]
        one_core = [
            [r for r in found if not r.get("over_edmd") and is_of_one_core(r)] for found in files
        ]
        text = replace_part(text, "rates", rates_part([found for found in one_core if found]))
        text = replace_part(text, "two cores", two_cores_part(files))
        text = replace_part(text, "edmd", edmd_part(files))
        page_pictures.draw_numbers(rows, folder)
    if (folder / "effects.csv").exists():
        text = replace_part(text, "effects", effects_part(read_csv(folder / "effects.csv")))
    if (folder / "sizes.csv").exists():
        rows = read_csv(folder / "sizes.csv")
        text = replace_part(text, "sizes", sizes_part(rows))
        page_pictures.draw_sizes(rows, folder)
    if (folder / "cluster.csv").exists():
        rows = read_csv(folder / "cluster.csv")
        text = replace_part(text, "cluster", cluster_part(rows))
        page_pictures.draw_cluster(rows, folder)
    if (folder / "large_cluster.csv").exists():
        rows = read_csv(folder / "large_cluster.csv")
        text = replace_part(text, "large cluster", cluster_part(rows))
        page_pictures.draw_large_cluster(rows, folder)
    if (folder / "kernels.json").exists() and (folder / "peaks.txt").exists():
        kernels, peaks = read_kernels(folder / "kernels.json"), read_peaks(folder / "peaks.txt")
        text = replace_part(text, "kernels", kernels_part(peaks))
        page_pictures.draw_roofline(kernels, peaks, folder)
    options.page.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
