#!/usr/bin/env bash
# A fleet on a real Slurm: a cluster of two nodes on the loopback of this machine runs the job array of
# `waymark fleet --slurm`. One node dies in the middle, with its task and the drive that it was running;
# Slurm starts the task again on the other node. The merged table must have the bytes that one machine
# gives. Needs root and the packages of tools/setup/install_packages.sh cluster, so no other test runs it:
#   tests/program/fleet/slurm.sh WAYMARK [DRIVES]
# Exit code 77: it cannot run here, and says why.
set -euo pipefail

waymark=$(realpath "${1:?usage: $0 WAYMARK [DRIVES]}")
count=${2:-12}
[[ $(id -u) -eq 0 ]] || { echo "SKIPPED: the daemons of Slurm need root"; exit 77; }
for program in slurmctld slurmd munged sbatch squeue scontrol; do
  command -v "$program" >/dev/null || {
    echo "SKIPPED: there is no $program; tools/setup/install_packages.sh cluster installs it"; exit 77; }
done

work=$(mktemp -d /tmp/waymark_slurm.XXXXXX)
chmod 755 "$work"
daemons=()
stop() {
  local status=$?
  [[ $status -eq 0 ]] || tail -n 20 "$work"/*.log "$work"/out/slurm/*.log 2>/dev/null || true
  for node in first second; do
    for process in $(processes_of "$node"); do kill -9 "$process" 2>/dev/null || true; done
  done
  for daemon in "${daemons[@]}"; do kill -9 "$daemon" 2>/dev/null || true; done
  rm -rf "$work"
  exit "$status"
}
trap stop EXIT

say() { printf '%s  %s\n' "$(date +%T)" "$*"; }

# Waits until a command succeeds. within SECONDS COMMAND...
within() {
  local end=$((SECONDS + $1)); shift
  until "$@"; do
    [[ $SECONDS -lt $end ]] || { echo "not within its time: $*" >&2; return 1; }
    sleep 0.2
  done
}

# ---- the cluster

start_cluster() {
  mkdir -m 700 "$work/munge" "$work/state"
  dd if=/dev/urandom of="$work/munge/key" bs=1024 count=1 status=none
  chmod 400 "$work/munge/key"
  mkdir -m 755 "$work/socket"
  munged --foreground --key-file="$work/munge/key" --socket="$work/socket/munge" \
    --pid-file="$work/munge/pid" --log-file="$work/munge/log" --seed-file="$work/munge/seed" \
    >"$work/munged.log" 2>&1 &
  daemons+=($!)
  within 10 test -S "$work/socket/munge"
  cat >"$work/slurm.conf" <<CONF
ClusterName=waymark
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort=16817
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$work/socket/munge
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool-%n
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd-%n.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SchedulerParameters=sched_interval=1,batch_sched_delay=1
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
JobRequeue=1
SlurmdTimeout=8
ReturnToService=2
MpiDefault=none
NodeName=first NodeHostname=localhost NodeAddr=127.0.0.1 Port=16821 CPUs=1
NodeName=second NodeHostname=localhost NodeAddr=127.0.0.1 Port=16822 CPUs=1
PartitionName=all Nodes=first,second Default=YES State=UP
CONF
  export SLURM_CONF=$work/slurm.conf
  slurmctld -D -i >"$work/slurmctld.out.log" 2>&1 &
  daemons+=($!)
  for node in first second; do
    mkdir -p "$work/spool-$node"
    WAYMARK_NODE=$node slurmd -D -N "$node" >"$work/slurmd-$node.out.log" 2>&1 &
    daemons+=($!)
  done
  within 30 both_idle
}

both_idle() { [[ $(sinfo -h -N -o %T 2>/dev/null | grep -c '^idle$') -eq 2 ]]; }

# The processes of a node: its daemon (the variable is set below), what its tasks run (the variable is
# Slurm's), and Slurm's keeper of each task. Without its keeper's death the task would only have failed.
processes_of() {
  local process keeper
  for process in $(grep -lzE "^(WAYMARK_NODE|SLURMD_NODENAME)=$1\$" /proc/[0-9]*/environ 2>/dev/null |
                   cut -d/ -f3 || true); do
    keeper=$(ps -o ppid= -p "$process" | tr -d ' ')
    [[ $(ps -o comm= -p "${keeper:-1}" 2>/dev/null) != slurmstepd ]] || echo "$keeper"
    echo "$process"
  done
}
# Holds a drive that runs on the first node, so that it cannot end before its node dies.
hold_a_drive() {
  local process
  for process in $(pgrep -f "run .* -o $work/out/running" || true); do
    grep -qz "^SLURMD_NODENAME=first\$" "/proc/$process/environ" 2>/dev/null || continue
    kill -STOP "$process" 2>/dev/null && return 0
  done
  return 1
}

# ---- the fleet

mkdir "$work/drives"
presets=(urban rural highway mixed)
for ((i = 0; i < count; ++i)); do
  "$waymark" simulate --preset "${presets[i % 4]}" --seed "$((i + 1))" --duration 120 \
    -o "$work/drives/$(printf %03d "$i")" -q
done
say "$count drives on one machine"
"$waymark" fleet "$work/drives" -o "$work/one" -q

start_cluster
say "Slurm $(slurmctld -V | cut -d' ' -f2), two nodes"
"$waymark" fleet "$work/drives" -o "$work/out" --slurm --per-task 3 -q

within 60 hold_a_drive
task=$(squeue -h -w first -t R -o %K | head -n 1)
mapfile -t dying < <(processes_of first)
say "node first dies with task $task: ${#dying[@]} processes, one of them with a drive"
kill -9 "${dying[@]}" 2>/dev/null || true
is_dead() { [[ -z $(processes_of first) ]]; }
within 5 is_dead

is_down() { [[ $(sinfo -h -n first -o %T) == down* ]]; }
within 60 is_down
say "Slurm has noticed: $(squeue -h -o '%i %T %r' | tr '\n' ';')"
# Slurm lets a task wait for two minutes before it starts again; a test does not.
restart_now() {
  local job
  for job in $(squeue -h -t PD -o %A); do scontrol update JobId="$job" StartTime=now 2>/dev/null || true; done
}
all_ended() { restart_now; [[ -z $(squeue -h -o %i) ]]; }
within 400 all_ended
grep -q . "$work/out/slurm/task-$task.log"
restarts=$(scontrol show job 2>/dev/null | grep -o 'Restarts=[1-9]' | head -n 1)
[[ -n $restarts ]] || { echo "no task was started again"; exit 1; }
say "all tasks ended, $restarts"

"$waymark" fleet status "$work/out" | head -n 6
"$waymark" fleet merge "$work/out" -q
for file in fleet.csv fleet.sqlite fleet.html; do
  cmp "$work/one/$file" "$work/out/$file"
done
say "the merged table, database and page have the bytes of one machine"
