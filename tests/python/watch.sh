#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The page of `python -m carrom.watch`: what its server answers, and what a real Chromium shows of
# it. numpy and h5py are the system's or come from PyPI. Argument: a folder for a Python
# environment, which is kept.
source "$CARROM_SOURCE_DIR/tests/system/common.sh"
skip() {
    printf 'skipped: %s\n' "$*"
    exit 77
}
has_all() { PYTHONPATH=$CARROM_SOURCE_DIR/src/python "$1" -B -c 'import carrom' 2>/dev/null; }

python=python3
command -v python3 >/dev/null || skip 'there is no python3'
if ! has_all python3; then
    python=$1/bin/python
    [ -x "$python" ] || python3 -m venv "$1" >"$test_folder/err" 2>&1 ||
        skip "no Python environment: $(tail -n 1 "$test_folder/err")"
    has_all "$python" || timeout 200 "$python" -m pip install \
        --quiet --disable-pip-version-check --only-binary :all: \
        numpy h5py tomli >"$test_folder/err" 2>&1 ||
            skip "numpy and h5py are not to be had: $(tail -n 1 "$test_folder/err")"
    has_all "$python" || skip 'Python is older than 3.9'
fi
export PYTHONPATH=$CARROM_SOURCE_DIR/src/python PYTHONDONTWRITEBYTECODE=1
for test in watch_test watch_hostile_test watch_browser_test; do
    "$python" "$CARROM_SOURCE_DIR/tests/python/$test.py" -v || complain "$test"
done
finish
