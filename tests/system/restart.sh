#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A run that is stopped, killed in between and continued on other numbers of ranks and threads has
# the bits of the uninterrupted run. Arguments: "all" restarts, or "few" (those that continue
# averages), the input, and options that make it small; it must run 90 steps.
source "$(dirname "$0")/common.sh"
restarts=$1 input=$CARROM_SOURCE_DIR/$2
shift 2
small=("$@" --quiet)
store=(--set output.folder=kept --set output.checkpoint.every_steps=17)

hash_of_report() { json_value report.json state_hash; }
has_hash() {
    expect_code 0 "$1"
    [ "$(hash_of_report)" = "$hash" ] || complain "another state hash: $1"
}

run 2 run "$input" "${small[@]}" --report report.json --set output.text=ends
expect_code 0 'uninterrupted'
hash=$(hash_of_report)
tail -n 20 "$test_folder/out" >"$test_folder/end"
[ -n "$hash" ] || complain 'no state hash'

# Stretches of 30 steps, each on another machine shape. The last lines of text must be the same too.
run 1 run "$input" "${small[@]}" "${store[@]}" --steps 30 --threads 2
expect_code 0 'the first stretch'
run 4 run "$input" "${small[@]}" "${store[@]}" --restart latest --steps 60
expect_code 0 'the second stretch'
run 3 run "$input" "${small[@]}" "${store[@]}" --restart latest --report report.json --threads 2 \
    --set output.text=ends
has_hash '1 rank, then 4, then 3'
tail -n 20 "$test_folder/out" | cmp - "$test_folder/end" || complain 'other lines at the end'
[ "$(json_value report.json first_step)" = 60 ] ||
    complain 'the third stretch did not begin at step 60'
[ "$(ls kept/checkpoints)" = "$(printf 'checkpoint-%012d.h5\n' 85 90)" ] ||
    complain "not the last two checkpoints: $(ls kept/checkpoints)"

# Averages continue, too, with their errors: the report has those of the uninterrupted run. (Lost
# collisions are those of the steps since the restart.)
averages() {
    sed -n '/^  "averages"/,/^  }/p; /^  "temperature"/,/^  "lost_collisions"/p' report.json
}
run 2 run "$input" "${small[@]}" "${store[@]}" --set output.folder=long \
    --set output.checkpoint.keep=9 --report report.json
has_hash 'with checkpoints'
averages >averages_of_all
[ "$(wc -l <averages_of_all)" -gt 25 ] || complain 'no averages in the report'
for shape in '17 1 2' '51 3 1' '85 4 1'; do
    read -r step ranks threads <<<"$shape"
    run "$ranks" run --restart "$(printf 'long/checkpoints/checkpoint-%012d.h5' "$step")" \
        --report report.json --quiet --threads "$threads" --set output.folder=again"$step"
    has_hash "from step $step with averages"
    averages | cmp - averages_of_all || complain "other averages from step $step on $ranks ranks"
done
[ "$restarts" = all ] || finish

# From a checkpoint in the middle of a sync interval, without naming the scene again, and on more
# ranks.
for ranks in 1 7; do
    run "$ranks" run --restart kept/checkpoints/checkpoint-000000000085.h5 --report report.json \
        --quiet --set output.folder=other
    has_hash "from step 85 on $ranks ranks"
done

# At the end there is nothing to do, and more steps can be requested.
run 1 run --restart kept --report report.json --quiet
has_hash 'nothing left to do'
[ "$(json_value report.json steps)" = 0 ] || complain 'steps were made after the last'
run 2 run "$input" "${small[@]}" --steps 97 --report report.json
expect_code 0 'uninterrupted and longer'
hash=$(hash_of_report)
run 3 run --restart kept --steps 97 --report report.json --quiet
has_hash 'longer than first asked for'

# A restart that is impossible is an error with its reason.
refused() {
    local text=$1
    shift
    run 3 run "$@" --report refused.json
    expect_code 2 "$*"
    expect_told "$text" "$*"
    [ ! -e refused.json ] || complain "a report of a run that was refused: $*"
}
refused "'box.size' is" "$input" "${small[@]}" --set box.size=3333 --restart kept
refused "'time.sync_every' is" --restart kept/checkpoints/checkpoint-000000000097.h5 \
    --set time.sync_every=3
refused 'the run is to end at step 50' --restart kept/checkpoints/checkpoint-000000000097.h5 \
    --steps 50
refused 'No such file' --restart kept/none.h5
refused 'name the folder of the run with -o' --restart latest
refused 'name output.folder or -o' "$input" "${small[@]}" --restart latest
refused 'no checkpoint there can be gone on from' "$input" "${small[@]}" --set time.sync_every=3 \
    --restart kept
mkdir empty
refused 'there is no checkpoint' --restart empty

# Without checkpoints in the folder the run begins at step 0. Damaged files are skipped, and the
# reason is printed.
run 2 run "$input" "${small[@]}" -o empty --steps 97 --restart latest --report report.json
has_hash 'from an empty folder'
expect_told 'no checkpoint in empty/checkpoints: beginning at step 0' 'from an empty folder'
newest=kept/checkpoints/checkpoint-000000000097.h5
printf 'X' | dd of="$newest" bs=1 seek=9000 conv=notrunc status=none
head -c 5000 kept/checkpoints/checkpoint-000000000090.h5 \
    >kept/checkpoints/checkpoint-000000000098.h5
echo 'no checkpoint' >kept/checkpoints/checkpoint-000000000099.h5
: >kept/checkpoints/checkpoint-000000000100.h5.partial # left by a killed run
run 3 run "$input" "${small[@]}" --steps 97 --restart kept --report report.json
has_hash 'from the newest whole one'
[ "$(json_value report.json first_step)" = 90 ] || complain 'not from step 90'
for reason in '000000000097.h5: is damaged' '000000000098.h5: is cut short' \
    '000000000099.h5: is no HDF5 file'; do
    expect_told "$reason" 'damaged files'
done
finish
