# SPDX-License-Identifier: BSD-3-Clause
# How ranks are started with each MPI library. To be sourced by setup.sh and launch.sh.

# mpi_library LAUNCHER: prints openmpi, mpich (also for libraries that derive from it) or unknown
mpi_library() {
    case $("$1" --version 2>&1 </dev/null) in
        *'Open MPI'* | *OpenRTE* | *PRRTE*) echo openmpi ;;
        *HYDRA* | *Intel*MPI*) echo mpich ;;
        *) echo unknown ;;
    esac
}

# bind_to_cores LAUNCHER THREADS: prints the launcher's options that bind each rank to THREADS cores
# of its own
bind_to_cores() {
    case $(mpi_library "$1") in
        openmpi) echo "--map-by slot:PE=$2" ;;
        mpich) echo "-bind-to core:$2" ;;
    esac
}

# srun_plugin PROGRAM: prints the value of `srun --mpi` for the program's MPI library. The program
# itself prints the name of the library, because PROGRAM can be a script that starts another
# program, as in a wheel.
srun_plugin() {
    case $("$1" --version 2>/dev/null </dev/null | grep '^MPI ') in
        *'CRAY MPICH'*) echo cray_shasta ;;
        *MPICH* | *MVAPICH* | *Intel*) echo pmi2 ;;
        *) echo pmix ;;
    esac
}

# cores: prints how many cores this process may use; nproc alone would print OMP_NUM_THREADS
cores() { env -u OMP_NUM_THREADS -u OMP_THREAD_LIMIT nproc; }

# whole_cores: prints the same, but counts the hardware threads of a core once
whole_cores() {
    local whole
    whole=$(lscpu -p=core,socket 2>/dev/null | grep -v '^#' | sort -u | wc -l) || whole=0
    if [ "$whole" -ge 1 ] && [ "$whole" -lt "$(cores)" ]; then echo "$whole"; else cores; fi
}

# use_mpi_settings WORKERS: exports the settings of mpi_settings.txt for WORKERS threads of all
# ranks together
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
