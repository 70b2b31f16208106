#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Every wrong input ends in the same way: exit code 2, each problem once with file and line on
# standard error, nothing on standard output, and no files. Arguments: the number of ranks, and a
# number n, because only every n-th case is run. Problems are found before ranks differ, so one rank
# runs all cases, and several ranks run a share (all with CARROM_EVERY_CASE=1).
source "$(dirname "$0")/common.sh"
ranks=$1
every=${CARROM_EVERY_CASE:-${2:-1}}
n_cases=0

# refuse WHAT TEXT WORD...: the program must end with code 2 for these words, and print each line of
# TEXT once.
refuse() {
    local what=$1 text=$2 before line
    shift 2
    n_cases=$((n_cases + 1))
    [ $((n_cases % every)) = 0 ] || return 0
    before=$(ls -A)
    run "$ranks" "$@" --report report.json --output lines.txt
    expect_code 2 "$what"
    expect_silence "$what"
    while IFS= read -r line; do
        expect_told "$line" "$what"
        [ "$(grep -cF -- "$line" "$test_folder/err")" -le 1 ] ||
            complain "told more than once: \"$line\", in: $what"
    done <<<"$text"
    [ "$(ls -A)" = "$before" ] || complain "files were written: $what"
    grep -qE 'terminate called|MPI_ABORT|Signal:|internal error' "$test_folder/err" &&
        { complain "not a clean end: $what"; show; }
}

# refuse_text WHAT CONTENT TEXT and refuse_toml: the same for a file with this content.
refuse_text() { printf '%b' "$2" >bad.in; refuse "$1" "$3" run bad.in; rm bad.in; }
refuse_toml() { printf '%s\n' "$2" >bad.toml; refuse "$1" "$3" run bad.toml; rm bad.toml; }

header='2\n10\n1\n5\nprint\n'
good=$'[box]\nsize = 10\n[discs]\ncount = 2\nradius = 1\n[time]\nsteps = 5'

# Files and options.
refuse 'a missing file' 'nowhere.toml: cannot be opened: No such file' run nowhere.toml
refuse 'a directory' '.: is a directory' run .
refuse 'no input' 'no input' run
refuse 'two inputs' 'other.in: one input is enough' run some.in other.in
refuse 'an unknown option' '--thread: no such option' run some.in --thread 2
refuse 'several wrong options' \
    $'--threads: must be\n--digits: must be\n--steps: must be\n--window: must be' \
    run nowhere.toml --threads 0 --digits 18 --steps -1 --window 0
run "$ranks" run some.in --threads
expect_code 2 'an option without its value'
expect_told 'command line: --threads' 'an option without its value'
for word in yes no; do
    refuse "--check=$word" "--check: takes no value; leave \"=$word\" out" run nowhere.toml \
        --check=$word
done
refuse 'a flag with a value' '--quiet: takes no value' run nowhere.toml --quiet=no
refuse 'a flag with a word behind it' 'yes: one input is enough' run nowhere.toml --check yes
refuse 'an unknown subcommand' 'command line' walk some.in
mkdir secret && printf "$header" >secret/a.in && chmod 000 secret/a.in
# Root may read everything, so the test uses a file that gives an error on reading.
if [ -r secret/a.in ]; then refuse 'an unreadable file' '/proc/self/mem: cannot be read' run \
    /proc/self/mem
else refuse 'an unreadable file' 'secret/a.in: cannot be opened: Permission denied' run secret/a.in
fi
rm -rf secret

mkfifo pipe
refuse 'a pipe that nobody writes to' 'pipe: is not a plain file' run pipe
refuse 'a device that never ends' '/dev/zero: is not a plain file' run /dev/zero
refuse 'a checkpoint that is a pipe' 'pipe: is not a plain file' run --restart pipe
for command in info verify 'diff pipe' 'convert --to csv'; do
    run "$ranks" $command pipe
    expect_code 2 "$command pipe"
    expect_told 'pipe: is not a plain file' "$command pipe"
done
rm pipe

