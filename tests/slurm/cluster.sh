# SPDX-License-Identifier: BSD-3-Clause
# A Slurm of our own on this machine, for as long as a test lasts: munge, a controller and two
# emulated nodes of 4 cores each, all in one folder and without a service manager. To be sourced
# after common.sh.
#
# Nodes may have more cores than the machine, because the tests are about starts, stops and
# continued runs, not about speed.

cluster_nodes=(n1 n2)

# Prints why there is no Slurm here, and ends the test as skipped.
skip_test() {
    printf 'skipped: %s\n' "$*"
    exit 77
}

# stop_process PID: sends TERM, and KILL after five seconds. For daemons, which are not children of
# this shell.
stop_process() {
    kill "$1" 2>/dev/null || return 0
    local i
    for ((i = 0; i < 50; ++i)); do
        kill -0 "$1" 2>/dev/null || return 0
        sleep 0.1
    done
    kill -KILL "$1" 2>/dev/null
}

stop_cluster() {
    local jobs
    jobs=$(timeout 10 squeue -h -o %A 2>/dev/null | sort -u)
    if [ -n "$jobs" ]; then
        timeout 10 scancel --signal=KILL --full $jobs 2>/dev/null
        timeout 10 scancel $jobs 2>/dev/null
        wait_until 10 no_jobs
    fi
    stop_daemons
    cp "$cluster"/*.log "$test_folder"
    [ ! -s "$cluster/run/munge.pid" ] || stop_process "$(cat "$cluster/run/munge.pid")"
    rm -rf "$cluster"
}
stop_daemons() {
    local file
    for file in "$cluster"/run/slurmd.*.pid "$cluster/run/slurmctld.pid"; do
        [ ! -s "$file" ] || stop_process "$(cat "$file")"
    done
}

# Prints a port such that nobody listens on it or on the next two ports.
free_ports() {
    local port i
    for ((i = 0; i < 50; ++i)); do
        port=$((10000 + RANDOM % 20000)) # below the ports that the system assigns itself
        if ! (
            for k in 0 1 2; do exec 3<>"/dev/tcp/127.0.0.1/$((port + k))" && exit 0; done
            exit 1
        ) 2>/dev/null; then
            printf '%s\n' "$port"
            return
        fi
    done
}

write_slurm_conf() {
    local host user port node number=0
    host=$(hostname -s) user=$(id -un) port=$(free_ports)
    cat <<END
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$cluster/run/munge.socket
CredType=cred/munge
StateSaveLocation=$cluster/state
SlurmdSpoolDir=$cluster/spool.%n
TmpFS=$cluster/tmp.%n
SlurmctldPidFile=$cluster/run/slurmctld.pid
SlurmdPidFile=$cluster/run/slurmd.%n.pid
SlurmctldLogFile=$cluster/slurmctld.log
SlurmdLogFile=$cluster/slurmd.%n.log
SlurmdParameters=config_overrides
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=1,sched_min_interval=0,bf_interval=1
SwitchType=switch/none
MpiDefault=none
ReturnToService=0
KillWait=5
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
PartitionName=main Nodes=n[1-2] Default=YES MaxTime=INFINITE State=UP
END
    for node in "${cluster_nodes[@]}"; do
        number=$((number + 1))
        mkdir -p "$cluster/spool.$node" "$cluster/tmp.$node"
        echo "NodeName=$node NodeHostname=$host NodeAddr=127.0.0.1" \
            "Port=$((port + number)) CPUs=4 RealMemory=1000 State=UNKNOWN"
    done
}

# Slurm must not use cgroups, which a container may lack. Slurm 22 searches for them nevertheless.
write_cgroup_conf() {
    local version
    version=$(slurmd -V) version=${version#* }
    if [ "${version%%.*}" -gt 22 ]; then echo 'CgroupPlugin=disabled'
    else echo 'CgroupAutomount=no'; fi
}

start_node() { slurmd -N "$1" -f "$SLURM_CONF"; }

# Waits until a command succeeds: wait_until SECONDS WORD...
wait_until() {
    local tries=$(($1 * 5)) i
    shift
    for ((i = 0; i < tries; ++i)); do
        "$@" && return 0
        sleep 0.2
    done
    return 1
}

no_jobs() { [ -z "$(squeue -h -o %A 2>/dev/null)" ]; }
nodes_are_idle() {
    [ "$(sinfo -h -N -t idle -o %N 2>/dev/null | wc -l)" -eq ${#cluster_nodes[@]} ]
}

# Starts all of it, or ends the test as skipped. Whatever has been started is stopped when the test
# ends.
start_cluster() {
    local program problem try
    PATH=$PATH:/usr/sbin:/sbin
    for program in munged slurmctld slurmd srun sbatch scontrol; do
        command -v "$program" >/dev/null || skip_test "$program is not installed"
    done
    # munge requires that everybody may enter the folders above its socket, which many home folders
    # do not allow.
    cluster=$(mktemp -d /tmp/carrom-slurm.XXXXXX)
    chmod 755 "$cluster"
    export SLURM_CONF=$cluster/slurm.conf
    trap stop_cluster EXIT
    (umask 022 && mkdir "$cluster/run" "$cluster/state" "$cluster/bin")
    # Calls the launcher of the build's own MPI, because several may be installed. It is not a link,
    # because MPICH searches for its parts beside the link.
    printf '#!/bin/sh\nexec "%s" "$@"\n' "$CARROM_MPIEXEC" >"$cluster/bin/mpirun"
    chmod +x "$cluster/bin/mpirun"
    export PATH=$cluster/bin:$PATH
    (umask 077 && head -c 128 /dev/urandom >"$cluster/munge.key")
    problem=$(munged --key-file="$cluster/munge.key" --socket="$cluster/run/munge.socket" \
        --pid-file="$cluster/run/munge.pid" --log-file="$cluster/run/munge.log" \
        --seed-file="$cluster/munge.seed" --num-threads=2 2>&1) ||
        skip_test "munged does not start: $problem"
    write_cgroup_conf >"$cluster/cgroup.conf"
    for try in 1 2 3; do # somebody else may take our ports
        write_slurm_conf >"$SLURM_CONF"
        start_daemons && return
        stop_daemons
    done
    skip_test "Slurm's daemons do not start: $(tail -n 5 "$cluster"/slurm*.log)"
}
start_daemons() {
    local node
    slurmctld -c -f "$SLURM_CONF" || return 1
    for node in "${cluster_nodes[@]}"; do start_node "$node" || return 1; done
    wait_until 10 nodes_are_idle
}

# submit SCRIPT WORD...: sets `job`. Scripts of job_scripts/ run at the checkout's top, as they are
# meant to; their logs come here.
submit() {
    local script=$1
    shift
    job=$(sbatch --parsable --chdir="$CARROM_SOURCE_DIR" --output="$PWD/%x-%j-%a.log" "$@" \
        "$CARROM_SOURCE_DIR/job_scripts/$script" 2>"$test_folder/err")
    [ -n "$job" ] || { complain "sbatch $script"; show; }
}

job_state() {
    scontrol show job -o "$1" 2>/dev/null | sed -n 's/.* JobState=\([A-Z_]*\).*/\1/p' |
        sort -u | tr '\n' ' '
}
has_state() { [ "$(job_state "$1")" = "$2 " ]; }
is_over() { [ -z "$(squeue -h -j "$1" -o %A 2>/dev/null)" ]; }

# ends_as JOB STATE SECONDS
ends_as() {
    wait_until "$3" is_over "$1"
    has_state "$1" "$2" && return
    complain "job $1 is $(job_state "$1")and not $2"
    tail -n 15 ./*-"$1"-*.log | sed 's/^/    /'
}

# restart JOB: lets a requeued job start again at once and on any node; Slurm would wait two
# minutes. It waits two seconds first, because Slurm distinguishes credentials of one job only by
# the second. Fails if the job is not requeued or does not start.
is_requeued() { scontrol show job -o "$1" | grep -q ' Restarts=[1-9]' && has_state "$1" PENDING; }
may_start() {
    scontrol update "JobId=$1" ReqNodeList= 2>/dev/null
    scontrol update "JobId=$1" StartTime=now 2>/dev/null
}
restart() {
    wait_until 30 is_requeued "$1" || return 1
    sleep 2.5
    may_start "$1"
    wait_until 30 has_state "$1" RUNNING || has_state "$1" COMPLETED
}

# Variables that jobs inherit. Emulated nodes share one machine: messages go through its loopback,
# and no rank is bound to a core.
export OMPI_MCA_btl=self,tcp OMPI_MCA_btl_tcp_if_include=lo PROGRAM=$CARROM_PROGRAM
