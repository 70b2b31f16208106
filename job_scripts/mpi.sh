# SPDX-License-Identifier: BSD-3-Clause
# How each MPI library wants its ranks started. To be sourced by setup.sh and launch.sh.

# mpi_library LAUNCHER: openmpi, mpich (and what is made from it), or unknown
mpi_library() {
    case $("$1" --version 2>&1 </dev/null) in
        *'Open MPI'* | *OpenRTE* | *PRRTE*) echo openmpi ;;
        *HYDRA* | *Intel*MPI*) echo mpich ;;
        *) echo unknown ;;
    esac
}

# bind_to_cores LAUNCHER THREADS: the launcher's words for ranks that have THREADS cores each to
# themselves
bind_to_cores() {
    case $(mpi_library "$1") in
        openmpi) echo "--map-by slot:PE=$2" ;;
        mpich) echo "-bind-to core:$2" ;;
    esac
}

# srun_plugin PROGRAM: what `srun --mpi` takes for the MPI library that the program names. The
# program can be a script that starts another one, as a wheel has it, so it is asked itself.
srun_plugin() {
    case $("$1" --version 2>/dev/null </dev/null | grep '^MPI ') in
        *'CRAY MPICH'*) echo cray_shasta ;;
        *MPICH* | *MVAPICH* | *Intel*) echo pmi2 ;;
        *) echo pmix ;;
    esac
}

# cores: those that this process may use; nproc by itself takes OMP_NUM_THREADS for their number
cores() { env -u OMP_NUM_THREADS -u OMP_THREAD_LIMIT nproc; }

# whole_cores: as `cores`, but two hardware threads of one core count once
whole_cores() {
    local whole
    whole=$(lscpu -p=core,socket 2>/dev/null | grep -v '^#' | sort -u | wc -l) || whole=0
    if [ "$whole" -ge 1 ] && [ "$whole" -lt "$(cores)" ]; then echo "$whole"; else cores; fi
}

# use_mpi_settings WORKERS: exports what mpi_settings.txt says for so many threads of all ranks
# together
use_mpi_settings() {
    local when setting name
    while read -r when setting; do
        case $when in
            always) ;;
            crowded) [ "$1" -gt "$(cores)" ] || continue ;;
            *) continue ;;
        esac
        name=${setting%%=*}
        [ -v "$name" ] || export "$name=${setting#*=}"
    done <"$(dirname "${BASH_SOURCE[0]}")/mpi_settings.txt"
}
