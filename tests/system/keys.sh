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

# Every key of a report, and every line of a summary, is on the page that explains them.
run 2 run "$CARROM_SOURCE_DIR/inputs/rough.toml" --steps 2 --set effects.gravity.y=-0.001 \
    --set 'output.measurements.quantities=["velocities"]' -o run
expect_code 0 'a run'
n_keys=0
while read -r key; do
    n_keys=$((n_keys + 1))
    grep -qF -- "\`$key\`" "$reference/report.md" || complain "docs/reference/report.md lacks $key"
done < <(sed -n 's/^  "\([a-z_]*\)":.*/\1/p; s/^    "\([a-z_]*\)": {$/\1/p' run/report.json |
    grep -v '^speeds$\|^velocities$'
    sed -n 's/^\([a-z ]\{11\}\) [^ ].*/\1/p' "$test_folder/err" | sed 's/ *$//')
[ "$n_keys" -gt 40 ] || complain "only $n_keys names were looked for"
finish
