#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A run that begins from the discs of another run's checkpoint or frame: the same places and
# velocities, other effects, species and methods, the same bits for any machine shape, and a restart
# that no longer needs the file.
source "$(dirname "$0")/common.sh"

gas_scene 40 300 0.3 1 50 >gas.toml
run 2 run gas.toml --quiet --set time.method=event-driven --set output.text=ends -o first \
    --set output.trajectory.every_steps=25 --set output.trajectory.precision=double \
    --set output.collisions=true
expect_code 0 'the first run'
checkpoint=first/checkpoints/checkpoint-000000000050.h5
awk '$1 == 50 { print $2, $3, $4, $5, $6 }' "$test_folder/out" >left

next_scene() { # DISCS [MORE]: prints a scene with these lines of [discs], and more tables
    printf '[box]\nsize = 40\n[discs]\n%s\n[time]\nsteps = 30\n%s' "$1" "${2:-}"
}
radius=$(awk 'BEGIN { printf "%.17g", sqrt(0.3 * 1600 / (300 * atan2(0, -1))) }')
next_scene "radius = $radius
from = \"$checkpoint\"" >next.toml
for ranks in 1 3; do
    run $ranks run next.toml --quiet --steps 0 --set output.text=ends
    expect_code 0 "the start, $ranks ranks"
    awk '{ print $2, $3, $4, $5, $6 }' "$test_folder/out" >start
    expect_same left start 'other discs than the checkpoint has'
done
run 1 run next.toml --quiet --steps 0 --set output.text=ends \
    --set discs.from=first/trajectory.h5 --set discs.from_step=50
awk '{ print $2, $3, $4, $5, $6 }' "$test_folder/out" >start
expect_same left start 'other discs than the frame has'

# Cooling after an elastic start, in another method, with another species.
lossy='[effects.contact]
kind = "restitution"
restitution = 0.9
'
next_scene "radius = $radius
from = \"../$checkpoint\"" "$lossy" >first/cooling.toml
for method in time-stepped event-driven; do
    hash=
    for ranks in 1 3; do
        run $ranks run first/cooling.toml --quiet --set time.method=$method --report cooled.json
        expect_code 0 "cooling, $method, $ranks ranks"
        hash=${hash:-$(json_value cooled.json state_hash)}
        [ "$(json_value cooled.json state_hash)" = "$hash" ] ||
            complain "cooling has other bits on $ranks ranks, $method"
    done
    run 2 run first/cooling.toml --quiet --set time.method=$method --steps 10 -o cold_$method
    mv first away
    run 1 run --restart cold_$method --quiet --steps 30 --report cooled.json
    expect_code 0 "a restart without the file, $method"
    mv away first
    [ "$(json_value cooled.json state_hash)" = "$hash" ] ||
        complain "cooling has other bits after a restart, $method"
done
next_scene "from = \"$checkpoint\"
[[discs.species]]
count = 100
radius = $radius
mass = 5
[[discs.species]]
count = 200
radius = 0.3" >mixed.toml
run 2 run mixed.toml --quiet --check
expect_code 0 'other species'

# Rough discs keep their spins.
rough='[effects.contact]
kind = "rough"
restitution = 0.9
tangential_restitution = 0.5
'
next_scene "radius = $radius
from = \"$checkpoint\"" "$rough" >rough.toml
run 1 run rough.toml --quiet --steps 30 -o turned
expect_code 0 'rough discs'
next_scene "radius = $radius
from = \"turned/checkpoints/checkpoint-000000000030.h5\"" "$rough" >again.toml
run 3 run again.toml --quiet --steps 0 -o begun
expect_code 0 'rough discs that turn already'
spins() {
    run 1 convert "$1" --to csv
    awk -F, 'NR > 1 { print $1, $2, $3, $4, $5, $NF }' "$test_folder/out"
}
spins turned/checkpoints/checkpoint-000000000030.h5 | cut -d' ' -f 2- >before
spins begun/checkpoints/checkpoint-000000000000.h5 | cut -d' ' -f 2- >after
expect_same before after 'other spins than the checkpoint has'
[ "$(awk '$NF != 0' after | wc -l)" -gt 100 ] || complain 'hardly any disc turns'

refuse() { # WHAT TEXT ARGUMENTS...
    run 2 run "${@:3}" --quiet
    expect_code 2 "$1"
    expect_told "$2" "$1"
}
refuse 'a missing file' 'nowhere.h5' next.toml --set discs.from=nowhere.h5
refuse 'a missing frame' 'has no frame of step 7' next.toml \
    --set discs.from=first/trajectory.h5 --set discs.from_step=7
refuse 'a folder of a run' "'discs.from' takes a checkpoint or a trajectory; try: discs.from = \
\"first/checkpoints/checkpoint-000000000050.h5\"" next.toml --set discs.from=first
mkdir nothing
refuse 'another folder' "nothing: is a folder, and 'discs.from' takes a checkpoint" next.toml \
    --set discs.from=nothing
refuse 'a log' 'is a log of collisions' next.toml --set discs.from=first/collisions.h5
refuse 'another number of discs' 'has 300 discs, and the scene is of 7' next.toml \
    --set discs.count=7
refuse 'discs that have grown' 'is not inside the box' next.toml --set discs.radius=0.8
refuse 'a smaller box' "$checkpoint" next.toml --set box.size=30
# A checkpoint has no lines, so messages name its discs.
grep -qE "$checkpoint: disc [0-9]+ at .* is not inside the box" "$test_folder/err" ||
    { complain 'a disc without its id'; show; }
grep -qE "$checkpoint:[0-9]|lines" "$test_folder/err" &&
    { complain 'a line of a checkpoint'; show; }
# A wrong number of discs in species is one error, and the scene has no discs.count to name.
printf '[box]\nsize = 1000\n[discs]\nspecies = [{count = 5, radius = 1}, {count = 3, radius = 2}]
from = "%s"\n[time]\nsteps = 1\n' "$checkpoint" >species.toml
run 1 run species.toml --quiet
expect_code 2 'a wrong number of discs in species'
expect_told 'has 300 discs, and the scene is of 8' 'a wrong number of discs in species'
[ "$(wc -l <"$test_folder/err")" -eq 1 ] || { complain 'more than one error of species'; show; }
# Which of two sources is meant is unknown, so the discs of neither are read.
for other in 'file = "left"' 'list = [[3, 3, 0, 0]]'; do
    next_scene "radius = $radius
from = \"$checkpoint\"
$other" >both.toml
    refuse "from and $other" "and 'discs.from' exclude each other" both.toml
    run 1 run both.toml --quiet # no mpiexec, which prints lines of its own
    [ "$(wc -l <"$test_folder/err")" -eq 1 ] || { complain "more than one error: $other"; show; }
done
refuse 'a step without a file' "'discs.from_step' has no meaning" gas.toml \
    --set discs.from_step=3

# A measurement that would never begin, and a folder without a checkpoint.
refuse 'samples after the end' \
    "'output.measurements.from_step' = 51 lies beyond the last step, 50" gas.toml -o never \
    --set 'output.measurements.quantities=["pressure"]' --set output.measurements.from_step=51
refuse 'averages after the end' \
    "'output.averages_from_step' = 60 lies beyond the last step, 50" gas.toml \
    --set output.averages_from_step=60
mkdir empty
refuse 'an empty folder' 'there is no checkpoint' gas.toml --restart empty
refuse 'an empty folder, no scene' 'there is no checkpoint' --restart empty
run 1 run gas.toml --quiet --steps 5 --restart latest -o fresh
expect_code 0 'latest may begin anew'
finish
