# SPDX-License-Identifier: BSD-3-Clause
# Python environments of tests, from PyPI, kept in a folder. To be sourced after common.sh, which
# has set CARROM_SOURCE_DIR. Tests that run at the same time wait for each other while they install.

skip_test() {
    printf 'skipped: %s\n' "$*"
    exit 77
}

# The package finds the program and the launcher by these variables.
export CARROM=$CARROM_PROGRAM CARROM_MPIEXEC OMP_NUM_THREADS=1 MPLBACKEND=Agg
package=$CARROM_SOURCE_DIR/src/python

# said [N]: prints the last line, or the last N lines, of a command's standard error
said() { tail -n "${1:-1}" "$test_folder/err"; }

# copy_package FOLDER: copies the package, because pip writes beside the sources. In the copy
# LICENSE is a file, not a link.
copy_package() {
    rm -rf "$1"
    mkdir -p "$1"
    tar -C "$package" -h --exclude=__pycache__ --exclude=build --exclude='*.egg-info' -cf - . |
        tar -C "$1" -xf -
}

# use_environment FOLDER: sets `python`; the environment is kept for later tests
use_environment() {
    mkdir -p "$1"
    exec 9>"$1.lock"
    flock 9
    python=$1/bin/python
    [ -x "$python" ] && "$python" -m pip --version >/dev/null 2>&1 ||
        python3 -m venv --clear "$1" >"$test_folder/err" 2>&1 ||
        skip_test "no Python environment can be made: $(said)"
    "$python" -c 'import sys; sys.exit(sys.version_info < (3, 9))' ||
        skip_test 'the package needs Python 3.9'
}
release_environment() { flock -u 9; }

install() {
    timeout 400 "$python" -m pip install --quiet --disable-pip-version-check --retries 1 \
        --timeout 10 "$@" >"$test_folder/err" 2>&1
}

# has MODULE PACKAGE...: whether Python has the module; if not, installs the packages from PyPI
has() {
    local module=$1
    shift
    "$python" -c "import $module" 2>/dev/null && return
    install --only-binary :all: "$@" && "$python" -c "import $module" 2>/dev/null
}

# install_package: installs the package from the present sources, without its dependencies
install_package() {
    copy_package "$test_folder/package"
    has setuptools setuptools wheel || skip_test "no setuptools: $(said)"
    has wheel wheel || skip_test "no wheel: $(said)"
    install --no-deps --no-build-isolation --force-reinstall "$test_folder/package" ||
        { complain "pip cannot install the package: $(said 3)"; finish; }
}