# Legacy text, the header.
refuse_text 'an empty file' '' 'bad.in: the input is empty'
refuse_text 'TOML by another name' '\n# a box\n[box]\nsize = 10\n' 'bad.in:2: looks like TOML'
refuse_text 'a header that ends early' '2\n10\n1\n' 'bad.in:3: the input ends before'
refuse_text 'no discs at all' '0\n10\n1\n5\nprint\n' 'bad.in:1: '
refuse_text 'a negative number of discs' '-4\n10\n1\n5\nprint\n' 'bad.in:1: '
refuse_text 'a count that is not whole' '2.5\n10\n1\n5\nprint\n' 'bad.in:1: '
refuse_text '1e19 discs' '10000000000000000000\n10\n1\n5\nprint\n' 'bad.in:1: '
refuse_text 'a radius of 0' '2\n10\n0\n5\nprint\n' 'bad.in:3: '
refuse_text 'a negative radius' '2\n10\n-1\n5\nprint\n' 'bad.in:3: '
refuse_text 'a box without size' '2\n0\n1\n5\nprint\n' 'bad.in:2: '
refuse_text 'a box that is no number' '2\nnan\n1\n5\nprint\n' 'bad.in:2: '
refuse_text 'an infinite box' '2\ninf\n1\n5\nprint\n' 'bad.in:2: '
refuse_text 'a box narrower than a disc' '1\n1.5\n1\n5\nprint\n' 'L < 2 r'
refuse_text 'more discs than fit' '40\n10\n1\n5\nprint\n' 'cannot fit into a box of side 10'
refuse_text 'a box too wide for the wall band' '2\n2e6\n1\n5\nprint\n' 'radii wide'
refuse_text 'negative steps' '2\n10\n1\n-5\nprint\n' 'bad.in:4: '
refuse_text 'an unknown output' '2\n10\n1\n5\nprnt\n' 'bad.in:5: '
refuse_text 'rubbish in the header' '2 x\n10\n1\n5\nprint\n' 'bad.in:1: '
refuse_text 'several problems at once' '-2\n10\nnan\n5\nprnt\n' \
    $'bad.in:1: \nbad.in:3: \nbad.in:5: '

# Legacy text, the discs.
refuse_text 'a short line' "${header}0 3 3 1\n1 7 7 0 0\n" 'bad.in:6: '
refuse_text 'rubbish after a disc' "${header}0 3 3 1 0 9\n1 7 7 0 0\n" 'bad.in:6: '
refuse_text 'a disc outside the box' "${header}0 3 3 1 0\n1 9.5 7 0 0\n" 'bad.in:7: '
refuse_text 'a position that is no number' "${header}0 3 3 1 0\n1 nan 7 0 0\n" 'bad.in:7: '
refuse_text 'an infinite velocity' "${header}0 3 3 1 0\n1 7 7 inf 0\n" 'bad.in:7: '
refuse_text 'a word for a number' "${header}0 3 3 1 0\n1 7 seven 0 0\n" 'bad.in:7: '
refuse_text 'an id twice' "${header}0 3 3 1 0\n0 7 7 0 0\n" 'bad.in:7: disc 0 is listed twice'
refuse_text 'an id out of range' "${header}0 3 3 1 0\n2 7 7 0 0\n" \
    'bad.in:7: disc 2 is out of range'
refuse_text 'a missing disc' "${header}0 3 3 1 0\n" '1 of 2 discs is missing: 1'
refuse_text 'a line too many' "${header}0 3 3 1 0\n1 7 7 0 0\n2 5 5 0 0\n" 'bad.in:8: '
refuse_text 'problems on several lines' "${header}0 3 3 1\n1 99 7 0 0\n" $'bad.in:6: \nbad.in:7: '

# TOML.
printf '%s\n' "$good" >good.toml
refuse_toml 'no TOML' '[ = 3' 'bad.toml:1: not valid TOML'
refuse_toml 'an empty scene' '' \
    $'\'box.size\' is missing\n\'discs.count\' is missing\n\'time.steps\' is missing'
refuse_toml 'an unknown key' "$good"$'\nstep = 3' $'bad.toml:8: \ndid you mean \'time.steps\'?'
refuse_toml 'a wrong type' "${good/size = 10/size = \"ten\"}" 'bad.toml:2: '
refuse_toml 'not a number' "${good/size = 10/size = nan}" 'bad.toml:2: '
refuse_toml 'infinity' "${good/radius = 1/radius = inf}" 'bad.toml:5: '
refuse_toml 'no discs at all' "${good/count = 2/count = 0}" 'bad.toml:4: '
refuse_toml 'more discs than fit' "${good/count = 2/count = 200}" 'cannot fit into a box of side 10'
refuse_toml 'an effect of a later version' "$good"$'\n[effects.charge]\ne = 1' 'bad.toml:8: '
refuse_toml 'an older name of a key' "$good"$'\ncollisions = "one"' \
    'write time.method = "time-stepped" for "one"'
refuse_toml 'an older word' "${good/radius = 1/radius = 1$'\n'generator = \"ancestor\"}" \
    '"ancestor" is now "legacy"'
refuse_toml 'an older name of a table' "$good"$'\n[[discs.classes]]\ncount = 2\nradius = 1' \
    "'discs.classes' is now 'discs.species'"
refuse_toml 'a misspelt effect' "$good"$'\n[effects.gravty]\ny = 1' \
    "did you mean 'effects.gravity'?"
refuse_toml 'a name with a NUL' "$good"$'\n[output]\nfolder = "a\\u0000b"' 'has a NUL character'
refuse_toml 'a key of 40,000 parts' "$good"$'\n'"$(printf 'a.%.0s' $(seq 40000))a = 1" \
    'bad.toml:8: a key of more than 32 parts'
