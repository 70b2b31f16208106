# SPDX-License-Identifier: BSD-3-Clause
# A scene with most effects at once: the same bits and lines on other ranks and after a restart in
# the middle of a sync interval, where coordinates are those of the falling frame; and what tells of
# effects does.
source "$CARROM_SOURCE_DIR/tests/system/common.sh"

cat >fall.toml <<'SCENE'
[box]
size = 100
bottom = { restitution = 0.9 }
left = { kind = "thermal", temperature = 0.05 }
right = { kind = "moving", speed = -0.05 }
[discs]
count = 400
packing = 0.15
speed = 0.3
[time]
steps = 150
method = "event-driven"
[effects.contact]
kind = "restitution"
restitution = 0.95
[effects.gravity]
y = -0.005
SCENE

run 2 run fall.toml --quiet --report whole.json --set output.text=ends -o fall \
    --set output.trajectory.every_steps=30
expect_code 0 'uninterrupted'
tail -n 400 "$test_folder/out" >"$test_folder/end"
run 1 verify fall/trajectory.h5
expect_code 0 'the trajectory'

run 1 run fall.toml --threads 2 --steps 100 --set output.folder=kept
expect_code 0 'the first stretch'
expect_told 'right wall moving at -0.05' 'the summary'
run 1 verify kept/checkpoints/checkpoint-000000000100.h5
expect_code 0 'the checkpoint'
run 1 info kept/checkpoints/checkpoint-000000000100.h5
grep -q 'gravity (0, -0.005)' "$test_folder/out" || complain 'no effects in info'
run 1 convert kept/checkpoints/checkpoint-000000000100.h5 --to text
cp "$test_folder/out" "$test_folder/converted"
run 1 run fall.toml --steps 100 --quiet --set output.text=ends
tail -n 400 "$test_folder/out" | cut -d ' ' -f 2-6 |
    cmp - <(cut -d ' ' -f 2-6 "$test_folder/converted") ||
    complain 'the checkpoint shows other discs than the run'

run 3 run --restart kept --steps 150 --quiet --report rest.json --set output.text=ends
expect_code 0 'the second stretch'
[ "$(json_value rest.json state_hash)" = "$(json_value whole.json state_hash)" ] ||
    complain 'another state hash after a restart'
tail -n 400 "$test_folder/out" | cmp - "$test_folder/end" || complain 'other lines after a restart'

# Rough discs of two species leave.
sed 's/^left = .*/left = { kind = "open" }/; s/^right = .*/right = { kind = "open" }/
    /^count =/d; /^packing =/d; s/^kind = "restitution"/kind = "rough"\
tangential_restitution = 0.3/' fall.toml >leak.toml
printf '[[discs.species]]\ncount = %s\nradius = %s\nmass = %s\nspin = 0.4\n' 100 1.5 2 300 0.8 0.7 \
    >>leak.toml
run 2 run leak.toml --quiet --report leak.json --set output.text=ends -o leak \
    --set output.trajectory.every_steps=30
expect_code 0 'open sides'
tail -n 400 "$test_folder/out" >"$test_folder/end"
run 3 run leak.toml --steps 70 --quiet --set output.folder=leaking
expect_code 0 'open sides, the first stretch'
run 1 verify leaking/checkpoints/checkpoint-000000000070.h5
expect_code 0 'a checkpoint of a box that some have left'
run 1 run --restart leaking --steps 150 --report leak_rest.json --set output.text=ends
expect_code 0 'open sides, the second stretch'
expect_told ' of 400 discs: left ' 'the summary of open sides'
[ "$(json_value leak_rest.json state_hash)" = "$(json_value leak.json state_hash)" ] ||
    complain 'open sides: another state hash after a restart'
tail -n 400 "$test_folder/out" | cmp - "$test_folder/end" ||
    complain 'open sides: other lines after a restart'

run 1 verify leak/trajectory.h5
expect_code 0 'the trajectory of a box that some have left'

