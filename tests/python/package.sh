#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The package's own tests, with the real freud, MDAnalysis, ASE, OVITO and gsd where PyPI has them;
# then types and style. Argument: the folder of environments. If names of test files follow, only
# these are run, and need only h5py, numpy and pytest.
source "$(dirname "$0")/../system/common.sh"
source "$(dirname "$0")/environment.sh"

use_environment "$1/package"
for needed in 'h5py h5py' 'numpy numpy' 'pytest pytest'; do
    read -r module name <<<"$needed"
    has "$module" "$name" || skip_test "$name is not to be had: $(said)"
done
[ $# -gt 1 ] || for wanted in 'matplotlib matplotlib' 'PIL pillow' 'scipy.spatial scipy' \
    'imageio_ffmpeg imageio-ffmpeg' 'pandas pandas' 'xarray xarray' \
    'freud freud-analysis' 'MDAnalysis MDAnalysis' 'ase ase' 'ovito ovito' 'gsd.hoomd gsd' \
    'IPython ipython'; do
    read -r module name <<<"$wanted"
    has "$module" "$name" ||
        printf 'skipped: %s is not to be had: %s\n' "$name" "$(said)"
done
install_package
release_environment

# The working folder is not the checkout, so that the installed package is tested.
export PYTHONDONTWRITEBYTECODE=1
tests=$CARROM_SOURCE_DIR/tests/python/package
chosen=("${@:2}")
[ $# -gt 1 ] || chosen=(.)
"$python" -m pytest -q -rs -p no:cacheprovider "${chosen[@]/#/$tests/}" \
    --rootdir "$tests" || complain 'pytest'
[ $# -eq 1 ] || finish

for tool in mypy ruff; do
    has "$tool" "$tool" ||
        { printf 'skipped: %s is not to be had\n' "$tool"; continue; }
    cp -r "$package" "$tool-sources"
    cp -r "$tests" "$tool-sources/tests"
    case $tool in
    mypy) (cd mypy-sources && "$python" -m mypy --cache-dir=/dev/null) || complain 'mypy' ;;
    ruff)
        (cd ruff-sources && "$python" -m ruff check --no-cache .) || complain 'ruff check'
        (cd ruff-sources && "$python" -m ruff format --no-cache --check .) || complain 'ruff format'
        ;;
    esac
done
finish
