#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compare docs/understanding/threads.md with the code.

    threads.py SOURCE_FOLDER

prints each source file that orders threads by itself and that the page does not name, and each
file that the page names although it does no such thing. It exits with 1 if there is one. So nobody
adds an atomic without giving the reason for its memory order.
"""
import re
import sys
from pathlib import Path

ORDERS_THREADS = re.compile(
    r"std::(atomic\w*|memory_order\w*|(?:\w+_)?mutex|condition_variable\w*|latch|barrier"
    r"|\w*semaphore|jthread|thread(?!::)|async|call_once)\b"
    r"|\bvolatile\b|\bthread_local\b"
    r"|#pragma omp (atomic|flush|critical|barrier|single|master|masked|task|ordered)"
    r"|\b(__atomic|__sync)_|\bomp_\w*lock\b|\bpthread_|\bMPI_Win_")
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
PAGE = "docs/understanding/threads.md"


def main():
    top = Path(sys.argv[1])
    sources = {path.relative_to(top).as_posix()
               for folder in ("src", "include") for path in (top / folder).rglob("*")
               if path.suffix in (".hpp", ".cpp", ".h", ".c")}
    in_code = {name for name in sources
               if ORDERS_THREADS.search(COMMENT.sub("", (top / name).read_text(encoding="utf-8")))}
    on_page = set(re.findall(r"`((?:src|include)/[^`]+)`",
                             (top / PAGE).read_text(encoding="utf-8")))
    if not in_code:
        sys.exit("no file of the source orders threads: this is no check")
    for name in sorted(in_code - on_page):
        print(f"{name} orders threads, and {PAGE} does not say how")
    for name in sorted(on_page - in_code):
        print(f"{PAGE} names {name}, which does not order threads")
    sys.exit(in_code != on_page)


main()
