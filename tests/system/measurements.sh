# SPDX-License-Identifier: BSD-3-Clause
# Tables of measurements: the same bytes on other ranks and threads and after a restart between two
# samples; what is wrong with their keys; and nothing of them in the checkpoint of a run that does
# not ask.
source "$CARROM_SOURCE_DIR/tests/system/common.sh"

gas_scene 40 400 0.3 1 90 >gas.toml
quantities='"wall_pressure","radial_distribution","velocities","density","displacement","pressure"'
quantities+=',"thermo","psi6"'
asked=(--set "output.measurements.quantities=[$quantities]"
       --set output.measurements.every_steps=7 --set output.measurements.from_step=10)
for method in time-stepped event-driven; do
    run 1 run gas.toml --quiet --set time.method=$method "${asked[@]}" -o whole_$method \
        --report $method.json
    expect_code 0 "$method, one rank"
    [ "$(ls whole_$method/measurements | wc -l)" -eq 16 ] ||
        complain "$method: $(ls whole_$method | tr '\n' ' ')"
    grep -q '"radial_distribution": {' $method.json || complain "$method: no tables in the report"
    run 3 run gas.toml --quiet --threads 2 --steps 50 --set time.method=$method "${asked[@]}" \
        -o kept_$method
    expect_code 0 "$method, three ranks"
    run 2 run gas.toml --quiet --set time.method=$method "${asked[@]}" -o kept_$method \
        --restart latest
    expect_code 0 "$method, the second stretch"
    diff -r whole_$method/measurements kept_$method/measurements >/dev/null ||
        complain "$method: other tables: $(diff -rq {whole,kept}_$method/measurements)"
done
run 1 verify kept_event-driven/checkpoints/checkpoint-000000000050.h5
expect_code 0 'a checkpoint with measurements'

# In a periodic box, where there are wave vectors; the restart comes within a window of flights.
around=(--set box.left.kind=periodic --set box.right.kind=periodic --set box.bottom.kind=periodic
        --set box.top.kind=periodic --set output.measurements.every_steps=7)
flights=(--set 'output.measurements.quantities=["psi6","structure_factor","diffusion"]'
         --set output.measurements.correlation_steps=21)
run 1 run gas.toml --quiet "${around[@]}" "${flights[@]}" -o whole_around
expect_code 0 'all round, one rank'
run 3 run gas.toml --quiet --threads 2 --steps 50 "${around[@]}" "${flights[@]}" -o kept_around
expect_code 0 'all round, three ranks'
run 2 run gas.toml --quiet "${around[@]}" "${flights[@]}" -o kept_around --restart latest
expect_code 0 'all round, the second stretch'
diff -r whole_around/measurements kept_around/measurements >/dev/null ||
    complain "all round: $(diff -rq {whole,kept}_around/measurements)"
# Fields, correlations and transport, the restart within a block of profiles.
fields=(--set 'output.measurements.quantities=["profiles","correlations","transport"]'
        --set output.measurements.profile_columns=7 --set output.measurements.profile_rows=3
        --set output.measurements.profile_samples=5 --set output.measurements.hdf5=1)
for method in time-stepped event-driven; do
    by=(--set time.method=$method "${around[@]}" "${fields[@]}")
    run 1 run gas.toml --quiet "${by[@]}" -o whole_fields_$method
    expect_code 0 "fields, $method, one rank"
    run 3 run gas.toml --quiet --threads 2 --steps 50 "${by[@]}" -o kept_fields_$method
    expect_code 0 "fields, $method, three ranks"
    run 2 run gas.toml --quiet "${by[@]}" -o kept_fields_$method --restart latest
    expect_code 0 "fields, $method, the second stretch"
    diff -r {whole,kept}_fields_$method/measurements >/dev/null ||
        complain "fields: $(diff -rq {whole,kept}_fields_$method/measurements)"
    [ "$(ls whole_fields_$method/measurements | wc -l)" -eq 5 ] || complain 'fields: no five files'
