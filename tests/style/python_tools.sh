# SPDX-License-Identifier: BSD-3-Clause
# Tools that come from PyPI into an environment in the build folder. To be sourced.

# get_tool FOLDER NAME VERSION [PACKAGE==VERSION]: sets `tool`; the package is named where it has
# another name than the tool. If it cannot be installed, the test ends as skipped (77).
get_tool() {
    tool=$1/bin/$2
    "$tool" --version 2>/dev/null | grep -qF "$3" && return
    { [ -x "$1/bin/python" ] || python3 -m venv "$1"; } >"$1.log" 2>&1 &&
        timeout 200 "$1/bin/python" -m pip install --quiet --disable-pip-version-check \
            --only-binary :all: --retries 1 --timeout 10 "${4:-$2==$3}" >>"$1.log" 2>&1 && return
    printf 'skipped: no %s %s: %s\n' "$2" "$3" "$(tail -n 1 "$1.log")"
    exit 77
}
