#!/usr/bin/env bash
# check.sh JVARI: a suite on a Slurm cluster that loses a node and a task, against the same suite in one process. Three nodes on loopback,
# all of them this machine; what it starts it ends, by their ids. 77: there is no Slurm here.
set -euo pipefail
jvari=$(realpath "$1")
here=$(realpath "$(dirname "$0")")
for program in slurmctld slurmd sbatch squeue scancel; do
    command -v $program >/dev/null || { echo "skipped: $program is not installed (Debian: slurm-wlm)"; exit 77; }
done
dir=$(mktemp -d "${TMPDIR:-/tmp}/jvari-slurm-XXXXXX")
export SLURM_CONF=$dir/slurm.conf JVARI_CACHE= JVARI_NODE_MODULES=/nowhere

free() { ! (exec 3<>"/dev/tcp/127.0.0.1/$1") 2>/dev/null; }
port=$((20000 + $$ % 9000 * 4))
until free $port && free $((port + 1)) && free $((port + 2)) && free $((port + 3)); do port=$((port + 4)); done

# auth/none, no accounting, no cgroups: a cluster for this test alone. Nodes spread what they get (LLN), or the first would get it all.
host=$(hostname -s) user=$(id -un)
mkdir "$dir"/state "$dir"/spool "$dir"/log "$dir"/run
cat > "$SLURM_CONF" <<CONF
ClusterName=jvari
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
AuthType=auth/none
CredType=cred/none
AuthInfo=cred_expire=5
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
SlurmUser=$user
SlurmdUser=$user
StateSaveLocation=$dir/state
SlurmdSpoolDir=$dir/spool/%n
SlurmctldPidFile=$dir/run/slurmctld.pid
SlurmdPidFile=$dir/run/%n.pid
SlurmctldLogFile=$dir/log/slurmctld.log
SlurmdLogFile=$dir/log/%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_interval=2
MpiDefault=none
SwitchType=switch/none
ReturnToService=2
SlurmdTimeout=6
SlurmctldTimeout=10
KillWait=5
MinJobAge=300
SlurmdParameters=config_overrides
MaxArraySize=1001
CONF
for k in 1 2 3; do
    echo "NodeName=v$k NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + k)) CPUs=2 RealMemory=1000 State=UNKNOWN" >> "$SLURM_CONF"
done
echo "PartitionName=all LLN=YES Nodes=ALL Default=YES MaxTime=INFINITE State=UP" >> "$SLURM_CONF"

ended() { for _ in $(seq 100); do kill -0 "$1" 2>/dev/null || return 0; sleep 0.1; done; return 1; }
# Processes of tasks of this cluster on a node, by what their environment says: ID PARENT, the parent being Slurm's step daemon.
tasks() {
    local p
    for p in /proc/[0-9]*; do
        { tr '\0' '\n' < "$p/environ" | grep -qx "SLURM_CONF=$SLURM_CONF" && tr '\0' '\n' < "$p/environ" | grep -qx "SLURMD_NODENAME=$1"; } 2>/dev/null &&
            [ "$(readlink "$p/exe")" = "$jvari" ] && awk '{ print $1, $4 }' "$p/stat" 2>/dev/null || true
    done
}
finish() {
    local code=$? p
    trap - EXIT INT TERM
    [ $code = 0 ] || tail -n 40 "$dir"/log/slurmctld.log "$dir"/all/slurm/* 2>/dev/null || true
    squeue -h -o %A 2>/dev/null | sort -u | xargs -r scancel 2>/dev/null || true
    for node in v1 v2 v3; do tasks $node | while read -r task _; do kill -9 "$task" 2>/dev/null || true; done; done
    for p in "$dir"/run/v?.pid "$dir"/run/slurmctld.pid; do
        [ -s "$p" ] || continue
        p=$(cat "$p")
        kill "$p" 2>/dev/null || continue
        ended "$p" || kill -9 "$p" 2>/dev/null || true
    done
    rm -rf "$dir"
    exit $code
}
trap finish EXIT
trap 'exit 130' INT TERM

came_up() { for _ in $(seq 100); do [ "$(sinfo -h -N -t idle -o %N 2>/dev/null | sort -u | grep -c .)" = 3 ] && return 0; sleep 0.2; done; return 1; }
if ! { slurmctld -c && for k in 1 2 3; do slurmd -N v$k || exit 1; done && came_up; }; then
    echo "skipped: the daemons of Slurm do not come up on this machine"
    exit 77
fi

cd "$dir"
"$jvari" suite "$here/suite.toml" --out all --print slurm > job.sh
SHARDS=24 sh job.sh

# A task that is stopped is one that runs: what is ended now is ended in the middle of its work.
stopped_on() { # NODE: one task of a shard there, "ID PARENT"
    local task parent
    for _ in $(seq 600); do
        while read -r task parent; do
            grep -qz -- --shard "/proc/$task/cmdline" 2>/dev/null && kill -STOP "$task" 2>/dev/null || continue
            kill -0 "$task" 2>/dev/null && echo "$task $parent" && return 0
        done < <(tasks "$1")
        sleep 0.05
    done
    echo "no task was seen on $1" >&2
    return 1
}
read -r task parent < <(stopped_on v2)
kill -9 "$(cat run/v2.pid)" "$parent" "$task"                                         # a power cut: the daemons go first
tasks v2 | while read -r task parent; do kill -9 "$parent" "$task" 2>/dev/null || true; done
rm -f run/v2.pid
read -r task parent < <(stopped_on v1)
kill -9 "$task"                                                                       # as for its memory: Slurm calls that task failed

wait_for_all() { for _ in $(seq 480); do [ -n "$(squeue -h)" ] || return 0; sleep 0.5; done; squeue; return 1; }
# Meanwhile the same in one process.
"$jvari" suite "$here/suite.toml" --out whole --quiet > /dev/null
wait_for_all
grep -q "missing:" all/slurm/gather || { echo "nothing was lost"; cat all/slurm/gather; exit 1; }
requeued=$(grep -c "due to failure of node v2" log/slurmctld.log || true)
[ "$requeued" -ge 1 ] || { echo "no task of the lost node was put back"; exit 1; }
SHARDS=2 sh job.sh
wait_for_all
"$jvari" suite "$here/suite.toml" --out all --gather > last 2> said || { cat last said; exit 1; }
! grep " missing:" said
for table in errors.csv maps.csv boundaries.csv convergence.csv; do cmp whole/$table all/$table; done
echo "24 shards on three nodes, $requeued put back, one lost: $(wc -l < all/errors.csv) rows, as one process writes them"
