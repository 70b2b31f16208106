#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# One notebook of docs/tutorials, executed as Jupyter would, in 90 seconds on two cores. Git has it
# without outputs. Arguments: the folder of environments, and the notebook's name.
source "$(dirname "$0")/../system/common.sh"
source "$(dirname "$0")/environment.sh"

use_environment "$1/package"
for needed in 'h5py h5py' 'numpy numpy' 'matplotlib matplotlib' 'PIL pillow' \
    'freud freud-analysis' \
    'nbformat nbformat' 'nbclient nbclient' 'ipykernel ipykernel' 'pandas pandas' \
    'xarray xarray'; do
    read -r module name <<<"$needed"
    has "$module" "$name" || skip_test "$name is not to be had: $(said)"
done
install_package
release_environment
unset MPLBACKEND # the notebook's own, which stores pictures
"$python" "$(dirname "$0")/notebook.py" "$CARROM_SOURCE_DIR/docs/tutorials/$2.ipynb" ||
    complain "$2"
finish
