#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Other programs open our files and read the same numbers as in the run's text: h5py, pyh5md,
# MDAnalysis, VTK (through XDMF), and the worked example and figures of
# docs/understanding/method.md. The programs come from PyPI, into a folder that is kept; those that
# cannot be installed are skipped. Arguments: `few` or `all`, and that folder. `few` leaves out the
# programs whose packages take hundreds of megabytes.
source "$(dirname "$0")/common.sh"
share=$1
shift
python=$1/bin/python tests=$(dirname "$0") tools=$CARROM_SOURCE_DIR/docs/tools
n_read=0
skip() { printf 'skipped: %s\n' "$*"; }

[ -x "$python" ] && "$python" -m pip --version >/dev/null 2>&1 ||
    python3 -m venv --clear "$1" >"$test_folder/err" 2>&1 || {
    printf 'skipped: no Python environment can be made: %s\n' "$(tail -n 1 "$test_folder/err")"
    exit 77
}

# has MODULE PACKAGE...: whether Python has the module; if not, installs the packages from PyPI
has() {
    local module=$1
    shift
    "$python" -c "import $module" 2>/dev/null && return
    timeout 200 "$python" -m pip install --quiet --disable-pip-version-check --only-binary :all: \
        --retries 1 --timeout 10 "$@" \
        >"$test_folder/err" 2>&1 && "$python" -c "import $module" 2>/dev/null
}

# with_readers SCRIPT MODULES FILE...: each of these modules reads the files by a script of this
# folder.
readers=('h5py h5py' 'pyh5md h5py pyh5md')
[ "$share" = few ] || readers+=('ase ase' 'ovito ovito' 'MDAnalysis h5py MDAnalysis' 'vtk vtk')
with_readers() {
    local script=$1 known=$2 reader module packages
    shift 2
    for reader in "${readers[@]}"; do
        read -r module packages <<<"$reader"
        [[ " $known " == *" $module "* ]] || continue
        if has "$module" $packages; then
            n_read=$((n_read + 1))
            "$python" "$tests/$script.py" "$module" "$@" || complain "$module, $script"
        else
            skip "$module is not to be had: $(tail -n 1 "$test_folder/err")"
        fi
    done
}

scene=("$CARROM_SOURCE_DIR/inputs/gas.toml" --set discs.count=300 --set discs.speed=2 \
    --quiet --steps 20)
run 2 run "${scene[@]}" --set output.text=every_step --output lines -o run \
    --set output.trajectory.every_steps=5 \
    --set output.collisions=true --report report.json
expect_code 0 'a run'

with_readers readers 'h5py pyh5md MDAnalysis vtk' lines run/trajectory.h5 \
    run/checkpoints/checkpoint-000000000020.h5

# Two species in a box that is periodic along x: radii, types, box and sides as they are.
cat >mixed.toml <<'END'
[box]
size = 60
left.kind = "periodic"
right.kind = "periodic"
[discs]
speed = 1
[[discs.species]]
count = 20
radius = 2
mass = 4
[[discs.species]]
count = 60
radius = 0.957
[time]
steps = 20
END
run 2 run mixed.toml --quiet --set output.text=every_step --output mixed_lines -o mixed \
    --set output.trajectory.every_steps=5
expect_code 0 'a run of two species'
last=mixed/checkpoints/checkpoint-000000000020.h5
for file in mixed/trajectory.h5 "$last"; do
    run 1 convert "$file" --to xyz --output "$(basename "$file" .h5).xyz"
    expect_code 0 "convert $file"
done
with_readers readers_of_mixtures 'h5py ase ovito MDAnalysis vtk' mixed_lines mixed/trajectory.h5 \
    "$last" trajectory.xyz checkpoint-000000000020.xyz

# Flights around a periodic box: image counts, on other machine shapes and across a restart, too.
{ periodic_box 10; cat; } >flights.toml <<'END'
[discs]
count = 100
radius = 0.2
speed = 7
[time]
steps = 60
sync_every = 7
method = "event-driven"
[output.trajectory]
every_steps = 5
precision = "double"
END
run 2 run flights.toml --quiet -o free --set effects.contact.kind=none \
    --set output.units.length=nm --set output.units.time=ps
expect_code 0 'flights'
run 1 info free/trajectory.h5
grep -q 'fields *position velocity image$' "$test_folder/out" ||
    complain "info of a trajectory with images: $(cat "$test_folder/out")"
measured=(--set 'output.measurements.quantities=["displacement"]'
    --set output.measurements.every_steps=5)
run 3 run flights.toml --quiet -o flights "${measured[@]}"
expect_code 0 'flights that meet'
run 1 run flights.toml --quiet -o resumed --steps 33
run 2 run -o resumed --resume --quiet --steps 60
expect_code 0 'flights that go on'
with_readers readers_of_flights 'h5py MDAnalysis' {free,flights,resumed}/trajectory.h5 \
    flights/measurements/displacement.csv

if has h5py h5py; then # the worked example of the method's page, against a run on three ranks
    method=$CARROM_SOURCE_DIR/docs/understanding/method.md
    cp "$method" method.md
    MPIEXEC=$CARROM_MPIEXEC timeout 60 "$python" "$tools/three_strips.py" \
        --program "$CARROM_PROGRAM" --page method.md || complain 'three_strips.py'
    expect_same "$method" method.md 'three_strips.py writes another table than the page has'
fi
if has matplotlib matplotlib && has h5py h5py; then
    "$python" "$tools/method_figures.py" --output . || complain 'method_figures.py'
else
    skip "matplotlib or h5py is not to be had: $(tail -n 1 "$test_folder/err")"
fi
[ "$n_read" -gt 0 ] || [ "$n_failures" -gt 0 ] || exit 77
finish
