#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# carrom compare: right outputs of other programs pass, and each mistake of student.py is named by
# its rule. Random scenes show most mistakes; equal times and corners have a scene of their own.
source "$(dirname "$0")/common.sh"
student() { python3 "$CARROM_SOURCE_DIR/tests/system/student.py" "$@"; }
command -v python3 >/dev/null || { echo 'skipped: there is no python3'; exit 77; }

# Discs 0 and 2 meet disc 1 at one time; disc 3 flies into a corner; discs 4 and 5 meet as both meet
# a wall.
cat >ties.in <<'SCENE'
6
16
0.5
6
print
0 4 8 2 0
1 8 8 0 0
2 12 8 -2 0
3 2 2 -1 -1
4 14 4 1 0
5 14 8 1 -2
SCENE
for seed in 1 2; do student --scene 40 1.5 30 "$seed" >"random_$seed.in"; done

compare() { # CODE OUTPUT SCENE OPTION...
    local wanted=$1
    shift
    run 1 compare "$@"
    expect_code "$wanted" "compare $*"
}

for scene in ties random_1 random_2; do
    for digits in .17g .8f; do
        student $scene.in '' $digits >$scene.out
        compare 0 $scene.out $scene.in
        grep -q '^same: ' "$test_folder/out" || complain "$scene: not said to be the same"
    done
done
grep -q 'only amplified roundings' <("$CARROM_PROGRAM" compare random_1.out random_1.in \
    2>/dev/null) ||
    complain 'nothing is said of roundings'

n_named=0
while read -r mistake rule; do
    is_seen=no
    for scene in ties random_1 random_2; do
        # Where times are equal, one collision that is left out looks like a wrong order.
        case $scene-$mistake in ties-*-free | ties-one-disc) continue ;; esac
        # some mistakes end in a division by 0
        student $scene.in "$mistake" .8f >wrong.out 2>/dev/null || continue
        cmp -s $scene.out wrong.out && continue
        is_seen=yes
        compare 1 wrong.out $scene.in
        named=$(sed -n 's/^rule: //p' "$test_folder/out")
        [ "$named" = "$rule" ] || complain \
            "$mistake in $scene breaks the rule '$rule', not '$named': $(cat "$test_folder/out")"
        # The message distinguishes two variants of the same mistake.
        case $mistake in
        same-start) way='and the changes add up' ;;
        last-start) way='and only the last collision counts' ;;
        *) way='' ;;
        esac
        grep -qF "$way" "$test_folder/out" || complain "$mistake in $scene is not called '$way'"
        n_named=$((n_named + 1))
        # The right program's output has other numbers in the line that is named.
        line=$(sed -n 's/^line \([0-9]*\):.*/\1/p' "$test_folder/out")
        [ "$rule" = lines ] || [ "$(sed -n "${line}p" wrong.out)" != \
            "$(sed -n "${line}p" $scene.out)" ] ||
            complain "$mistake in $scene: line $line is right"
    done
    [ $is_seen = yes ] || complain "no scene shows the mistake $mistake"
done < <(student --mistakes)
[ "$n_named" -ge 35 ] || complain "only $n_named wrong outputs were tried"

# One decimal is enough where roundings do not decide; where they do, later steps are not graded.
printf '%s\n' 2 16 0.5 6 print '0 4 8.2 1 0' '1 8 8 -0.3 0.2' >pair.in
student pair.in '' .1f >coarse.out
compare 0 coarse.out pair.in
student pair.in half .1f >coarse.out
compare 1 coarse.out pair.in
grep -q '^rule: impulse$' "$test_folder/out" || complain 'one decimal hides half an impulse'
student random_1.in '' .1f >coarse.out
compare 6 coarse.out random_1.in