# A trajectory tells which sides are open: discs lie a radius beyond those, no further, and beyond
# no wall. 0.53125 is 3fe1000000000000.
cat >out.toml <<'SCENE'
[box]
size = 20
right = { kind = "open" }
[discs]
count = 20
radius = 0.53125
speed = 1
[time]
steps = 100
method = "time-stepped"
[output]
folder = "out"
[output.trajectory]
every_steps = 50
SCENE
run 1 run out.toml
expect_code 0 'an open side, time-stepped method'
expect_told ' of 20 discs: right ' 'an open side, time-stepped method'
run 1 verify out/trajectory.h5
expect_code 0 'the trajectory of an open side, time-stepped method'
LC_ALL=C sed -i 's/open_sides/open_walls/' out/trajectory.h5
run 1 verify out/trajectory.h5
expect_code 2 'a trajectory that was changed'
expect_told 'its bytes do not have its checksum' 'a trajectory that was changed'

# Radii of growing discs follow from the step, so a restart goes on with them.
cat >growing.toml <<'SCENE'
[box]
size = 60
left = { kind = "periodic" }
right = { kind = "periodic" }
top = { restitution = 0.9 }
[discs]
count = 400
packing = 0.3
speed = 0.3
[time]
steps = 150
[effects.growth]
rate = 0.003
SCENE
run 2 run growing.toml --quiet --report growing.json --set output.text=ends
expect_code 0 'growing discs'
tail -n 400 "$test_folder/out" >"$test_folder/end"
[ "$(json_value growing.json overlapping_pairs)" = 0 ] || complain 'growing discs overlap'
run 3 run growing.toml --steps 70 --threads 2 --set output.folder=grown
expect_code 0 'growing discs, the first stretch'
expect_told 'packing 0.3, 0.4392 at the last step' 'growing discs, the summary'
run 1 verify grown/checkpoints/checkpoint-000000000070.h5
expect_code 0 'growing discs, the checkpoint'
run 1 run --restart grown --steps 150 --report grown.json --quiet --set output.text=ends
expect_code 0 'growing discs, the second stretch'
[ "$(json_value grown.json state_hash)" = "$(json_value growing.json state_hash)" ] ||
    complain 'growing discs: another state hash after a restart'
tail -n 400 "$test_folder/out" | cmp - "$test_folder/end" ||
    complain 'growing discs: other lines after a restart'
run 2 run growing.toml --steps 40 --check --quiet
expect_code 0 'growing discs, checked'
run 2 run growing.toml --steps 300
expect_code 2 'growing discs that will have no room'
expect_told 'there is room for them up to step 246' 'growing discs that will have no room'

# A start by compression; one that jams says how far it came.
run 2 run growing.toml --set discs.packing=0.62 --steps 20 --quiet --report dense2.json \
    --set discs.generator=compressed
expect_code 0 'a compressed start on 2 ranks'
run 1 run growing.toml --set discs.packing=0.62 --steps 20 --quiet --report dense1.json \
    --set discs.generator=compressed --threads 2
expect_code 0 'a compressed start'
[ "$(json_value dense1.json state_hash)" = "$(json_value dense2.json state_hash)" ] ||
    complain 'a compressed start: another state hash on 2 ranks'
run 2 run growing.toml --set discs.packing=0.9 --set discs.generator=compressed \
    --set effects.growth.rate=0 --set discs.growth_rate=0.2
expect_code 2 'a compression that jams'
expect_told 'the compression jams at a packing fraction of 0.' 'a compression that jams'

# The box of a trajectory holds all frames, so it depends on the last step where walls move out; a
# restart may change that.
cat >grow.toml <<'SCENE'
[box]
size = 20
right = { kind = "moving", speed = 0.1 }
[discs]
count = 60
radius = 0.5
speed = 1
[time]
steps = 100
method = "event-driven"
[output.trajectory]
every_steps = 5
SCENE
grow() { # FOLDER OPTION...
    run 1 run grow.toml --quiet -o "$1" "${@:2}"
    expect_code 0 "a moving wall: $*"
}
same_as() { # FOLDER BOX
    run 1 diff "$1/trajectory.h5" parts/trajectory.h5
    expect_code 0 "the trajectory of a moving wall: $1 and parts"
    run 1 info parts/trajectory.h5
    grep -q "^discs *60 in a box of $2\$" "$test_folder/out" ||
        complain "not the box of the last step, $2: $(cat "$test_folder/out")"
}
grow whole
grow shorter --steps 60
grow parts --steps 10
grow parts --restart latest
same_as whole 30
run 1 verify parts/trajectory.h5
expect_code 0 'the trajectory of a moving wall, in two stretches'
grow parts --restart parts/checkpoints/checkpoint-000000000010.h5 --steps 60
same_as shorter 26
# Along a periodic axis the box is the period, that images are counted in.
grow corridor --set box.bottom.kind=periodic --set box.top.kind=periodic
run 1 info corridor/trajectory.h5
grep -q '^discs *60 in a box of 30 x 20$' "$test_folder/out" ||
    complain "not the period along y: $(cat "$test_folder/out")"

