#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Both precisions, both formulas, contracted and not, under both methods: each combination has its
# own bits, which are the same for other ranks, threads and windows.
source "$(dirname "$0")/common.sh"

# scene NAME DISCS PACKING SPEED
scene() {
    cat >"$1.toml" <<END
[box]
size = 50
[discs]
count = $2
packing = $3
speed = $4
generator = "lattice"
[time]
steps = 64
END
}
scene dense 500 0.7 0.3
scene fast 300 0.02 40

arithmetics=("double naive" "double naive --set time.contraction=true"
    "single stable" "single naive" "single naive --set time.contraction=true")
: >hashes
for name in dense fast; do
    for method in time-stepped event-driven; do
        for arithmetic in "${arithmetics[@]}"; do
            words=(run "$name.toml" --set "time.method=$method" \
                --set "time.precision=${arithmetic%% *}" \
                --set "time.arithmetic=${arithmetic#* }")
            read -r -a words <<<"${words[*]}"
            hash=
            for shape in '1 1' '2 2 --window 0.3 --rebalance-every 1 --rebalance-above 0'; do
                read -r ranks threads options <<<"$shape"
                run "$ranks" "${words[@]}" --threads "$threads" $options --report report.json \
                    --quiet
                expect_code 0 "$name, $method, $arithmetic, $shape"
                hash=${hash:-$(json_value report.json state_hash)}
                [ "$(json_value report.json state_hash)" = "$hash" ] ||
                    complain "another state hash: $name, $method, $arithmetic, $shape"
            done
            echo "$hash" >>hashes
        done
    done
done
[ "$(sort -u hashes | wc -l)" -eq 20 ] || complain \
    "some settings have the same bits: $(sort hashes | uniq -d | wc -l)"
finish
