#!/bin/bash
# cluster.sh MOTE: starts a Slurm of one node on the loopback interface, from a folder of its own;
# submits harness/scripts/cluster/bench.sbatch as an array of 4; stops the programs of two tasks, one by
# SIGKILL and one by SIGTERM, so that Slurm queues them again; waits for the dependent merge; and
# compares all cells with a run of one process. Stops everything that it started. Needs root, munge
# and slurm-wlm; no systemd, no cgroups.
set -euo pipefail
mote=$(realpath "$1")
root=$(realpath "$(dirname "$0")/../..")
work=$(mktemp -d /tmp/mote-cluster-XXXXXX)
pids=()
fail()
{
    echo "cluster.sh: $*" >&2
    tail -n 20 "$work"/*.log "$work"/out/*.log >&2 || true
    exit 1
}
# Stops only processes started here, by number; the controller first, so that it starts no more.
stop()
{
    local pid
    if [ -n "${job:-}" ]; then
        scancel --user=root 2> /dev/null || true
        for _ in $(seq 40); do
            [ -n "$(squeue -h 2> /dev/null)" ] || break
            sleep 0.5
        done
    fi
    for pid in "${pids[@]}"; do
        kill "$pid" 2> /dev/null || true
        wait "$pid" 2> /dev/null || true
    done
    rm -rf "$work"
}
trap stop EXIT

# free_port FROM: the first port of the loopback interface without a listener.
free_port()
{
    local port=$1
    while (: < "/dev/tcp/127.0.0.1/$port") 2> /dev/null; do port=$((port + 1)); done
    echo "$port"
}

start_slurm()
{
    local host
    host=$(hostname -s)
    mkdir -m 700 "$work"/{munge,state,spool}
    head -c 128 /dev/urandom > "$work/munge/key"
    chmod 600 "$work/munge/key"
    chmod 755 "$work"
    munged --foreground --key-file="$work/munge/key" --socket="$work/munge/socket" \
        --pid-file="$work/munge/pid" --log-file="$work/munge/log" --seed-file="$work/munge/seed" \
        --origin=127.0.0.1 --force > "$work/munged.log" 2>&1 &
    pids+=($!)
    cat > "$work/slurm.conf" <<CONF
ClusterName=mote
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$(free_port 16817)
SlurmdPort=$(free_port 16917)
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket,cred_expire=10
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SelectType=select/linear
SchedulerType=sched/backfill
SchedulerParameters=batch_sched_delay=1,sched_interval=2,bf_interval=2
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ReturnToService=2
KillWait=5
MinJobAge=600
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
    export SLURM_CONF=$work/slurm.conf
    slurmctld -D > "$work/slurmctld.out.log" 2>&1 &
    pids=($! "${pids[@]}")
    slurmd -D > "$work/slurmd.out.log" 2>&1 &
    pids=("${pids[0]}" $! "${pids[@]:1}")
    for _ in $(seq 60); do
        [ "$(sinfo -h -o %T 2> /dev/null)" != idle ] || return 0
        sleep 0.5
    done
    fail "no node became idle"
}

cells() { find "$1/cells" -name '*.json' 2> /dev/null | sort; }

# state TASK: the state of a task of the array, or "" when Slurm no longer knows it.
state() { scontrol show job "${job}_$1" 2> /dev/null | sed -n 's/.*JobState=\([A-Z_]*\).*/\1/p' | sed 1q; }

# Whether a port has listeners, and all of them listen on 127.0.0.1 only.
on_loopback()
{
    local port
    port=$(printf %04X "$(sed -n "s/^$1=//p" "$work/slurm.conf")")
    cat /proc/net/tcp /proc/net/tcp6 | awk -v port="$port" '
        $4 == "0A" && $2 ~ ":" port "$" { ++found; if ($2 != "0100007F:" port) exit 1 }
        END { exit !found }' || fail "$1 is not on the loopback interface alone"
}

start_slurm
on_loopback SlurmctldPort
on_loopback SlurmdPort
# More scenarios than tasks, so that one task has two; slow enough to be killed before they end.
arguments=(tt mv tw islands rigid-mv --frames 1-400 --replicates 3 --stride 1 --seed 7
    --method fcl-aabb --method certified --method particle:n=8 --method aabb-tree)
mkdir "$work/out"
cd "$root"
job=$(MOTE=$mote sbatch --parsable --array=1-4 --output="$work/out/task-%a.log" \
    harness/scripts/cluster/bench.sbatch "$work/out" "${arguments[@]}")
echo "array of 4: job $job"

# stop_task TASK SIGNAL AFTER: sends a signal to the task's program once AFTER cells are there, and
# remembers them.
stop_task()
{
    local shard=$work/out/shards/$1 victim='' pid id
    for _ in $(seq 2400); do
        [ "$(cells "$shard" | wc -l)" -lt "$3" ] || break
        sleep 0.05
    done
    id=$(scontrol show job "${job}_$1" | sed -n 's/^JobId=\([0-9]*\).*/\1/p' | sed 1q)
    for pid in $(scontrol listpids "$id" | awk 'NR > 1 { print $1 }'); do
        # Signals the parent of the process that measures a cell: both end.
        if [ "$(readlink "/proc/$pid/exe" 2> /dev/null)" = "$mote" ] &&
            [ "$(ps -o comm= -p "$(ps -o ppid= -p "$pid" | tr -d ' ')")" != mote ]; then
            victim=$pid
        fi
    done
    [ -n "$victim" ] || fail "task $1 has no program to be stopped"
    kill -STOP "$victim"
    cells "$shard" | xargs stat -c '%i %Y %s %n' > "$work/before-$1"
    kill "-$2" "$victim"
    kill -CONT "$victim" 2> /dev/null || true
    echo "task $1: SIG$2 with $(wc -l < "$work/before-$1") cells measured"
}

# went_on TASK CELLS: the finished cells are unchanged, and the second attempt continued from them.
went_on()
{
    local log=$work/out/task-$1.log before done
    before=$(wc -l < "$work/before-$1")
    done=$(sed -n "s/^plan: $2 cells, \([0-9]*\) of them done.*/\1/p" "$log" | tail -n 1)
    [ "$before" -lt "$2" ] || fail "task $1 was done before it could be stopped"
    grep -q 'Restarts=1' <<< "$(scontrol show job "${job}_$1")" || fail "task $1 was not queued again"
    stat -c '%i %Y %s %n' $(awk '{ print $4 }' "$work/before-$1") | cmp - "$work/before-$1" ||
        fail "task $1: cells were measured again"
    # The process of a cell may have ended after the count and before the signal.
    [ "$done" = "$before" ] || [ "$done" = $((before + 1)) ] ||
        fail "task $1 went on from $done cells, not from $before"
    echo "task $1: queued again, went on from $done of $2 cells; only the unfinished one was lost"
}

# Task 1 has two scenarios, 24 cells; task 2 has 12.
stop_task 1 KILL 5
stop_task 2 TERM 3

for _ in $(seq 600); do
    if [ -e "$work/out/summary.json" ] && [ -z "$(squeue -h)" ]; then break; fi
    sleep 0.5
done
[ -e "$work/out/summary.json" ] || { squeue >&2; fail "the merge never ran"; }
for task in 1 2 3 4; do
    [ "$(state $task)" = COMPLETED ] || fail "task $task: $(state $task)"
done
went_on 1 24
went_on 2 12

"$mote" run "${arguments[@]}" --out "$work/whole" > "$work/whole.log" 2>&1 || fail "the whole run"
compared=0
for shard in "$work"/out/shards/*; do
    [ "$(cells "$shard" | sed 's|.*/||; s/-r[0-9].*//' | sort -u | wc -l)" -ge 4 ] ||
        fail "$shard has not all methods of its scenario"
done
diff <(cells "$work/whole" | sed 's|.*/||') <(cells "$work/out" | sed 's|.*/||') ||
    fail "other cells than the whole run"
# Every column but the three times.
for csv in "$work"/whole/cells/*.csv; do
    cmp <(cut -d , -f 1,5- "$csv") <(cut -d , -f 1,5- "$work/out/cells/${csv##*/}") ||
        fail "${csv##*/}: other answers"
    compared=$((compared + 1))
done
[ $compared -eq 60 ] || fail "$compared cells compared, not 60"
# And of the summary: errors, contacts, replicates.
answers()
{
    "$mote" summarize "$1" --format csv | awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i)
        if ($i !~ /_ns_|ratio|heap|rss/) keep[i] = 1 } { line = ""
        for (i = 1; i <= NF; ++i) if (i in keep) line = line $i ","; print line }'
}
answers "$work/whole" > "$work/answers-whole"
answers "$work/out" > "$work/answers-out"
[ "$(wc -l < "$work/answers-whole")" -eq 21 ] || fail "not 20 rows of a summary"
diff "$work/answers-whole" "$work/answers-out" || fail "other summaries"
echo "60 cells of 20 configurations: the same as unsharded, times aside"