run 1 run leak.toml -o measured --set 'output.measurements.quantities=["displacement"]'
expect_code 2 'measurements in an open box'
expect_told 'with open sides velocities and densities alone are measured' \
    'measurements in an open box'

run 1 run fall.toml --restart kept --set effects.gravity.y=-0.01
expect_code 2 'another gravity'
expect_told "'effects.gravity.y' is -0.005 there and -0.01 here" 'another gravity'
# Discs of several species: no legacy text, no lattice of one size; their radii and masses go into
# recordings, and come back with a restart.
cat >mixture.toml <<'SCENE'
[box]
size = 60
[[discs.species]]
count = 5
radius = 4
mass = 20
[[discs.species]]
count = 300
radius = 0.5
[time]
steps = 60
method = "time-stepped"
SCENE
run 3 run mixture.toml --quiet --report one.json --set output.trajectory.every_steps=1 -o mixed
expect_code 0 'a mixture'
run 1 run mixture.toml --threads 2 --quiet --report one_again.json
[ "$(json_value one.json state_hash)" = "$(json_value one_again.json state_hash)" ] ||
    complain 'a mixture has other bits on other ranks'
run 1 verify mixed/checkpoints/checkpoint-000000000060.h5
expect_code 0 "the mixture's checkpoint"
run 1 verify mixed/trajectory.h5
expect_code 0 "the mixture's trajectory"
run 1 info mixed/checkpoints/checkpoint-000000000060.h5
grep -q '5 discs of radius 4 and mass 20, 300 discs of radius 0.5 and mass 1' "$test_folder/out" ||
    complain 'no species in info'
run 1 run --restart mixed --steps 90 --set time.method=event-driven
expect_code 2 'another rule'
run 2 run --restart mixed --steps 90 --quiet --report mixed_rest.json
run 1 run mixture.toml --steps 90 --quiet --report mixed_whole.json
[ "$(json_value mixed_rest.json state_hash)" = "$(json_value mixed_whole.json state_hash)" ] ||
    complain 'a mixture has another state hash after a restart'

# Images that move are where the scene's time says: a run goes on on another shape, and is checked.
for method in time-stepped event-driven; do
    sheared=("$CARROM_SOURCE_DIR/inputs/sheared.toml" --set discs.count=300
        --set box.size=160 --set time.method=$method --set time.sync_every=16 --quiet)
    run 2 run "${sheared[@]}" --steps 60 --check --report sheared.json -o sheared --overwrite
    expect_code 0 "sheared discs, $method"
    run 1 run "${sheared[@]}" --steps 25 -o shearing --overwrite
    expect_code 0 "sheared discs, $method, the first stretch"
    run 2 verify shearing/checkpoints/checkpoint-000000000025.h5
    expect_code 0 'a checkpoint of sheared discs'
    run 3 run --restart shearing --steps 60 --quiet --report sheared_rest.json
    expect_code 0 "sheared discs, $method, the second stretch"
    [ "$(json_value sheared_rest.json state_hash)" = "$(json_value sheared.json state_hash)" ] ||
        complain "sheared discs, $method: another state hash after a restart"
done

# Rough discs turn: their spins go into files and come back with a restart.
rough=("$CARROM_SOURCE_DIR/inputs/rough.toml" --set discs.count=1200 --quiet)
run 2 run "${rough[@]}" --report rough.json --set output.trajectory.every_steps=1 -o turned
expect_code 0 'rough discs'
run 1 run "${rough[@]}" --steps 25 --set output.trajectory.every_steps=1 -o turning
expect_code 0 'rough discs, the first stretch'
run 2 verify turning/checkpoints/checkpoint-000000000025.h5
expect_code 0 'a checkpoint with spins'
run 3 run --restart turning --steps 60 --quiet --report rough_rest.json
expect_code 0 'rough discs, the second stretch'
[ "$(json_value rough_rest.json state_hash)" = "$(json_value rough.json state_hash)" ] ||
    complain 'rough discs: another state hash after a restart'
