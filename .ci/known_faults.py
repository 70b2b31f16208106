#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tell a known fault of Open MPI from a fault of ours.

    known_faults.py BUILD

exits with 0 if each test that the last run of ctest in BUILD has seen fail shows the fault below,
so that running these tests once more hides nothing. Else it names the others, and exits with 1.

Open MPI 4 now and then takes the end of a rank that has finalized for a failure, on busy machines
(its issues 7833 and 9389). It then says that a process is "exiting improperly" although the test
has ended well. Nothing else is tried again: in a code that promises the same bits a second try
could hide a race.
"""
import re
import sys
from pathlib import Path

SIGNATURE = b"exiting improperly"


def sections(log):
    """(name, bytes) of each test in ctest's log."""
    parts = re.split(rb"^\d+/\d+ Testing: (.*)$", log, flags=re.MULTILINE)
    return zip(parts[1::2], parts[2::2])


def shows_fault(section):
    """Whether a test's output, or a file that it has written in its own folder, has the message.
    The folders of system tests, below a folder `run`, are each a test's own."""
    if SIGNATURE in section:
        return True
    match = re.search(rb"^Directory: (.*)$", section, re.MULTILINE)
    folder = Path(match.group(1).decode()) if match else Path()
    if folder.parent.name != "run":
        return False
    return any(SIGNATURE in path.read_bytes() for path in folder.rglob("*")
               if path.is_file() and path.stat().st_size < 1 << 20)


def main():
    folder = Path(sys.argv[1]) / "Testing" / "Temporary"
    failed = [line.split(b":", 1)[1]
              for line in (folder / "LastTestsFailed.log").read_bytes().splitlines()]
    found = dict(sections((folder / "LastTest.log").read_bytes()))
    ours = [name for name in failed if not shows_fault(found.get(name, b""))]
    for name in ours:
        print(f"{name.decode()}: failed, without a sign of a known fault of Open MPI")
    return 1 if ours or not failed else 0


sys.exit(main())
