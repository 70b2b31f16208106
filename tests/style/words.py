#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Check that sentences of pages can be read at once, as docs/contributing.md promises.

    words.py SOURCE_FOLDER [--each]

The pages are README.md and those that mkdocs.yml shows. Pages that a command prints do not count,
nor parts between the markers `<!-- NAME -->` and `<!-- end of NAME -->`, which commands write.

How it counts: Blocks of code and formulas, comments, headings and targets of links are left out. A
piece of code in a line is one word. The text falls into sentences; so does each table cell of more
than six words. Sentences of at least three words are counted. A word has a letter or a digit.
"""
import re
import sys
from pathlib import Path

MEDIAN, NINETIETH, LONGEST = 16, 25, 40  # words of a sentence, on each page
GENERATED = {"docs/reference/keys.md", "docs/reference/conflicts.md",
             "docs/reference/command-line.md"}

END_OF_SENTENCE = re.compile(r'(?<=[.!?:;])\s+(?=[A-Z"(`])')
LIST_ITEM = re.compile(r"^(?:[-*]|\d+\.) ")


def pages(top):
    shown = re.findall(r"^ +- [^:\n]+: (\S+\.md)$", (top / "mkdocs.yml").read_text(), re.M)
    names = {"README.md", *(f"docs/{name}" for name in shown)} - GENERATED
    return sorted(name for name in names if (top / name).exists())  # notebooks become pages later


def readable(text):
    """The page without what is not read as text; lines keep their numbers."""
    def blank(match):
        return "\n" * match.group().count("\n")
    text = re.sub(r"^ *```.*?^ *```", blank, text, flags=re.M | re.S)
    text = re.sub(r"<!-- ([\w ]+) -->.*?<!-- end of \1 -->", blank, text, flags=re.S)
    text = re.sub(r"<!--.*?-->", blank, text, flags=re.S)
    text = re.sub(r"^#.*", "", text, flags=re.M)
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text)
    return re.sub(r"`[^`]*`", "X", text).replace("**", "")


def paragraphs(text):
    """(line, text) of each paragraph, item of a list and cell of a table, and whether it is one."""
    start, lines = 1, []
    for number, line in enumerate([*text.splitlines(), ""], 1):
        line = line.strip()
        is_row = line.startswith("|")
        if lines and (not line or is_row or LIST_ITEM.match(line)):
            yield start, " ".join(lines), False
            lines = []
        if is_row:
            yield from ((number, cell, True) for cell in line.strip("|").split("|"))
        elif line:
            start = start if lines else number
            lines.append(LIST_ITEM.sub("", line))


def n_words(text):
    return sum(any(letter.isalnum() for letter in word) for word in text.split())


def sentences(piece, is_cell):
    """The words of each sentence that counts, and its text."""
    if is_cell and len(piece.split()) <= 6:
        return
    for sentence in END_OF_SENTENCE.split(piece.strip()):
        if n_words(sentence) >= 3:
            yield n_words(sentence), sentence


def share(lengths, part):
    return sorted(lengths)[int(part * (len(lengths) - 1))]


def main(top, show_each):
    findings, lengths = [], []
    names = pages(top)
    for name in names:
        own = []
        text = readable((top / name).read_text(encoding="utf-8"))
        for number, piece, is_cell in paragraphs(text):
            for words, sentence in sentences(piece, is_cell):
                own.append(words)
                if words > LONGEST:
                    findings.append(f"{name}:{number}: {words} words: {sentence}")
        if show_each:
            print(f"{sum(own):6} words, {len(own):4} sentences: {name}")
        if share(own, 0.5) > MEDIAN or share(own, 0.9) > NINETIETH:
            findings.append(f"{name}: its sentences have {share(own, 0.5)} words in the median and "
                            f"{share(own, 0.9)} at the ninetieth percentile")
        lengths += own
    if len(names) < 30 or len(lengths) < 1000:
        findings.append(f"only {len(names)} pages, {len(lengths)} sentences found: a wrong folder?")
    print(*findings, sep="\n")
    print(f"{len(names)} pages, {sum(lengths)} words in {len(lengths)} sentences; median "
          f"{share(lengths, 0.5)}, ninetieth percentile {share(lengths, 0.9)}, longest "
          f"{max(lengths)}; limits {MEDIAN}, {NINETIETH}, {LONGEST}")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), "--each" in sys.argv[2:]))
