#!/usr/bin/env bash
# Processes of MPI that share a picture's passes: the same bits as of one process, whatever their number; a checkpoint
# goes on with another number; mistakes are told once; signals and time end all. Usage: mpi_test.sh PROGRAM MPI_PROGRAM
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
kaustik=$(realpath "$1") kaustik_mpi=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() {
  echo "$*" >&2
  exit 1
}
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
# together PROCESSES ARGUMENTS…
together() {
  local processes=$1
  shift
  mpirun --oversubscribe --bind-to none -np "$processes" "$kaustik_mpi" "$@"
}
# The same in the background, of which $! is mpirun itself.
together_meanwhile() { (exec mpirun --oversubscribe --bind-to none -np "$1" "$kaustik_mpi" "${@:2}") >out 2>&1 & }
! ldd "$kaustik" | grep -q libmpi || fail "the plain program needs MPI"

scene=$root/scenes/cornell_box/cornell_box.xml
render=(render "$scene" --set film.width=32 --set film.height=32 --threads 1 --reproducible -q)
for integrator in path auto; do
  picture=("${render[@]}" --integrator "$integrator" --passes 11 --spp 44)
  "$kaustik" "${picture[@]}" -o one.exr
  for processes in 1 2 3 ${MORE_PROCESSES:-}; do
    together "$processes" "${picture[@]}" -o "all_$processes.exr"
    cmp one.exr "all_$processes.exr" || fail "$integrator: the bits of $processes processes are others"
  done

  # Two processes go on with what three have begun, and one process with that.
  together 3 "${render[@]}" --integrator "$integrator" --passes 4 --spp 16 --checkpoint part.kpt -o some.exr
  together 2 "${render[@]}" --integrator "$integrator" --passes 9 --spp 36 --checkpoint part.kpt --resume-if-there \
    -o some.exr
  "$kaustik" "${picture[@]}" --checkpoint part.kpt --resume-if-there -o whole.exr
  cmp one.exr whole.exr || fail "$integrator: the bits are others after going on"
  rm part.kpt
done

# A mistake is told once, and ends all.
code=0
together 2 render missing.xml >out 2>&1 || code=$?
[[ $code -ne 0 ]] || fail "a scene that is missing is no mistake"
[[ $(grep -c "missing.xml" out) -eq 1 ]] || fail "a mistake is told $(grep -c "missing.xml" out) times"
code=0
together 2 merge a.kpt -o b.kpt >out 2>&1 || code=$?
grep -q "kaustik-mpi renders" out || fail "merge is no command of kaustik-mpi"

# A signal to one process ends all, and what is finished is kept.
together_meanwhile 3 "${render[@]}" --integrator path --passes 100000 --spp 400000 --checkpoint part.kpt --every 1s \
  -o ended.exr
mpirun=$!
for ((i = 0; i < 100; ++i)); do
  [[ -s part.kpt ]] && break
  sleep 0.2
done
[[ -s part.kpt ]] || fail "no checkpoint comes meanwhile"
last=$(pgrep -P "$mpirun" | tail -1)
kill -TERM "$last"
code=0
wait "$mpirun" || code=$?
[[ $code -eq 75 ]] || { cat out; fail "ended early with $code, not with 75"; }
[[ -s ended.exr ]] || fail "no picture of what is finished"

# A process that is killed takes the others with it; the checkpoint stays.
together_meanwhile 3 "${render[@]}" --integrator path --passes 100000 --spp 400000 --checkpoint part.kpt \
  --resume-if-there --every 1s -o killed.exr
mpirun=$!
sleep 3
kill -KILL "$(pgrep -P "$mpirun" | tail -1)"
code=0
wait "$mpirun" || code=$?
[[ $code -ne 0 ]] || fail "a killed process is no failure"
"$kaustik" merge part.kpt -o there.exr --incomplete -q 2>/dev/null || "$kaustik" merge part.kpt -o there.exr
[[ -s there.exr ]] || fail "the checkpoint is of no use"

# Time ends it between passes.
together 2 "${render[@]}" --integrator path --time 3s --checkpoint time.kpt -o time.exr
[[ -s time.exr ]] || fail "no picture after --time"
echo "mpi: 1, 2, 3 ${MORE_PROCESSES:-} processes have the bits of one"