for pair in 'turned/trajectory.h5 turning/trajectory.h5' \
    'turned/checkpoints/checkpoint-000000000060.h5 turning/checkpoints/checkpoint-000000000060.h5'
do
    run 1 diff $pair
    expect_code 0 "rough discs, interrupted and not: $pair"
done
run 1 info turned/trajectory.h5
grep -q 'fields      position velocity angular_velocity' "$test_folder/out" ||
    complain "info of a trajectory with spins: $(cat "$test_folder/out")"
run 1 convert turning/checkpoints/checkpoint-000000000060.h5 --to csv
[ "$(awk -F, 'NR > 1 && $9 != 0' "$test_folder/out" | wc -l)" -gt 600 ] ||
    complain 'hardly any disc turns in CSV'
run 1 diff turning/checkpoints/checkpoint-000000000025.h5 \
    turning/checkpoints/checkpoint-000000000060.h5
expect_code 1 'checkpoints of two steps'

# Each disc with a radius, a mass and a spin of its own: from a file, and from the scene itself; a
# restart needs no file.
awk 'BEGIN {
    for (k = 0; k < 144; ++k) {
        i = (k * 59) % 144
        printf "%d %g %g ", i, 2.5 + 5 * (i % 12), 2.5 + 5 * int(i / 12)
        printf "%g %g ", (i * 7919 % 1000 - 500) / 1000, (i * 104729 % 1000 - 500) / 1000
        printf "%g %g %g\n", 1 + (i * 37 % 100) / 90, 0.5 + (i * 53 % 10) / 5, (i * 31 % 7 - 3) / 10
    } }' >discs.txt
several() { # SCENE LINES...
    printf '[box]\nsize = 60\n[time]\nsteps = 60\n[effects.contact]\nkind = "rough"\n' >"$1"
    printf 'restitution = 0.9\ntangential_restitution = 0.6\n[discs]\n' >>"$1"
    printf '%s\n' "${@:2}" >>"$1"
}
several each.toml 'count = 144' 'file = "discs.txt"' 'columns = ["radius", "mass", "spin"]'
several listed.toml "list = [$(sort -n discs.txt | cut -d ' ' -f 2- | tr ' ' , | sed 's/.*/[&],/')]"
for method in time-stepped event-driven; do
    run 3 run each.toml --set time.method=$method --quiet --report each.json \
        --set output.folder=each_$method --set output.checkpoint.every_steps=25
    expect_code 0 "discs of their own, $method"
    run 1 run listed.toml --set time.method=$method --threads 2 --quiet --report listed.json
    expect_code 0 "the same discs listed, $method"
    [ "$(json_value each.json state_hash)" = "$(json_value listed.json state_hash)" ] ||
        complain "discs of a file have other bits than listed ones, $method"
done
[ "$(json_value each.json pair_collisions)" -gt 200 ] || complain 'discs of their own hardly meet'
sed '17s/ [^ ]* [^ ]* [^ ]*$/ -1 0 x/; 30s/ [^ ]*$//' discs.txt >wrong.txt
run 2 run each.toml --set discs.file=wrong.txt
expect_code 2 'wrong columns'
expect_told 'wrong.txt:17: ' 'wrong columns'
expect_told "expected 'id x y vx vy radius mass spin', found only 7 of the 8 numbers" \
    'wrong columns'
expect_told 'wrong.txt:30: ' 'wrong columns'
run 1 run each.toml --set discs.file=none.txt
expect_code 2 'no file of columns'
expect_told 'none.txt: cannot be opened' 'no file of columns'
run 1 run --restart each_event-driven/checkpoints/checkpoint-000000000050.h5 --steps 60 \
    --set discs.radius=1
