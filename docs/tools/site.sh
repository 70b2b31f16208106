#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Build the site of docs/ with MkDocs. A dead link or a missing page is an error.
#
#   docs/tools/site.sh [FOLDER]     default: build/site; then open FOLDER/index.html
#
# MkDocs comes from PyPI into a virtual environment beside FOLDER, once. Code 77: it cannot be had.
set -euo pipefail

case ${1:-} in -*) sed -n '3,7s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2 ;; esac
top=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
site=${1:-$top/build/site}
python=$site-python
requirements=$top/docs/tools/site_requirements.txt

mkdir -p "$(dirname "$site")"
if ! cmp -s "$requirements" "$python/requirements.txt"; then
    python3 -m venv --clear "$python" >&2 &&
        timeout 300 "$python/bin/pip" install --quiet --disable-pip-version-check \
            --retries 1 --timeout 10 -r "$requirements" >&2 ||
        { echo 'skipped: MkDocs is not to be had from PyPI'; exit 77; }
    cp "$requirements" "$python/requirements.txt"
fi
export NO_MKDOCS_2_WARNING=1
"$python/bin/mkdocs" build --strict --config-file "$top/mkdocs.yml" --site-dir "$(realpath -m "$site")"
