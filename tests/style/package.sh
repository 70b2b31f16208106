#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Checks the Python package, built as a wheel and as an archive of the source, with `twine check
# --strict` and check-wheel-contents. The wheel with the program has a test of its own,
# python_wheel. Argument: a folder for a Python environment, where the tools come from PyPI.
set -euo pipefail
source "$(dirname "$0")/python_tools.sh"
package=$(cd "$(dirname "$0")/../../src/python" && pwd)
get_tool "$1" twine 7.0.0
get_tool "$1" check-wheel-contents 0.6.3
get_tool "$1" pyproject-build 1.6.1 build==1.6.1

# The build writes beside the sources, so it uses a copy.
rm -rf copy dist
mkdir copy
tar -C "$package" -h --exclude=__pycache__ --exclude=build --exclude='*.egg-info' -cf - . |
    tar -C copy -xf -
timeout 300 "$1/bin/pyproject-build" -o dist copy >log 2>&1 || {
    grep -q 'ould not find a version\|No matching distribution\|ConnectionError' log &&
        { echo "skipped: no setuptools: $(tail -n 1 log)"; exit 77; }
    tail -n 5 log
    exit 1
}
for file in dist/carrom-*.tar.gz dist/carrom-*.whl; do
    case $file in *.whl) python3 -m zipfile -l "$file" ;; *) tar -tf "$file" ;; esac >files
    grep -q '/LICENSE\b' files || { echo "no LICENSE in $file"; exit 1; }
done
"$1/bin/twine" check --strict dist/*
"$1/bin/check-wheel-contents" dist/*.whl
