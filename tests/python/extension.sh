#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# carrom.Simulation: builds the extension for this Python beside the environments, unless the
# variable CARROM_CORE names one, and runs its tests and the notebooks that need it. Arguments: the
# folder of environments, CMake.
source "$(dirname "$0")/../system/common.sh"
source "$(dirname "$0")/environment.sh"

use_environment "$1/package"
for needed in 'h5py h5py' 'numpy numpy' 'pytest pytest' 'nanobind nanobind' 'pandas pandas' \
    'xarray xarray' 'matplotlib matplotlib' 'IPython ipython' \
    'nbformat nbformat' 'nbclient nbclient' 'ipykernel ipykernel'; do
    read -r module name <<<"$needed"
    has "$module" "$name" || skip_test "$name is not to be had: $(said)"
done
has mpi4py mpi4py || printf 'skipped: mpi4py is not to be had: %s\n' "$(said)"
install_package
release_environment

if [ -z "${CARROM_CORE:-}" ]; then
    build=$(realpath -m "$1/../extension")
    "$2" -S "$CARROM_SOURCE_DIR" -B "$build" -DCARROM_PYTHON=ON -DCARROM_TESTS=OFF \
        -DCMAKE_UNITY_BUILD=ON -DPython_EXECUTABLE="$(realpath -s "$python")" >configured 2>&1 ||
        { tail -n 5 configured; grep -q 'Python' configured && skip_test 'no headers of Python'; }
    "$2" --build "$build" --target carrom_python --parallel 2 >built 2>&1 ||
        { tail -n 20 built; complain 'the extension is not built'; finish; }
    CARROM_CORE=$("$python" - "$build/python/carrom" <<'END'
import importlib.machinery
import sys
from pathlib import Path

names = [Path(sys.argv[1], f"_core{end}") for end in importlib.machinery.EXTENSION_SUFFIXES]
print(next(name for name in names if name.is_file()))
END
    )
fi
export CARROM_CORE PYTHONDONTWRITEBYTECODE=1
tests=$CARROM_SOURCE_DIR/tests/python/package
"$python" -m pytest -q -rs -p no:cacheprovider "$tests"/test_{simulation*,pages}.py \
    --rootdir "$tests" >out 2>&1 || complain 'pytest'
cat out
grep -q 'needs the extension' out && complain "CARROM_CORE is not taken: $CARROM_CORE"
unset MPLBACKEND # the notebooks' own, which stores pictures
for notebook in $(grep -l 'carrom\.Simulation(' "$CARROM_SOURCE_DIR"/docs/tutorials/*.ipynb); do
    "$python" "$(dirname "$0")/notebook.py" "$notebook" || complain "$notebook"
done
finish
