#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# One folder, one run: a second run that would write where another run is writing is an error. A run
# does not replace another run's files or files of other programs, and does not write through
# symbolic links.
source "$(dirname "$0")/common.sh"
scene=("$CARROM_SOURCE_DIR/inputs/gas.toml" --set discs.count=500 --set discs.speed=2 --quiet)

"$CARROM_PROGRAM" run "${scene[@]}" -o kept --set output.trajectory.every_steps=1000 \
    --steps 100000000 >"$test_folder/first" 2>&1 &
program=$!
for ((i = 0; i < 200; ++i)); do
    [ ! -e kept/scene.toml ] || break
    sleep 0.1
done
for ranks in 1 3; do
    for how in --overwrite --resume; do
        run "$ranks" run "${scene[@]}" -o ./kept/../kept "$how" --steps 5
        expect_code 2 "a second run $how on $ranks ranks"
        expect_told 'output.folder ./kept/../kept: another run is writing there (process' \
            "a second run $how on $ranks ranks"
    done
done
kill -KILL "$program"
wait "$program" 2>/dev/null
[ -e kept/.carrom.lock ] || complain 'the lock of a killed run is not what this test thinks it is'

# A run that was killed before its first checkpoint begins again from the copy of its scene with its
# settings, but only if it has recorded nothing.
if [ -e kept/trajectory/0001.h5 ]; then
    run 2 run -o kept --resume --steps 5 --quiet
    expect_code 2 'a run after a killed one that has recorded'
    expect_told 'begin anew by --overwrite' 'a run after a killed one that has recorded'
fi
rm -r kept/trajectory*
run 2 run -o kept --resume --steps 5 --quiet
expect_code 0 'a run after a killed one'
expect_told 'beginning at step 0' 'a run after a killed one'
[ -z "$(find kept -name '.carrom*')" ] || complain "locks are left: $(find kept -name '.carrom*')"
hash=$(json_value kept/report.json state_hash)
run 1 run "${scene[@]}" -o other --steps 5
[ "$(json_value other/report.json state_hash)" = "$hash" ] ||
    complain 'the copy of the scene is another scene'

# A folder with a run, and one with a file of that name.
before=$(find kept -type f -exec md5sum {} +)
for ranks in 1 3; do
    run "$ranks" run "${scene[@]}" -o kept --steps 7 --report report.json
    expect_code 2 "a fresh run into a folder with a run on $ranks ranks"
    expect_told 'output.folder kept: has scene.toml of a run: go on with it by --resume' \
        'a folder with a run'
    run "$ranks" run "${scene[@]}" -o kept --steps 7 --set discs.seed=7 \
        --resume --report report.json
    expect_code 2 "going on with another scene on $ranks ranks"
    expect_told "'discs.seed' is" 'going on with another scene'
    [ ! -e report.json ] || complain 'a run with an error has written'
done
run 1 run --restart other --quiet --steps 9 --set output.folder=kept --set time.sync_every=7
expect_code 2 'another run into the folder'
[ "$(find kept -type f -exec md5sum {} +)" = "$before" ] || complain 'a run was touched by another'
for name in trajectory.h5 collisions.h5 report.json; do
    mkdir "with_$name"
    echo 'my thesis' >"with_$name/$name"
    run 1 run "${scene[@]}" -o "with_$name" --steps 1
    expect_code 2 "a file $name of somebody"
    [ "$(cat "with_$name/$name")" = 'my thesis' ] || complain "$name was written over"
done
mkdir -p taken/trajectory.xdmf
run 1 run "${scene[@]}" -o taken --steps 1 --overwrite
expect_code 2 'a folder in the place of a file'
expect_told 'taken/trajectory.xdmf is not a plain file' 'a folder in the place of a file'

