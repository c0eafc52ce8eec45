#!/usr/bin/env bash
# The scripts of contrib/slurm with a real Slurm, which is started here for this test: an array of six parts, one task
# requeued in its midst, the others preempted, and the dependent merge makes the picture of one render. Takes some
# minutes. With MPI_PROGRAM, one picture by two tasks of a job, too. Exit code 77: Slurm is not there.
# Usage: slurm_test.sh PROGRAM [MPI_PROGRAM]
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
kaustik=$(realpath "$1") kaustik_mpi=${2:+$(realpath "$2")}
source "$root/tests/support/script.sh"
for program in munged slurmctld slurmd sbatch; do
  command -v "$program" >/dev/null || PATH=$PATH:/usr/sbin
  command -v "$program" >/dev/null || { echo "skipped: no $program (packages munge, slurmctld, slurmd, slurm-client)"; exit 77; }
done

work=$(mktemp -d)
pids=()
end() {
  [[ ${1:-0} -eq 0 ]] || { tail -n 20 "$work"/*.log "$work"/scene.parts/log/* 2>/dev/null || true; } >&2
  # Else jobs would outlive their Slurm.
  if [[ -n $(squeue -h 2>/dev/null) ]]; then scancel --user="$(id -un)" && sleep 3; fi
  for pid in "${pids[@]}"; do kill "$pid" 2>/dev/null || true; done
  wait
  rm -rf "$work"
}
trap 'end $?' EXIT

# One node, two partitions: jobs of `high` preempt those of `low`.
mkdir "$work/state" "$work/spool" "$work/munge"
chmod 755 "$work"
chmod 700 "$work/munge"
dd if=/dev/urandom of="$work/munge/key" bs=1024 count=1 2>/dev/null
chmod 400 "$work/munge/key"
host=$(hostname -s)
port=$((20000 + RANDOM % 20000))
cat >"$work/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket,cred_expire=120
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MpiDefault=none
PreemptType=preempt/partition_prio
PreemptMode=REQUEUE
SchedulerParameters=sched_interval=1,batch_sched_delay=1,bf_interval=1
KillWait=10
ReturnToService=2
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=low Nodes=$host Default=YES PriorityTier=1 GraceTime=30 State=UP
PartitionName=high Nodes=$host PriorityTier=10 PreemptMode=OFF State=UP
CONF
export SLURM_CONF=$work/slurm.conf
munged --foreground --force --key-file="$work/munge/key" --socket="$work/munge/socket" --pid-file="$work/munge/pid" \
  --log-file="$work/munge/log" --seed-file="$work/munge/seed" >"$work/munged.log" 2>&1 &
pids+=($!)
until_true 20 munged test -S "$work/munge/socket"
slurmctld -D -i >"$work/slurmctld.log" 2>&1 &
pids+=($!)
slurmd -D -N "$host" >"$work/slurmd.log" 2>&1 &
pids+=($!)
is_idle() { [[ $(sinfo -h -p low -o %T 2>/dev/null) == idle ]]; }
until_true 60 "a node that is idle" is_idle

cp -r "$root/scenes/cornell_box/." "$work"
mv "$work/cornell_box.xml" "$work/scene.xml"
cd "$work"
picture=(--integrator path --set film.width=64 --set film.height=64 --passes 60 --spp "${SPP:-15000}" --threads 1
  --reproducible)
export KAUSTIK=$kaustik KAUSTIK_SBATCH="--partition=low --cpus-per-task=1"
"$root/contrib/slurm/submit.sh" scene.xml 6 "${picture[@]}" --every 1s
array=$(squeue -h -o %F | sort -n | head -1)

# One in its midst.
has_checkpoint() { [[ -s scene.parts/part_$1.kpt ]]; }
until_true 900 "a checkpoint of part 1" has_checkpoint 1
scontrol requeue "${array}_1"
# All that run.
until_true 900 "a checkpoint of part 3" has_checkpoint 3
sbatch --partition=high --cpus-per-task="$(nproc)" --output=high.log --wrap="sleep 2" --wait >/dev/null
is_done() { [[ -z $(squeue -h 2>/dev/null) ]]; }
until_true 3000 "all jobs" is_done

[[ -s scene.parts/picture.exr ]] || fail "there is no picture"
went_on=$(grep -l "goes on: passes" scene.parts/log/part_*.txt | wc -l)
[[ $went_on -ge 2 ]] || fail "$went_on parts went on from a checkpoint"
"$kaustik" render scene.xml -q "${picture[@]}" -o whole.exr
cmp whole.exr scene.parts/picture.exr || fail "the picture is not that of one render"
echo "slurm: $went_on of 6 parts went on from checkpoints, and the picture has the bits of one render"

# One picture by two tasks, requeued in its midst.
[[ -n $kaustik_mpi ]] || exit 0
export KAUSTIK_MPI=$kaustik_mpi KAUSTIK_CHECKPOINT=mpi.kpt
job=$(sbatch --parsable --partition=high --nodes=1 --ntasks-per-node=2 --cpus-per-task=1 --output=mpi.log \
  "$root/contrib/slurm/mpi.sbatch" scene.xml "${picture[@]}" --every 1s -o mpi.exr)
until_true 900 "a checkpoint of MPI" test -s mpi.kpt
scontrol requeue "$job"
until_true 3000 "the job of MPI" is_done
grep -q "goes on: passes" mpi.log || fail "MPI did not go on: $(cat mpi.log)"
cmp whole.exr mpi.exr || fail "the picture of MPI is not that of one render"
echo "slurm: two tasks of MPI went on from a checkpoint, and the picture has the bits of one render"
