#!/usr/bin/env bash
# check.sh JVARI PLUGIN: a suite by an array of Slurm that loses a node and a task, against the same
# suite in one process. Three nodes on loopback, all of them this machine; what it starts it ends,
# by their ids. PLUGIN: held_scheme.cpp, whose runs stop in the middle where the test wants to end
# them, so that nothing here depends on how fast the machine is. 77: there is no Slurm here.
set -euo pipefail
jvari=$(realpath "$1") plugin=$(realpath "$2")
here=$(realpath "$(dirname "$0")")
PATH=$PATH:/usr/sbin:/sbin
for program in slurmctld slurmd sbatch squeue scancel; do
    command -v $program >/dev/null ||
        { echo "skipped: $program is not installed (Debian: slurm-wlm)"; exit 77; }
done
dir=$(mktemp -d "${TMPDIR:-/tmp}/jvari-slurm-XXXXXX")
export SLURM_CONF=$dir/slurm.conf JVARI_HOLD=$dir/hold JVARI_CACHE= JVARI_NODE_MODULES=/nowhere
say() { echo "$((SECONDS)) s: $*"; }

free() { ! (exec 3<>"/dev/tcp/127.0.0.1/$1") 2>/dev/null; }
port=$((10000 + $$ % 5000 * 4))  # below those that the system gives to outgoing connections
until free $port && free $((port + 1)) && free $((port + 2)) && free $((port + 3)); do
    port=$((port + 4))
done

# auth/none, no accounting, no cgroups: a cluster for this test alone. Nodes spread what they get
# (LLN), or the first would get it all.
host=$(hostname -s) user=$(id -un)
mkdir "$dir"/state "$dir"/spool "$dir"/log "$dir"/run "$JVARI_HOLD"
cat > "$SLURM_CONF" <<CONF
ClusterName=jvari
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
AuthType=auth/none
CredType=cred/none
AuthInfo=cred_expire=5
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
MessageTimeout=60
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
SlurmdTimeout=8
SlurmctldTimeout=10
KillWait=5
MinJobAge=300
SlurmdParameters=config_overrides
MaxArraySize=1001
CONF
for k in 1 2 3; do
    echo "NodeName=v$k NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + k))" \
        "CPUs=2 RealMemory=1000 State=UNKNOWN" >> "$SLURM_CONF"
done
echo "PartitionName=all LLN=YES Nodes=ALL Default=YES MaxTime=INFINITE State=UP" >> "$SLURM_CONF"

with() { grep -lzxF -- "$1" "${@:2}" 2>/dev/null || true; }  # those of the files that have the line
# Processes that this cluster began, by what their environment says; on one node.
ours() { with "SLURM_CONF=$SLURM_CONF" /proc/[0-9]*/environ; }
tasks_on() { with "SLURMD_NODENAME=$1" $(ours) /dev/null | cut -d/ -f3; }
step_of() {  # the daemon of Slurm that began a task, where it is still there
    local parent
    parent=$(sed -n 's/^PPid:\t//p' "/proc/$1/status" 2>/dev/null) || return 0
    [ "$(cat "/proc/$parent/comm" 2>/dev/null)" != slurmstepd ] || echo "$parent"
}
end() { [ -z "$*" ] || kill -9 "$@" 2>/dev/null || true; }
ended() { for _ in $(seq 100); do kill -0 "$1" 2>/dev/null || return 0; sleep 0.1; done; return 1; }
finish() {
    local code=$? p
    trap - EXIT INT TERM
    if [ $code != 0 ] && [ $code != 77 ]; then
        tail -n 40 "$dir"/log/slurmctld.log "$dir"/task-* 2>/dev/null || true
        sinfo -N; squeue
    fi
    for node in v1 v2 v3; do for p in $(tasks_on $node); do end $(step_of "$p") "$p"; done; done
    for p in "$dir"/run/v?.pid "$dir"/run/slurmctld.pid; do
        [ -s "$p" ] || continue
        p=$(cat "$p")
        kill "$p" 2>/dev/null || continue
        ended "$p" || end "$p"
    done
    end $(ours | cut -d/ -f3)
    rm -rf "$dir" 2>/dev/null || { sleep 1; rm -rf "$dir"; }
    exit $code
}
trap finish EXIT
trap 'exit 130' INT TERM

