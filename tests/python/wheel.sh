#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The wheel that brings the program: built, checked, installed into a fresh environment, and run
# where no other MPI is on the path. It is compared with README's scene and hash. Argument: the
# folder of environments; the build stays beside it.
source "$(dirname "$0")/../system/common.sh"
source "$(dirname "$0")/environment.sh"

for needed in libmpich-dev libhdf5-mpich-dev; do
    dpkg-query -W -f '${db:Status-Status}' "$needed" 2>/dev/null | grep -qx installed ||
        skip_test "the wheel is built with $needed, which is not installed"
done
unset CARROM CARROM_MPIEXEC # so that the wheel's own program and launcher are found
wheels=$test_folder/wheels
rm -rf "$wheels"
BUILD_DIR=$(realpath -m "$1/../wheel") "$package/wheel.sh" "$wheels" >out 2>err || {
    tail -n 5 err
    grep -q 'Could not find a version\|No matching distribution\|ConnectionError' err &&
        skip_test 'PyPI is not to be had'
    complain 'wheel.sh'
    finish
}
wheel=$(echo "$wheels"/carrom-*.whl)
case $wheel in *manylinux_2_*) ;; *) complain "the name says no platform: $wheel" ;; esac

# The wheel contains a license of each library, and the package's own license.
use_environment "$1/wheel_checks"
for tool in 'twine twine' 'check_wheel_contents check-wheel-contents'; do
    read -r module name <<<"$tool"
    has "$module" "$name" || printf 'skipped: %s is not to be had: %s\n' "$name" "$(said)"
done
release_environment
checks=$1/wheel_checks/bin
if [ -x "$checks/twine" ]; then
    "$checks/twine" check --strict "$wheel" >out 2>&1 || complain "twine: $(tail -n 3 out)"
fi
if [ -x "$checks/check-wheel-contents" ]; then
    "$checks/check-wheel-contents" "$wheel" >out 2>&1 || complain "contents: $(tail -n 3 out)"
fi
python3 -m zipfile -l "$wheel" | awk '{print $1}' >inside
grep -q 'dist-info/.*LICENSE$' inside || complain 'the wheel has no LICENSE'
for name in fmtlib gcc hdf5 highway librandom123 xxhash zlib; do
    grep -q "^carrom/licenses/$name.*\.txt$" inside || complain "no license of $name"
done
grep -q 'libmpi\|libmpich' inside && complain 'the wheel holds an MPI library'

# A fresh environment, and nothing but it on the path.
rm -rf "$1/wheel"
use_environment "$1/wheel"
install "$wheel" || skip_test "PyPI is not to be had: $(said)"
release_environment
fresh=$(realpath "$1/wheel")
alone() {
    timeout 120 env -i PATH="$fresh/bin" HOME="$HOME" OMP_WAIT_POLICY=passive "$@"
}

sed -n '/^```toml$/,/^```$/p' "$CARROM_SOURCE_DIR/README.md" | sed '/^```/d' >gas.toml
hash=$(sed -n 's/^state hash  //p' "$CARROM_SOURCE_DIR/README.md")
[ -s gas.toml ] && [ ${#hash} -eq 32 ] || complain "README has no scene or no hash"
# has_hash WORD...: runs a command and searches its output for the hash
has_hash() {
    n_runs=$((n_runs + 1))
    alone "$@" >out 2>&1 && grep -qx "state hash  $hash" out ||
        { complain "another hash than $hash: $*"; tail -n 3 out; }
}
has_hash "$fresh/bin/carrom" run gas.toml -o one --threads 1
has_hash "$fresh/bin/mpiexec" -n 2 carrom run gas.toml -o two --threads 1
grep -q '^machine     2 ranks' out || complain "not 2 ranks: $(grep machine out)"

cat >sweep.py <<'END'
import sys
import carrom

print(carrom.find_program())
print(carrom.program.find_launcher())
sweep = carrom.sweep("gas.toml", {"discs.packing": [0.1, 0.2]}, folder="sweep", ranks=2)
print(sweep.runs[1].state_hash)
END
alone "$fresh/bin/python" sweep.py >out 2>err || complain "the sweep: $(tail -n 2 err)"
[ "$(sed -n 3p out)" = "$hash" ] || complain "the sweep has another hash: $(cat out)"
[ "$(sed -n 2p out)" = "$fresh/bin/mpiexec" ] || complain "another launcher: $(cat out)"
case $(head -n 1 out) in "$fresh"/*) ;; *) complain "another program: $(head -n 1 out)" ;; esac

# carrom.Simulation in each Python that the wheel has a module for. The variable PYTHONS names
# others than those on the path, for wheel.sh too.
grep -o '^carrom/_core[^ ]*' inside >modules || complain 'the wheel has no extension'
cat modules
cat >simulate.py <<'END'
import sys
import carrom

sim = carrom.Simulation("gas.toml", threads=1)
sim.run(sim.last_step)
print(sim.state_hash, carrom.core_module.load().__file__)
END
grep -q '_core.cpython-31[2-9]' modules &&
    complain 'a module for one Python only, where the stable ABI would serve all later ones'
n_simulated=0
all=(python3.{9..14})
for python in ${PYTHONS:-${all[*]}}; do
    version=$("$python" -c 'import sys; print("%d%d" % sys.version_info[:2])' 2>/dev/null) ||
        continue
    grep -q "_core.cpython-$version-" modules ||
        { [ "$version" -ge 312 ] && grep -q '_core.abi3' modules; } || continue
    rm -rf "$1/wheel-$version"
    "$python" -m venv "$1/wheel-$version" >err 2>&1 || { tail -n 1 err; continue; }
    timeout 400 "$1/wheel-$version/bin/pip" install -q "$wheel" >err 2>&1 ||
        { printf 'skipped: Python %s: %s\n' "$version" "$(tail -n 1 err)"; continue; }
    own=$(realpath "$1/wheel-$version")
    timeout 120 env -i PATH="$own/bin" HOME="$HOME" OMP_WAIT_POLICY=passive \
        "$own/bin/python" simulate.py >out 2>err || complain "Python $version: $(tail -n 2 err)"
    grep -q "^$hash $own" out || complain "Python $version has another hash or module: $(cat out)"
    n_simulated=$((n_simulated + 1))
    printf 'Python %s: %s\n' "$version" "$(sed 's|.*/||' out)"
done
[ "$n_simulated" -gt 0 ] || complain 'no Python could try the extension'

# The launcher of another MPI would start independent copies of the program.
if other=$(command -v mpiexec.openmpi); then
    "$other" -n 2 "$fresh/bin/carrom" run gas.toml -o other >out 2>&1 &&
        complain 'two lone processes ran under the launcher of Open MPI'
    grep -q 'use the launcher of that library' out || complain "no word of it: $(tail -n 2 out)"
    [ ! -e other ] || complain 'they wrote a folder'
fi
finish