# --overwrite removes only files that the earlier run has written.
echo notes >kept/notes.txt
run 2 run "${scene[@]}" -o kept --overwrite --steps 3
expect_code 0 '--overwrite'
[ "$(ls kept/checkpoints)" = checkpoint-000000000003.h5 ] ||
    complain "older checkpoints: $(ls kept/checkpoints)"
[ -e kept/notes.txt ] || complain 'a foreign file is gone'

# Symbolic links: a run refuses one in place of its lock file, and writes through none to `victim`.
mkdir linked
echo victim >victim
ln -s ../victim linked/.carrom.lock
run 1 run "${scene[@]}" -o linked --steps 1
expect_code 2 'a link in the place of the lock'
expect_told '.carrom.lock cannot be opened: Too many levels of symbolic links' \
    'a link in the place of the lock'
rm linked/.carrom.lock
ln -s ../victim linked/report.json
run 1 run "${scene[@]}" -o linked --steps 1
expect_code 2 'a link in the place of the report'
ln -s victim report.json.partial
run 1 run "${scene[@]}" --report report.json --steps 1
expect_code 0 'a link in the place where reports were written beside'
[ "$(cat victim)" = victim ] || complain 'a file was written through a link'
for name in trajectory.xdmf scene.toml; do
    mkdir -p "linked_$name"
    ln -s ../victim "linked_$name/$name.partial"
    run 1 run "${scene[@]}" -o "linked_$name" --steps 4 --set output.trajectory.every_steps=1
    expect_code 0 "a link where $name was written beside"
    [ "$(cat victim)" = victim ] || complain "a file was written through $name.partial"
    [ -L "linked_$name/$name.partial" ] || complain "a foreign $name.partial was removed"
done
[ -L report.json.partial ] || complain 'a foreign file was removed'

# Empty words come from variables that are not set. Only a run's own folder may begin again.
for option in --restart --output --report -o; do
    run 1 run "${scene[@]}" --steps 1 "$option" ""
    expect_code 2 "$option with an empty word"
done
mkdir none
run 1 run "${scene[@]}" --steps 1 --restart none
expect_code 2 'a restart from a folder without a checkpoint'
expect_told 'there is no checkpoint' 'a restart from a folder without a checkpoint'
run 1 run "${scene[@]}" --steps 1 -o none --resume
expect_code 2 'going on where no run has begun'
run 1 run -o none --resume
expect_code 2 'going on where no run has begun, without a scene'
run 2 run "${scene[@]}" --steps 1 -o none --restart latest
expect_code 0 'latest begins anew'

# A process without a launcher shares nothing: it makes no folder that another one may make too.
if [ ${#past_launcher[@]} -eq 0 ]; then
    TMPDIR=/proc run 1 run "${scene[@]}" --steps 1
    expect_code 0 'a run where no temporary folder can be made'
else
    echo 'skipped: no temporary folder (Open MPI 5 does not start without one)'
fi

# Two at a time: one makes the replicas, the other one shares them or is refused in one line.
for name in alone many; do
    for k in 1 2; do
        [ $name$k != alone2 ] || continue
        "$CARROM_PROGRAM" replicas "${scene[@]}" --count 2 -o $name --steps 2000 \
            >"$test_folder/replicas_$name$k" 2>&1 &
        replicas[k]=$!
    done
    codes=
    for k in 1 2; do
        [ $name$k != alone2 ] || continue
        wait "${replicas[k]}"
        codes+=" $?"
    done
done
case $codes in
    ' 0 0') ;;
    ' 0 2') refused=$test_folder/replicas_many2 ;;
    ' 2 0') refused=$test_folder/replicas_many1 ;;
    *) complain "two at a time ended with$codes: $(cat "$test_folder"/replicas_many?)" ;;
esac
[ -z "${refused:-}" ] || [ "$(wc -l <"$refused")" -eq 1 ] ||
    complain "more than a line: $(cat "$refused")"
for file in alone/*.csv; do
    expect_same "$file" "many/${file#alone/}" 'two at a time have made other averages'
done
finish
