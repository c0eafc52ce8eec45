#!/usr/bin/env bash
# Processes of MPI on three hosts with 10 Mbit/s and 50 ms between them (network namespaces of this machine): the bits
# of one process; the scene's files from process 0 alone; a host that dies. Exit code 77, and a reason, where no such
# hosts can be made. Usage: network_test.sh PROGRAM MPI_PROGRAM
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
if [[ -z ${HOSTS:-} ]]; then
  exec python3 "$root/tests/slow_network.py" --hosts 3 --mbit 10 --delay-ms 50 -- "$0" "$@"
fi
kaustik=$(realpath "$1") kaustik_mpi=$(realpath "$2")
source "$root/tests/support/script.sh"
in_own_folder
read -ra options <<<"$HOSTS_MPIRUN"
together() { mpirun "${options[@]}" --host "$HOSTS" -np 3 "$@"; }

[[ $(together hostname | sort | xargs) == "host1 host2 host3" ]] || fail "the processes are not on three hosts"
scene=$root/scenes/cornell_box/cornell_box.xml
render=(render "$scene" --set film.width=32 --set film.height=32 --threads 1 --reproducible -q)
for integrator in path auto; do
  picture=("${render[@]}" --integrator "$integrator" --passes 11 --spp 44)
  "$kaustik" "${picture[@]}" -o one.exr
  together "$kaustik_mpi" "${picture[@]}" -o all.exr
  cmp one.exr all.exr || fail "$integrator: the bits of three hosts are others"
done

# Each host has a folder of its own, and only the first one has the scene.
mkdir first others
cp -r "$root/scenes/cornell_box/." first
own=(render cornell_box.xml --set film.width=32 --set film.height=32 --threads 1 --reproducible -q --integrator path
  --passes 11 --spp 44)
rm all.exr
mpirun "${options[@]}" --host "${HOSTS%%,*}" -wdir "$work/first" -np 1 "$kaustik_mpi" "${own[@]}" --broadcast-scene -o "$work/all.exr" : \
  --host "${HOSTS#*,}" -wdir "$work/others" -np 2 "$kaustik_mpi" "${own[@]}" --broadcast-scene -o "$work/all.exr"
(cd first && "$kaustik" "${own[@]}" -o "$work/one.exr")
cmp one.exr all.exr || fail "the bits are others with --broadcast-scene"

# A process on another host dies. The job begins again, and goes on.
long=("${render[@]}" --integrator path --passes 160 --spp 1280 --checkpoint "$work/part.kpt" --resume-if-there --every 0.2s
  -o all.exr)
(exec mpirun "${options[@]}" --host "$HOSTS" -np 3 "$kaustik_mpi" "${long[@]}") >out 2>&1 &
mpirun=$!
until_true 60 "a checkpoint of what is finished" test -s part.kpt
victim=$(pgrep -n -f "^$kaustik_mpi .*$work/part.kpt")
kill -KILL "$victim"
code=0
wait "$mpirun" || code=$?
[[ $code -ne 0 ]] || fail "a killed process is no failure"
together "$kaustik_mpi" "${long[@]}"
"$kaustik" "${render[@]}" --integrator path --passes 160 --spp 1280 -o one.exr
cmp one.exr all.exr || fail "the bits are others after a process was killed"
echo "network: three hosts have the bits of one process"
