#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A job script that is not submitted reports this with exit code 2, and writes nothing, in the
# checkout's top and elsewhere.
source "$CARROM_SOURCE_DIR/tests/system/common.sh"
unset SLURM_JOB_ID

mkdir top && ln -s "$CARROM_SOURCE_DIR/job_scripts" top/job_scripts
for script in "$CARROM_SOURCE_DIR"/job_scripts/*.sbatch; do
    name=$(basename "$script")
    for folder in top .; do
        (cd $folder && bash "$script") >"$test_folder/out" 2>"$test_folder/err"
        code=$?
        expect_code 2 "$name in $folder"
        expect_told 'submit this with sbatch from the top of the checkout' "$name in $folder"
        expect_silence "$name in $folder"
        grep -qF 'unbound variable' "$test_folder/err" && { complain "$name in $folder"; show; }
    done
done
[ "$(ls -A)" = top ] && [ "$(ls -A top)" = job_scripts ] || complain "files were written"

# The plugin of srun follows from the MPI library that the program prints, also if the program is a
# script.
source "$CARROM_SOURCE_DIR/job_scripts/mpi.sh"
while IFS='|' read -r library plugin; do
    printf '#!/bin/sh\n[ "$1" = --version ] && echo "MPI       %s"\n' "$library" >program
    chmod +x program
    [ "$(srun_plugin ./program)" = "$plugin" ] ||
        complain "$library is started by $(srun_plugin ./program), not $plugin"
done <<'LIBRARIES'
Open MPI v4.1.4|pmix
Open MPI v5.0.7|pmix
MPICH Version: 4.0.2|pmi2
MPI VERSION    : CRAY MPICH version 8.1.25.17 (ANL base 3.4a2)|cray_shasta
Intel(R) MPI Library 2021.10 for Linux* OS|pmi2
MVAPICH2 Version      :|pmi2
LIBRARIES
case $("$CARROM_PROGRAM" --version | grep '^MPI ') in
*'Open MPI'*) wanted=pmix ;;
*) wanted=pmi2 ;;
esac
[ "$(srun_plugin "$CARROM_PROGRAM")" = $wanted ] || complain "the program is not started by $wanted"
grep -lE '^#SBATCH.*--hint' "$CARROM_SOURCE_DIR"/job_scripts/*.sbatch &&
    complain 'Slurm refuses --hint beside --cpu-bind, which launch.sh has'
finish