expect_code 2 'a restart with other radii'
run 1 run --restart mixed --steps 90 --set discs.file=discs.txt --set 'discs.columns=["radius"]'
expect_code 2 'a restart with columns that its checkpoint does not have'
rm discs.txt
run 2 run --restart each_event-driven/checkpoints/checkpoint-000000000050.h5 --steps 60 \
    --quiet --report each_rest.json --set output.folder=elsewhere
expect_code 0 'discs of their own, after a restart'
[ "$(json_value each_rest.json state_hash)" = "$(json_value each.json state_hash)" ] ||
    complain 'discs of their own have another state hash after a restart'
run 1 diff elsewhere/checkpoints/checkpoint-000000000060.h5 \
    each_event-driven/checkpoints/checkpoint-000000000060.h5
expect_code 0 'checkpoints of discs of their own, interrupted and not'
run 1 verify elsewhere/checkpoints/checkpoint-000000000060.h5
expect_code 0 'a checkpoint of discs of their own'

run 3 run fall.toml --check --quiet --report checked.json
expect_code 0 'a checked run with effects'
[ "$(json_value checked.json state_hash)" = "$(json_value whole.json state_hash)" ] ||
    complain 'another state hash with --check'

sed 's/^left = .*/left = { kind = "periodic" }/; s/^right = .*/right = { kind = "periodic" }/' \
    fall.toml >ring.toml
quantities='"displacement", "radial_distribution", "wall_pressure"'
around=(--set output.trajectory.every_steps=10 --set output.checkpoint.every_steps=30
        --set output.checkpoint.keep=1000000 --set output.measurements.every_steps=20
        --set "output.measurements.quantities=[$quantities]")
run 2 run ring.toml --quiet --report ring.json --set output.text=ends "${around[@]}" -o around
expect_code 0 'periodic sides'
tail -n 400 "$test_folder/out" >"$test_folder/end"
for file in around/trajectory.h5 around/checkpoints/checkpoint-000000000090.h5; do
    run 1 verify "$file"
    expect_code 0 "$file of a periodic box"
done
# H5MD's box says what its sides are.
grep -aq periodic around/trajectory.h5 || complain \
    'a trajectory does not say that its box is periodic'
grep -aq periodic fall/trajectory.h5 && complain \
    'a trajectory between walls says that its box is periodic'
# Killed somewhere behind step 30, by one of its two ranks; on from there with others.
"$CARROM_MPIEXEC" -n 2 "$CARROM_PROGRAM" run ring.toml --quiet --steps 1000000 "${around[@]}" \
    -o killed >"$test_folder/out" 2>"$test_folder/err" &
for ((i = 0; i < 600; ++i)); do
    [ -e killed/checkpoints/checkpoint-000000000030.h5 ] && break
    sleep 0.05
done
kill -KILL "$(ranks_of $! | head -n 1)" || complain 'no rank to kill'
wait $!
# it may have got further than the run that it is compared with
find killed -name 'checkpoint-*.h5' ! -name '*-000000000030.h5' -delete
run 3 run --restart killed --steps 150 --report ring_rest.json "${around[@]}"  \
    --set output.text=ends
expect_code 0 'periodic sides, after a kill'
expect_told 'left side periodic' 'the summary of periodic sides'
[ "$(json_value ring_rest.json state_hash)" = "$(json_value ring.json state_hash)" ] ||
    complain 'periodic sides: another state hash after a kill'
tail -n 400 "$test_folder/out" | cmp - "$test_folder/end" ||
    complain 'periodic sides: other lines after a kill'
for table in displacement radial_distribution wall_pressure_history; do
    expect_same "around/measurements/$table.csv" "killed/measurements/$table.csv" \
        "periodic sides: other measurements after a kill: $table"
done
for pair in "around/trajectory.h5 killed/trajectory.h5" \
    'around/checkpoints/checkpoint-000000000150.h5 killed/checkpoints/checkpoint-000000000150.h5'
do
    run 1 diff $pair
    expect_code 0 "what differs after a kill: $pair"
done
run 2 run ring.toml --check --quiet --report checked_ring.json
expect_code 0 'a checked run between periodic sides'
[ "$(json_value checked_ring.json state_hash)" = "$(json_value ring.json state_hash)" ] ||
    complain 'periodic sides: another state hash with --check'

run 1 accuracy fall.toml
expect_code 2 'a study with effects'
finish
