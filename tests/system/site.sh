#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The site builds in strict mode, and strict mode finds a dead link. Argument: the site's folder.
source "$CARROM_SOURCE_DIR/tests/system/common.sh"

bash "$CARROM_SOURCE_DIR/docs/tools/site.sh" "$1" >"$test_folder/out" 2>"$test_folder/err"
code=$?
if [ "$code" -eq 77 ]; then
    cat "$test_folder/out"
    exit 77
fi
expect_code 0 'the site'
[ -s "$1/index.html" ] || complain 'there is no index.html'
# Pages opened as files, without a network, have to find everything beside them.
grep -rqE '<(script|link|img)[^>]* (src|href)="https?://' --include='*.html' "$1" &&
    complain 'a page loads something from another server'

mkdir copy
cp -r "$CARROM_SOURCE_DIR/docs" "$CARROM_SOURCE_DIR/mkdocs.yml" copy
printf '\n[nothing](nowhere.md)\n' >>copy/docs/index.md
bash copy/docs/tools/site.sh "$1" >"$test_folder/out" 2>"$test_folder/err"
code=$?
expect_code 1 'a site with a dead link'
expect_told nowhere.md 'a dead link'
finish
