#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Checkpoints that cannot be written: exit code 4 and a message within a minute on 1 and 3 ranks,
# and the last good checkpoint stays. A full disk is a small tmpfs, and strace simulates failing
# disks. Both are tested only where mounting and tracing work. Arguments: "few" or "all" of the
# faults, the libraries that make writes short and that keep std::thread from starting.
source "$(dirname "$0")/common.sh"
faults=$1 short_writes=$2 no_threads=$3
scene=("$CARROM_SOURCE_DIR/inputs/gas.toml" --set discs.count=20000 --set discs.speed=2 --steps 30 \
    --quiet
       --set output.checkpoint.every_steps=10)

failed() {
    expect_code 4 "$1"
    expect_told "$2" "$1"
    grep '^,' "$test_folder/err" && complain "a message of two lines: $1"
}
goes_on_from() { # FOLDER STEP WHAT
    [ "$(ls "$1/checkpoints")" = "$(printf 'checkpoint-%012d.h5' "$2")" ] ||
        complain "not the last good checkpoint alone: $3: $(ls "$1/checkpoints")"
    run 1 run --restart "$1" --steps "$2" --quiet
    expect_code 0 "going on after $3"
}

mkdir tiny
if mount -t tmpfs -o size=4m tmpfs tiny 2>/dev/null; then
    trap 'umount "$test_folder/files/tiny"' EXIT
    for ranks in 1 3; do
        for transfers in independent collective; do
            rm -rf tiny/*
            run "$ranks" run "${scene[@]}" --set output.folder=tiny/kept \
                --set output.checkpoint.transfers="$transfers"
            failed 'a full disk' 'No space left on device'
            goes_on_from tiny/kept 10 'a full disk'
        done
        mount -o remount,ro tiny
        run "$ranks" run "${scene[@]}" --set output.folder=tiny/kept --overwrite
        failed 'a read-only disk' 'Read-only file system'
        mount -o remount,rw tiny
    done
else
    echo 'skipped: a full and a read-only disk (mounting a tmpfs is not allowed here)'
fi

# fault RANK INJECTION: strace makes calls of this rank on the second checkpoint's file fail.
cat >traced.sh <<'END'
#!/bin/sh
rank=$1 injection=$2
shift 2
[ "${OMPI_COMM_WORLD_RANK:-${PMI_RANK:-0}}" = "$rank" ] || exec "$@"
# On a busy disk writing a trace would delay the rank.
[ "$injection" = none ] && action=trace=pwrite64 to=trace || action=inject=$injection to=/dev/null
# The file is renamed relative to a handle of the run's folder.
name=checkpoints/checkpoint-000000000020.h5.partial
exec strace -f -o "$to" -P "$PWD/kept/$name" -P "$name" -e "$action" "$@"
END
chmod +x traced.sh
# traced RANK INJECTION: runs three ranks, of which one is traced.
traced() {
    rm -rf kept
    timeout --kill-after=5 60 "$CARROM_MPIEXEC" -n 3 ./traced.sh "$1" "$2" "$CARROM_PROGRAM" run \
        "${scene[@]}" "${transfers[@]}" \
        --set output.folder="$PWD/kept" >"$test_folder/out" 2>"$test_folder/err"
    code=$?
}
fault() {
    traced "$1" "$2"
    failed "$2 on rank $1" "checkpoint-000000000020.h5"
    [ "$leaves_partial" = no ] || rm -f kept/checkpoints/*.partial
    goes_on_from kept 10 "$2 on rank $1"
}
if strace -o /dev/null true 2>/dev/null; then
    transfers=() leaves_partial=no
    traced 0 none
    expect_code 0 'a run that is only traced'
    n_writes=$(grep -c 'pwrite64(' trace)
    [ "$n_writes" -gt 60 ] || complain "rank 0 has written $n_writes times only"
    fault 0 pwrite64:error=EIO:when=1   # the structure of the file, on its first write and later
    fault 0 pwrite64:error=EIO:when=$((n_writes / 2))        # its discs
    lasts=(0 8)
    [ "$faults" = few ] || lasts=(0 1 2 3 5 7 8 9)
    for last in "${lasts[@]}"; do
        # sums, checksums, HDF5's marks at opening and closing
        fault 0 pwrite64:error=EIO:when=$((n_writes - last))+
    done
    fault 1 pwrite64:error=ENOSPC:when=3
    fault 0 fsync:error=EIO:when=2      # the checksums
    fault 0 fallocate:error=ENOSPC:when=1
    fault 0 renameat:error=EIO:when=1
    if [ "$faults" = all ]; then
        fault 0 pwrite64:error=ENOSPC:when=20+
        fault 0 pwrite64:error=EIO:when=$((n_writes / 2))+   # its discs and all that follows
        fault 2 pwrite64:error=EIO:when=1+
        fault 0 fsync:error=EIO:when=1
        fault 2 fsync:error=EIO:when=1
        fault 0 pread64:error=EIO:when=1+
    fi
    # In collective transfers the other ranks wait for the one that has failed, until it ends the
    # run. The half file stays.
    leaves_partial=yes
    transfers=(--set output.checkpoint.transfers=collective)
    traced 0 none
    expect_code 0 'a collective run that is only traced'
    n_writes=$(grep -c 'pwrite64(' trace)
    fault 0 pwrite64:error=EIO:when=$((n_writes - 13))+ # its discs: nine writes, with nine to come
    fault 2 pwrite64:error=EIO:when=1+
else
    echo 'skipped: failing disks (strace is not there, or may not trace here)'
fi

# on_one_rank RANK SHELL_WORDS: runs three ranks; on one of them the shell runs these words before
# the program.
on_one_rank() {
    printf '#!/bin/sh\n[ "${OMPI_COMM_WORLD_RANK:-${PMI_RANK:-0}}" = %s ] && { %s; }\nexec "$@"\n' \
        "$1" "$2" >one.sh
    chmod +x one.sh
    rm -rf kept
    timeout --kill-after=5 60 "$CARROM_MPIEXEC" -n 3 ./one.sh "$CARROM_PROGRAM" run "${scene[@]}" \
        --set output.folder=kept \
        >"$test_folder/out" 2>"$test_folder/err"
    code=$?
}

# Short writes are no failure, because the next write continues them. If no thread can be
# started, the existing threads do all the work, so that is no failure either. (One thread is
# enough for the steps.)
scene+=(--threads 1)
for library in "$short_writes" "$no_threads"; do
    for rank in 0 1; do
        on_one_rank "$rank" "export LD_PRELOAD=$library"
        expect_code 0 "$library on rank $rank"
        run 2 verify kept/checkpoints/checkpoint-000000000030.h5
        expect_code 0 "after $library on rank $rank"
    done
done
# A limit to the size of files that ends within this rank's share: one write ends early, the next
# ones are errors. The limit of 8 MiB leaves room for the files through which MPI shares memory,
# because Open MPI 5 is set to make them as small as Open MPI 4 does; a checkpoint has 16 MiB.
export OMPI_MCA_btl_sm_segment_size=4194304
scene+=(--set discs.count=200000 --set discs.speed=0.5)
on_one_rank 1 "ulimit -f 16384"
failed 'a limit to the size of files on rank 1' 'checkpoint-000000000010.h5'
[ -z "$(ls kept/checkpoints)" ] || complain \
    "a file is left though none was written whole: $(ls kept/checkpoints)"
finish
