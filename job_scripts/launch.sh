# SPDX-License-Identifier: BSD-3-Clause
# Functions that the Slurm scripts share: they load modules, start and bind ranks, and write rows of
# tables. This file ends a script that Slurm does not run, so scripts source it before they use
# variables of Slurm.
#
# Slurm runs a copy of the script from another folder. Paths are relative to the folder of
# submission, which is the checkout's top.

say() { printf '%s\n' "$*" >&2; }
die() { say "${SLURM_JOB_NAME:-$(basename "$0")}: $*"; exit 2; }

[ -n "${SLURM_JOB_ID:-}" ] || die "submit this with sbatch from the top of the checkout;" \
    "./job_scripts/run_local.sh runs without Slurm"
source job_scripts/mpi.sh

# load_modules: loads the modules that MODULES names
load_modules() {
    [ -n "$MODULES" ] || return 0
    set +u # module systems use variables that are not set
    module load $MODULES
    set -u
}

# launch_with RANKS THREADS: loads modules and sets `launch`, the words that come before the
# program. Uses MODULES, PROGRAM, LAUNCHER, LAUNCHER_OPTIONS and, if it is set, SRUN_MPI, the plugin
# of `srun --mpi` (default: pmix for Open MPI, pmi2 for MPICH, cray_shasta for that of Cray). Each
# rank is bound to THREADS cores of its own, and each of its threads to one of them, because a
# thread that moves leaves its memory behind; ranks fill one node after the other. OMP_PLACES and
# OMP_PROC_BIND may be set to something else.
launch_with() {
    local ranks=$1 threads=$2
    load_modules
    [ -x "$PROGRAM" ] || die \
        "no program $PROGRAM; build it, submit from the top of the checkout, or set PROGRAM"
    export OMP_NUM_THREADS=$threads
    export OMP_PLACES=${OMP_PLACES:-cores} OMP_PROC_BIND=${OMP_PROC_BIND:-close}
    case $LAUNCHER in
    srun)
        launch=(srun --mpi="${SRUN_MPI:-$(srun_plugin "$PROGRAM")}" --ntasks="$ranks"
                --cpus-per-task="$threads" --cpu-bind=cores)
        ;;
    *mpirun* | *mpiexec*) launch=("$LAUNCHER" -n "$ranks" $(bind_to_cores "$LAUNCHER" "$threads")) \
        ;;
    *) die "LAUNCHER is srun or mpirun, not $LAUNCHER" ;;
    esac
    launch+=($LAUNCHER_OPTIONS)
    say "$(date '+%F %T') job $SLURM_JOB_ID on $SLURM_JOB_NODELIST: ${launch[*]}"
}

# report_value FILE KEY: prints a number or text of a report.
report_value() { sed -n "s/^ *\"$2\": \"\{0,1\}\([^\",]*\)\"\{0,1\},\{0,1\}\$/\1/p" "$1"; }

# add_row TABLE REPORT: appends a run of a scaling study to the table, as a line of CSV.
add_row() {
    local row key
    [ -s "$1" ] || echo 'ranks,threads,n_discs,steps,wall_seconds,ns_per_disc_step,state_hash' \
        >>"$1"
    for key in ranks threads n_discs steps wall_seconds ns_per_disc_step state_hash; do
        row=${row:+$row,}$(report_value "$2" "$key")
    done
    printf '%s\n' "$row" >>"$1" # one short write: tasks of an array may do it at the same time
}
