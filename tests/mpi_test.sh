#!/usr/bin/env bash
# Processes of MPI that share a picture's passes: the same bits as of one process, whatever their number, and however
# one of them is stopped, slowed or killed; a checkpoint goes on with another number; mistakes are told once; signals,
# time and the error end all. Usage: mpi_test.sh PROGRAM MPI_PROGRAM
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
kaustik=$(realpath "$1") kaustik_mpi=$(realpath "$2")
source "$root/tests/support/script.sh"
in_own_folder
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
# together PROCESSES ARGUMENTS…
together() {
  local processes=$1
  shift
  mpirun --oversubscribe --bind-to none -np "$processes" "$kaustik_mpi" "$@"
}
# The same in the background, of which $! is mpirun itself.
together_meanwhile() { (exec mpirun --oversubscribe --bind-to none -np "$1" "$kaustik_mpi" "${@:2}") >out 2>&1 & }
! grep -q libmpi <<<"$(ldd "$kaustik")" || fail "the plain program needs MPI"

scene=$root/scenes/cornell_box/cornell_box.xml
render=(render "$scene" --set film.width=32 --set film.height=32 --threads 1 --reproducible -q)
for integrator in path auto; do
  picture=("${render[@]}" --integrator "$integrator" --passes 11 --spp 44)
  "$kaustik" "${picture[@]}" -o one.exr
  for processes in 1 2 3 4 7; do
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
together_meanwhile 3 "${render[@]}" --integrator path --passes 10000 --spp 40000 --checkpoint part.kpt --every 1s \
  -o ended.exr
mpirun=$!
until_true 60 "a checkpoint of what is finished" test -s part.kpt
last=$(pgrep -P "$mpirun" | tail -1)
kill -TERM "$last"
code=0
wait "$mpirun" || code=$?
[[ $code -eq 75 ]] || { cat out; fail "ended early with $code, not with 75"; }
[[ -s ended.exr ]] || fail "no picture of what is finished"

# Of a picture that takes some seconds: stopped for a while, slowed, killed, and the leader killed. It goes on from the
# checkpoint, with another number of processes.
rm part.kpt
long=(render "$scene" --set film.width=32 --set film.height=32 --threads 1 --reproducible --progress none
  --integrator path --passes 160 --spp 1280)
"$kaustik" "${long[@]}" -o one.exr 2>out
kept=(--checkpoint part.kpt --resume-if-there --every 0.2s -o all.exr)
# Rank 0 is the first process that mpirun has started.
begin_disturbed() {
  together_meanwhile 3 "${long[@]}" "${kept[@]}"
  mpirun=$!
  until_true 60 "a checkpoint of what is finished" test -s part.kpt
  mapfile -t ranks < <(pgrep -P "$mpirun" "$(basename "$kaustik_mpi")")
  [[ ${#ranks[@]} -eq 3 ]] || fail "there are ${#ranks[@]} processes"
}
begin_disturbed
kill -STOP "${ranks[1]}"
sleep 1.5
kill -CONT "${ranks[1]}"
# Half of the time it sleeps from here on.
(while kill -STOP "${ranks[2]}" 2>/dev/null; do
  sleep 0.05
  kill -CONT "${ranks[2]}"
  sleep 0.05
done) 2>/dev/null &
wait "$mpirun" || { cat out; fail "a process that was stopped and one that is slow: ended with $?"; }
cmp one.exr all.exr || fail "the bits are others where processes were stopped and slowed"
rm part.kpt
for victim in 2 0; do
  begin_disturbed
  kill -KILL "${ranks[victim]}"
  code=0
  wait "$mpirun" || code=$?
  [[ $code -ne 0 ]] || fail "a killed process is no failure"
  "$kaustik" merge part.kpt -o there.exr >out 2>&1 || fail "the checkpoint is of no use"
  together 2 "${long[@]}" "${kept[@]}" 2>again || { cat again; fail "it does not go on"; }
  grep -q "goes on: passes 0" again || fail "it begins anew: $(cat again)"
  cmp one.exr all.exr || fail "the bits are others after process $victim was killed"
  rm part.kpt
done

# Only the leader sees the files. The others get copies.
mkdir files copies
cp -r "$root/scenes/cornell_box/." files
alone=(render cornell_box.xml --set film.width=32 --set film.height=32 --threads 1 --reproducible -q --passes 6 --spp 24)
(cd files && "$kaustik" "${alone[@]}" -o ../one.exr)
(
  export TMPDIR=$work/copies
  mpirun --oversubscribe --bind-to none -wdir "$work/files" -np 1 "$kaustik_mpi" "${alone[@]}" --broadcast-scene -o ../all.exr : \
    -wdir "$work/copies" -np 2 "$kaustik_mpi" "${alone[@]}" --broadcast-scene -o ../all.exr
)
cmp one.exr all.exr || fail "the bits are others with --broadcast-scene"
[[ -z $(find copies -name "*.xml") ]] || fail "copies of the scene are left"
! grep -q broadcast <<<"$("$kaustik" render --help)" || fail "the plain program has options of MPI"

# Time ends it between passes.
together 2 "${render[@]}" --integrator path --time 2s --checkpoint time.kpt -o time.exr
[[ -s time.exr ]] || fail "no picture after --time"

# The error is looked at after as many passes as by one process.
good=("${render[@]}" --integrator path --error 20%)
"$kaustik" "${good[@]}" -o one.exr
together 3 "${good[@]}" -o all.exr
cmp one.exr all.exr || fail "--error ends it elsewhere"
echo "mpi: 1, 2, 3, 4 and 7 processes have the bits of one, and so has what was stopped, slowed and killed"