done
run 1 run gas.toml -o x "${fields[@]}"
expect_code 2 'transport between walls'
expect_told 'periodic all round' 'transport between walls'
run 1 run gas.toml -o x "${around[@]}" "${fields[@]}" --set output.measurements.profile_rows=300 \
    --set output.measurements.correlation_points=12
expect_code 2 'a grid finer than the discs'
expect_told 'a grid of 2100 cells for "profiles" is more than the 400 discs' 'a grid'
expect_told 'must be 4, 8, 16, 32 or 64, not 12' 'points of a level'
run 1 run gas.toml -o x "${around[@]}" "${flights[@]}" \
    --set output.measurements.correlation_steps=20 --set output.measurements.largest_wavenumber=1e4
expect_code 2 'wrong windows and wavenumbers'
expect_told "must be a multiple of 'output.measurements.every_steps' = 7, from 14 on" 'windows'
expect_told 'where a million are, not 10000' 'wavenumbers'
# A run too short for a window says so, and its tables have no nan; a longer one goes on with it.
run 1 run gas.toml --steps 20 "${around[@]}" "${flights[@]}" -o short_around
expect_code 0 'all round, too short'
expect_told 'gas.toml: warning: no table of diffusion' 'a run too short for a window'
[ ! -e short_around/measurements/diffusion.csv ] || complain 'a table without a number'
run 1 run --restart short_around --steps 90 --quiet
expect_code 0 'all round, longer'
diff -r {whole,short}_around/measurements >/dev/null || complain 'other tables after a short run'
run 1 run gas.toml -o x \
    --set 'output.measurements.quantities=["structure_factor","diffusion","displacement"]'
expect_code 2 'quantities that exclude each other, and walls'
expect_told 'make all four sides periodic' 'wave vectors between walls'
expect_told 'one first place of each disc' 'diffusion and displacement'

# The table of the usual quantities grows as the run goes on.
[ "$(grep -vc '#' whole_event-driven/measurements/thermo.csv)" -eq 13 ] || complain 'rows of thermo'
"$CARROM_PROGRAM" run gas.toml --quiet --steps 900000 -o endless \
    --set 'output.measurements.quantities=["thermo"]' 2>"$test_folder/err" &
program=$!
for try in $(seq 300); do
    n_rows=$(grep -vc '#' endless/measurements/thermo.csv 2>/dev/null)
    [ "${n_rows:-0}" -gt 4 ] && break
    sleep 0.1
done
kill -TERM $program
wait $program
code=$?
expect_code 75 'a run that was told to stop'
[ "${n_rows:-0}" -gt 4 ] || complain 'no rows of thermo while the run went on'

run 1 run gas.toml --quiet --steps 50 --set time.method=event-driven -o plain
grep -q measurements plain/checkpoints/checkpoint-000000000050.h5 &&
    complain 'a checkpoint knows of measurements that nobody asked for'

run 3 run --restart kept_event-driven --set output.measurements.bins=10
expect_code 2 'other bins'
expect_told 'begin anew with output.measurements.from_step = 90' 'other bins'
run 1 run gas.toml --set output.measurements.every_steps=5 \
    --set 'output.measurements.quantities=["densty"]'
expect_code 2 'wrong keys'
expect_told "'output.folder' is missing" 'wrong keys'
expect_told 'did you mean "density"?' 'wrong keys'
run 1 run gas.toml -o x --set 'output.measurements.quantities=["density"]' \
    --set output.measurements.largest_distance=3
expect_code 2 'a key of what is not asked for'
run 1 run gas.toml -o x --set 'output.measurements.quantities=["radial_distribution"]' \
    --set output.measurements.largest_distance=30
expect_code 2 'too far'
expect_told 'cannot reach 30' 'too far'
touch file
run 1 run gas.toml "${asked[@]}" -o file
expect_code 2 'a file in the place of the folder'
[ ! -e x ] || complain 'a refused run has made a folder'
finish
