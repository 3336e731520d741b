# slurm_cluster.sh: for tests to source: Slurm answers: the cluster that this machine belongs to, or one of the test's own,
# of this machine alone, in a folder that goes away with it. Else the test is skipped. Wants bash's set -e.
# After it: slurm_stop, to be called at the end.
slurm_folder=''

slurm_stop() {
    local file
    for file in "$slurm_folder"/{slurmd,slurmctld,munged}.pid; do
        [[ -n $slurm_folder && -s $file ]] && kill "$(<"$file")" 2>/dev/null
    done
    if [[ -n $slurm_folder ]]; then
        sleep 1 # they write down their state
        rm -rf "$slurm_folder"
    fi
}

slurm_skip() {
    echo "SKIPPED: $*"
    slurm_stop
    exit 77
}

slurm_wait_for() { # FILE
    local try
    for try in {1..100}; do
        [[ -s $1 ]] && return 0
        sleep 0.1
    done
    return 1
}

slurm_start() {
    command -v sbatch >/dev/null || slurm_skip "Slurm is not installed (slurm-wlm)"
    timeout 10 sinfo >/dev/null 2>&1 && return 0
    PATH=$PATH:/usr/sbin
    local name port try
    for name in munged slurmctld slurmd; do
        command -v "$name" >/dev/null || slurm_skip "no cluster answers, and there is no $name for one of the test's own"
    done
    ((EUID == 0)) || slurm_skip "no cluster answers, and only root can start one"
    slurm_folder=$(mktemp -d)
    mkdir "$slurm_folder/state" "$slurm_folder/spool"
    (umask 077 && head -c 1024 /dev/urandom >"$slurm_folder/key")
    name=$(hostname -s) port=$((20000 + $$ % 20000))
    cat >"$slurm_folder/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=$name(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$slurm_folder/munge.socket
CredType=cred/munge
SlurmctldPort=$port
SlurmdPort=$((port + 1))
StateSaveLocation=$slurm_folder/state
SlurmdSpoolDir=$slurm_folder/spool
SlurmctldPidFile=$slurm_folder/slurmctld.pid
SlurmdPidFile=$slurm_folder/slurmd.pid
SlurmctldLogFile=$slurm_folder/slurmctld.log
SlurmdLogFile=$slurm_folder/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_interval=1
ReturnToService=2
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
NodeName=$name NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=$name Default=YES MaxTime=INFINITE State=UP
CONF
    export SLURM_CONF=$slurm_folder/slurm.conf
    munged --force --key-file="$slurm_folder/key" --socket="$slurm_folder/munge.socket" \
        --pid-file="$slurm_folder/munged.pid" --log-file="$slurm_folder/munged.log" \
        --seed-file="$slurm_folder/seed" 2>/dev/null || slurm_skip "munged does not start"
    slurmctld -c >/dev/null 2>&1 && slurm_wait_for "$slurm_folder/slurmctld.pid" ||
        slurm_skip "slurmctld does not start: $(tail -n 1 "$slurm_folder/slurmctld.log" 2>/dev/null)"
    slurmd -N "$name" -c >/dev/null 2>&1 && slurm_wait_for "$slurm_folder/slurmd.pid" ||
        slurm_skip "slurmd does not start: $(tail -n 1 "$slurm_folder/slurmd.log" 2>/dev/null)"
    for try in {1..100}; do
        [[ $(timeout 10 sinfo --noheader --format=%t 2>/dev/null) == idle ]] && return 0
        sleep 0.2
    done
    slurm_skip "the cluster of one node does not come up: $(sinfo 2>&1 | tail -n 1)"
}
