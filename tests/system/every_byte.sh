#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Each page and each bit of a run's files damaged (every_byte.py). Argument: sample or all.
source "$(dirname "$0")/common.sh"
python3 "$(dirname "$0")/every_byte.py" "$CARROM_PROGRAM" "$CARROM_SOURCE_DIR/inputs/gas.toml" \
    "$1" "$test_folder/trials.csv" || complain 'damage was not found'
finish
