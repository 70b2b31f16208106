#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# carrom info, verify, convert and diff on the files of a small run, against the lines that the run
# itself has written.
source "$(dirname "$0")/common.sh"
scene=("$CARROM_SOURCE_DIR/inputs/gas.toml" --set discs.count=300 --set discs.speed=2 \
    --quiet --steps 20)

run 2 run "${scene[@]}" --set output.text=every_step --output lines --report report.json -o kept \
    --set output.checkpoint.every_steps=10 --set output.trajectory.precision=double \
        --set output.collisions=true
expect_code 0 'a run'
last=kept/checkpoints/checkpoint-000000000020.h5 first=kept/checkpoints/checkpoint-000000000010.h5
shown() { # FILE OPTION...: what convert writes, in `out`
    run 2 convert "$@"
    expect_code 0 "convert $*"
}

run 3 info "$last"
expect_code 0 'info'
for text in 'kind        checkpoint' '300 discs' 'step        20' \
    "$(json_value report.json state_hash)"; do
    grep -qF "${text/300 discs/300 in a box}" "$test_folder/out" ||
        complain "info does not say: $text"
done

run 1 info kept/trajectory.h5
for text in 'discs       300 in a box of' 'fields      position velocity' 'numbers     of 8 bytes' \
    'frames      21, of steps 0 to 20, every 1'; do
    grep -qF "$text" "$test_folder/out" || complain "info of a trajectory does not say: $text"
done
run 1 info kept/collisions.h5
grep -q '^steps       1 to 20, times 0[.][0-9]* to 1[89][.]' "$test_folder/out" ||
    complain "info of a log does not tell its span: $(cat "$test_folder/out")"

shown "$last" --to text
tail -n 300 lines | cmp - "$test_folder/out" ||
    complain 'the last lines are not those of the checkpoint'
shown kept/trajectory.h5 --to text
cut -d' ' -f1-6 lines | cmp - "$test_folder/out" ||
    complain 'the lines are not those of the trajectory'
shown kept/trajectory.h5 --to xyz --output t.xyz
[ "$(grep -c '^300$' t.xyz)" -eq 21 ] || complain 'not 21 frames of 300 discs'
[ "$(wc -l <t.xyz)" -eq $((21 * 302)) ] || complain 'extended XYZ of another length'
columns=species:S:1:pos:R:3:velo:R:3:id:I:1:radius:R:1:mass:R:1:momenta:R:3
sed -n 2p t.xyz | grep -q "^Lattice=\"1023 0 0 0 1023 0 0 0 1\" Properties=$columns Time=0" ||
    complain 'another second line'
sed -n 2p t.xyz | grep -q 'pbc="F F F"$' || complain 'walls are told as periodic'
run 1 run "$CARROM_SOURCE_DIR/inputs/gas.toml" --set discs.count=100 --set box.left.kind=periodic \
    --set box.right.kind=periodic --steps 1 --quiet \
    -o periodic --set output.trajectory.every_steps=1
expect_code 0 'a periodic box'
shown periodic/trajectory.h5 --to xyz
sed -n 2p "$test_folder/out" | grep -q 'pbc="T F F"$' || complain 'periodic sides are not told'
shown "$last" --to csv
[ "$(sed -n '2s/,.*//p' "$test_folder/out")" = 20 ] || complain 'CSV without the step'
shown kept/collisions.h5 --to csv
[ "$(wc -l <"$test_folder/out")" -eq $((1 + $(json_value report.json wall_collisions) + \
    $(json_value report.json pair_collisions))) ] ||
    complain 'CSV of another length than there were collisions'
sort -t, -k2,2g -c <(tail -n +2 "$test_folder/out") ||
    complain 'the collisions are not in the order of time'

for file in "$last" kept/trajectory.h5 kept/collisions.h5; do
    for ranks in 1 3; do
        run "$ranks" verify "$file"
        expect_code 0 "verify $file"
        run "$ranks" diff "$file" "$file"
        expect_code 0 "diff $file with itself"
        expect_silence "diff $file with itself"
    done
done
run 1 diff "$first" "$last"
expect_code 1 'diff of two steps'
grep -q '^first: .*step: 10 and 20$' "$test_folder/out" || complain 'diff does not name the step'

# A second run that differs in one disc only after a while.
run 1 run "${scene[@]}" --set discs.seed=1 -o other --set output.trajectory.every_steps=1
run 1 diff kept/trajectory.h5 other/trajectory.h5
expect_code 1 'diff of two runs'
grep -q '^first: step 0, disc 0, x: ' "$test_folder/out" ||
    complain 'diff does not name the first disc and field'
grep -q '^largest: ' "$test_folder/out" || complain 'diff does not tell the largest difference'

# No output replaces its own input, which includes a recording's segments.
for file in trajectory collisions; do
    run 1 convert "kept/$file.h5" --to csv --output "kept/$file/0001.h5"
    expect_code 2 "convert onto a segment of $file.h5"
    expect_told "kept/$file/0001.h5: is a part of the file to convert itself" "$file onto a segment"
    run 1 verify "kept/$file.h5"
    expect_code 0 "$file.h5 after that"
done

# A flipped bit among the numbers of a recording is noticed by its own checksums.
for file in kept/trajectory.h5 kept/collisions.h5; do
    cp "$file" damaged.h5
    place=$(($(stat -c %s "$file") / 2))
    byte=$(od -An -tu1 -j "$place" -N 1 "$file")
    printf "\\x$(printf %x $((byte ^ 1)))" | dd of=damaged.h5 bs=1 seek="$place" conv=notrunc \
        status=none
    run 2 verify damaged.h5
    expect_code 2 "a flipped bit in $file"
    expect_told damaged.h5 "a flipped bit in $file"
done

printf 'X' | dd of="$last" bs=1 seek=9000 conv=notrunc status=none
for command in verify info; do
    run 3 "$command" "$last"
    expect_code 2 "$command of a damaged file"
    expect_told \
        'is damaged: these data sets do not have the checksum they had when it was written: ' \
        "$command of a damaged file"
done
cp "$first" blurred.h5
printf 'X' | dd of=blurred.h5 bs=1 seek=5 conv=notrunc status=none
for command in info verify "diff $first" 'convert --to csv'; do
    run 1 $command blurred.h5
    expect_code 2 "$command of a checkpoint with a damaged first line"
    expect_silence "$command of a checkpoint with a damaged first line"
done
run 1 diff "$first" kept/trajectory.h5
expect_code 2 'diff of two kinds'
run 1 convert kept/collisions.h5 --to xyz
expect_code 2 'a log to xyz'
echo text >text
for command in verify info; do
    run 3 "$command" text
    expect_code 2 "$command of some text"
    expect_told 'text: is no HDF5 file, so none that carrom has written' "$command of some text"
    run 3 "$command" none.h5
    expect_code 2 "$command of nothing"
    expect_told 'No such file' "$command of nothing"
done
finish
