#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# A job script that is not submitted says so plainly, with exit code 2, and writes nothing: in the
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
finish
