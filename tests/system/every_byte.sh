#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Damages each page and each bit of a run's files (every_byte.py). Arguments: the tool that tests
# many bits in one process, the folder of Python environments, which share of the damage. The Python
# package is tested, too, if another test has made its environment.
source "$(dirname "$0")/common.sh"
python=$2/package/bin/python
"$python" -c 'import h5py, numpy' 2>/dev/null || python=python3
CARROM=$CARROM_PROGRAM PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$CARROM_SOURCE_DIR/src/python \
    "$python" "$(dirname "$0")/every_byte.py" "$CARROM_PROGRAM" "$1" \
    "$3" "$test_folder/trials.csv" ||
    complain 'damage was not found'
finish