came_up() {
    for _ in $(seq 300); do
        [ "$(sinfo -h -N -t idle -o %N 2>/dev/null | sort -u | grep -c .)" = 3 ] && return 0
        sleep 0.2
    done
    return 1
}
start() { slurmctld -c && for k in 1 2 3; do slurmd -N v$k || return 1; done && came_up; }
if ! start; then
    tail -n 5 "$dir"/log/* || true
    echo "skipped: the daemons of Slurm do not come up on this machine"
    exit 77
fi

cd "$dir"
touch hold/v1 hold/v2
# The lines of docs/using.md, where the program has the plugin and the suite of the library is the
# test's.
mkdir -p build/release suites
printf '#!/bin/sh\nexec "%s" "$@" --plugin "%s"\n' "$jvari" "$plugin" > build/release/jvari
chmod +x build/release/jvari
cp "$here/suite.toml" suites/stability.toml
export JVARI_SUITES=$dir/suites SBATCH_OUTPUT=task-%a
sed -n "/^    sbatch <</,/^    END$/s/^    //p" "$here/../../docs/using.md" > lines
[ "$(wc -l < lines)" = 5 ] || { echo "docs/using.md has no five lines for Slurm"; exit 1; }
bash lines

held_on() {  # NODE: the task that stopped itself there
    local file
    for _ in $(seq 3000); do
        for file in hold/"$1".*; do
            grep -q '^State:.T' "/proc/${file##*.}/status" 2>/dev/null && echo "${file##*.}" &&
                return 0
        done
        sleep 0.1
    done
    echo "no task stopped itself on $1" >&2
    return 1
}
lost=$(held_on v2) killed=$(held_on v1)
say "a task is in the middle of its work on each of two nodes"
# a power cut: the daemons go first
end "$(cat run/v2.pid)"
for task in "$lost" $(tasks_on v2); do end $(step_of "$task") "$task"; done
rm -f run/v2.pid
# as for its memory: Slurm calls that task failed
end "$killed"

# A call that Slurm does not answer says nothing.
idle() { local jobs; jobs=$(squeue -h -o %A 2>/dev/null) && [ -z "$jobs" ]; }
wait_for_all() {
    for _ in $(seq 600); do
        ! idle || return 0
        sleep 0.5
    done
    echo "jobs are left after 5 minutes"
    return 1
}
# Meanwhile the same in one process.
build/release/jvari suite stability --out whole --quiet > /dev/null
wait_for_all
requeued=$(grep -c "due to failure of node v2" log/slurmctld.log || true)
[ "$requeued" -ge 1 ] || { echo "no task of the lost node was put back"; exit 1; }
cells=$(($(wc -l < whole/facts.csv) - 1)) ran=0
for n in $(sed -n "s/^$cells cells, \([0-9]*\) run, .*/\1/p" task-*); do ran=$((ran + n)); done
[ "$ran" -ge 1 ] && [ "$ran" -le "$cells" ] ||
    { echo "the tasks that came to their end ran $ran of $cells cells"; exit 1; }
for table in facts errors maps boundaries convergence; do cmp whole/$table.csv maps/$table.csv; done
build/release/jvari suite stability --out maps --resume > last
grep -q "^$cells cells, 0 run, 0 timed, " last
[ -z "$(find maps -name '*.lock')" ] || { find maps -name '*.lock'; exit 1; }
say "8 tasks on three nodes, $requeued put back, one lost: $cells rows, as one process writes them"