refuse_toml 'a flood of unknown keys' "$(seq -f 'k%.0f = 1' 100000)"$'\n'"$good" \
    'and 99980 more unknown keys'
refuse 'discs too fast to follow' 'crosses the box more than 2^40 times' run good.toml \
    --set discs.speed=1e60 --set time.method=event-driven
both=$'radius = 1\nspeed = 1\ntemperature = 1'
refuse_toml 'a speed and a temperature' "${good/radius = 1/$both}" \
    "bad.toml:6: 'discs.speed' and 'discs.temperature' exclude each other"
refuse_toml 'a negative temperature' "${good/radius = 1/radius = 1$'\n'temperature = -1}" \
    "bad.toml:6: 'discs.temperature' must be"
refuse_toml 'discs from no file' "${good/radius = 1/radius = 1$'\n'generator = \"file\"}" \
    'bad.toml:6: '
refuse_toml 'discs from a file that is not there' \
    "${good/radius = 1/radius = 1$'\n'generator = \"file\"$'\n'file = \"nowhere.txt\"}" \
        'nowhere.txt: cannot be opened'
for device in /dev/zero /dev/full; do
    refuse "discs from $device" "$device: is not a plain file" run good.toml \
        --set discs.file="$device"
done
# Lines of discs are checked even if there are other errors.
printf '1 99 7 0 0\n0 3 3 1\n1 4 4 4 4\n' >discs.txt
with_file=${good/radius = 1/radius = 1$'\n'file = \"discs.txt\"}
lines=$'discs.txt:2: expected\ndiscs.txt:3: disc 1 is listed twice'
refuse_toml 'a wrong scene and wrong discs' "${with_file/steps = 5/steps = -5}" \
    $'bad.toml:8: \ndiscs.txt:1: disc 1 at (99, 7)\n'"$lines"
refuse_toml 'a wrong number of discs and wrong discs' "${with_file/count = 2/count = 0}" \
    $'bad.toml:4: \n'"$lines"
refuse_toml 'a wrong box and wrong discs' "${with_file/size = 10/size = 1}" $'L < 2 r\n'"$lines"
printf '%s\n' "$with_file" >file.toml
refuse 'a wrong option and wrong discs' $'--threads: must be\n'"$lines" run file.toml --threads none
rm discs.txt file.toml
refuse_text 'a wrong header and wrong discs' "${header/2/-2}0 3 3 1\n0 7 7 0 0\n" \
    $'bad.in:1: \nbad.in:6: expected\nbad.in:7: disc 0 is listed twice'
refuse 'a window too short to end' '--window: must be a number from 1e-05 on' run good.toml \
    --window 1e-300
refuse 'an override without a key' "--set =3: '=3' is not of the form key=value" run good.toml \
    --set =3
refuse 'a wrong override' '--set time.stps' run good.toml --set time.stps=3
refuse 'an override that is none' '--set time.steps' run good.toml --set time.steps
refuse 'wrong options and a wrong scene at once' $'--threads: must be\n--set discs.count' \
    run good.toml --threads none --set discs.count=-1

# Places to write to.
for output in output.checkpoint.keep=1 output.collisions=true output.trajectory.every_steps=1; do
    refuse "$output without a folder" "good.toml: 'output.folder' is missing: the folder for what" \
        run good.toml --set $output
done
run "$ranks" run good.toml --report nowhere/report.json
expect_code 2 'a report in a folder that is not there'
expect_told '--report nowhere/report.json: cannot be written' \
    'a report in a folder that is not there'
cp good.toml kept.toml
run "$ranks" run good.toml --output good.toml
expect_code 2 'output into the input'
expect_told '--output good.toml: is the input itself' 'output into the input'
: >file
refuse 'a folder that is a file' 'output.folder file: ' run good.toml -o file
refuse 'a folder with a line break' '--set output.folder: must stand on one line' \
    run good.toml -o $'two\nlines'
refuse 'a folder below a file' 'output.folder file/below: ' run good.toml -o file/below
refuse 'a folder where there can be none' 'output.folder /proc/carrom: ' run good.toml \
    -o /proc/carrom
refuse 'a wrong scene and a wrong place' $'--set discs.count\noutput.folder file/below: ' \
    run good.toml --set discs.count=-1 -o file/below
ulimit -Sv 4194304
refuse 'more discs than memory' 'good.toml: discs.count = 200000000 needs at least' \
    run good.toml --set discs.count=200000000 --set discs.packing=0.1
ulimit -Sv 1048576
run "$ranks" run good.toml --threads 1000
expect_code 3 'more threads than memory'
expect_told 'of its 1000 threads only; take fewer by --threads' 'more threads than memory'
ulimit -Sv unlimited
cmp -s good.toml kept.toml || complain 'an input was written to'
finish
