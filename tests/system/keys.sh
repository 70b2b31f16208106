#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The committed reference of keys is what the program prints; what it prints names every key once.
source "$CARROM_SOURCE_DIR/tests/system/common.sh"

page=$CARROM_SOURCE_DIR/docs/reference/keys.md
run 1 keys
expect_code 0 'carrom keys'
diff "$page" "$test_folder/out" || complain "docs/reference/keys.md is not what 'carrom keys' prints: write it anew"
run 3 keys --conflicts
expect_code 0 'carrom keys --conflicts'
while IFS= read -r line; do
    grep -qxF -- "$line" "$page" || complain "a line of 'carrom keys --conflicts' is not in the page: $line"
done <"$test_folder/out"
finish
