#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Checks that all C++ is formatted as .clang-format defines, by the version of clang-format that it
# names. Argument: a folder for a Python environment, where that version comes from PyPI and is
# kept.
#
#   bash tests/style/format.sh FOLDER           print what differs; exit code 1 if anything does
#   bash tests/style/format.sh FOLDER --mend    format it
set -euo pipefail
source "$(dirname "$0")/python_tools.sh"
top=$(cd "$(dirname "$0")/../.." && pwd)
version=$(sed -n 's/.*clang-format==\([0-9.]*\).*/\1/p' "$top/.clang-format")
get_tool "$1" clang-format "$version"

mapfile -t files < <(find "$top/src" "$top/include" "$top/tests" \
    -name '*.[ch]pp' -o -name '*.[ch]' | sort)
[ ${#files[@]} -ge 400 ] || { echo "only ${#files[@]} files found: a wrong folder?"; exit 1; }
words=(--dry-run --Werror)
[ "${2:-}" != --mend ] || words=(-i)
"$tool" "${words[@]}" "${files[@]}" || {
    echo "try: bash tests/style/format.sh $1 --mend"
    exit 1
}
echo "${#files[@]} files, clang-format $version"