# Points: all for a right program, fewer for a wrong one, and the same first line that differs.
points() { sed -n 's/^points: \([0-9]*\) of 100$/\1/p' "$test_folder/out"; }
compare 0 ties.out ties.in --points
[ "$(points)" = 100 ] || complain "a right program has $(points) points"
student ties.in corner .8f >wrong.out
compare 1 wrong.out ties.in
verdict=$(sed -n 1,4p "$test_folder/out")
compare 1 wrong.out ties.in --points
[ "$(sed -n 1,4p "$test_folder/out")" = "$verdict" ] || complain 'points change the verdict'
# One of six steps has the corner. The right and the wrong program count both walls once.
grep -q '^  steps    50 of 60: 5 of 6 ' "$test_folder/out" ||
    complain "a wrong corner: $(cat "$test_folder/out")"
sed '/^6 3 /s/ [0-9]*$/ 9/' ties.out >wrong.out
compare 1 wrong.out ties.in --points
[ "$(points)" = 80 ] || complain "wrong counters have $(points) points, not 80"
student random_1.in short .8f >wrong.out
compare 1 wrong.out random_1.in --points
grep -q '^  lines     0 of 10$' "$test_folder/out" || complain 'missing lines keep their points'

# The first line that differs is where one number was changed, and the tolerance is what decides.
student ties.in '' .8f | sed '8s/ 8[.]00000000 0/ 8.00001000 0/' >moved.out
compare 1 moved.out ties.in
grep -q '^line 8: step 1, disc 1 differs' "$test_folder/out" ||
    complain "another line than 8: $(cat "$test_folder/out")"
compare 0 moved.out ties.in --tolerance 1e-3

# The program's own output, on ranks, with micro-steps, first and last steps only, and from standard
# input.
run 1 run random_1.in --set time.micro_steps=4 --output own.out --quiet
run 3 compare own.out random_1.in --set time.micro_steps=4
expect_code 0 'the own output on 3 ranks'
compare 1 own.out random_1.in
generated=$CARROM_SOURCE_DIR/inputs/generated.in
run 1 run "$generated" --steps 30 --digits 8 --output own.out --quiet
compare 6 own.out "$generated" --set time.steps=30
grep -q '^not graded to the end: ' "$test_folder/out" ||
    complain 'a step that roundings decide was graded'
# Beyond the graded steps, numbers must be valid, too.
for wrong in 'nan nan nan nan' '1e300 0 0 0' '5 5 inf 0'; do
    sed "s/^30 \([0-9]*\) .* \([0-9]*\) \([0-9]*\)\$/30 \1 $wrong \2 \3/" own.out >wrong.out
    compare 1 wrong.out "$generated" --set time.steps=30
    grep -q '^line .*: step 30, disc 0 is outside the box or not finite' "$test_folder/out" ||
        complain "another verdict on $wrong: $(cat "$test_folder/out")"
done
run 1 run "$generated" --steps 30 --set output.text=every_step --digits 8 --output own.out --quiet
compare 0 own.out "$generated" --set time.steps=30 --set output.text=every_step
"$CARROM_PROGRAM" compare - ties.in <ties.out >"$test_folder/out" 2>&1 || complain 'standard input'

# Wrong inputs: every problem, nothing on standard output.
refused() { # TEXT WORD...
    local text=$1
    shift
    compare 2 "$@"
    expect_told "$text" "compare $*"
    expect_silence "compare $*"
}
echo 'Time: 3 s' >chatter.out
refused 'chatter.out:1: is no line of a disc, and no other line is one' chatter.out ties.in
echo '0 0 1 2 x 4' >letters.out
refused "letters.out:1: 'x' is no number" letters.out ties.in
refused 'none.out' none.out none.in
refused 'none.in' none.out none.in
refused 'time-stepped' ties.out ties.in --set time.method=event-driven
refused 'writes no lines' ties.out "$CARROM_SOURCE_DIR/inputs/gas.toml"
refused '--tolerance' ties.out ties.in --tolerance -1
echo '0 0 nan 8 2 0' | cat - <(tail -n +2 ties.out) >nan.out
compare 1 nan.out ties.in
finish
