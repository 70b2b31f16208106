#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The generated pages of the reference are what the program prints.
source "$CARROM_SOURCE_DIR/tests/system/common.sh"

reference=$CARROM_SOURCE_DIR/docs/reference
# expect_page NAME RANKS WORD...
expect_page() {
    local name=$1 ranks=$2
    shift 2
    run "$ranks" "$@"
    expect_code 0 "carrom $*"
    diff "$reference/$name.md" "$test_folder/out" ||
        complain "docs/reference/$name.md is not what 'carrom $*' prints: write it anew"
}
expect_page keys 1 keys
expect_page conflicts 3 keys --conflicts

bash "$CARROM_SOURCE_DIR/docs/tools/command_line.sh" "$CARROM_PROGRAM" >"$test_folder/out"
diff "$reference/command-line.md" "$test_folder/out" ||
    complain "docs/reference/command-line.md is not what docs/tools/command_line.sh prints"
finish
