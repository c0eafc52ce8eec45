#!/usr/bin/env bash
# What can be checked of contrib/ without the engines: syntax, what belongs together, and scripts with stand-ins for the
# engine's programs. Usage: contrib_test.sh PROGRAM
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
kaustik=$(realpath "$1")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
cd "$root/contrib"

fail() {
  echo "$*" >&2
  failures=$((failures + 1))
}

# The three commands, and what has been run.
for folder in */; do
  page=${folder}README.md
  [[ -f $page ]] || { fail "$page is missing"; continue; }
  grep -q '^## What has been run' "$page" || fail "$page does not say what has been run"
  grep -q "^| \[${folder%/}\]($page)" README.md || fail "README.md does not list $page"
  commands=$(awk '/^```sh/ {inside = 1; next} /^```/ {exit} inside' "$page" | grep -c '[^ ]')
  [[ $commands -ge 3 && $commands -le 4 ]] || fail "$page begins with $commands commands"
done

for script in slurm/*; do
  [[ $script == *.md ]] || bash -n "$script" || fail "$script"
done
python3 "$root/tests/contrib_check.py" "$root/contrib" || fail "contrib_check.py"
if command -v node >/dev/null; then
  node "$root/tests/contrib_flamenco.js" "$root/contrib/flamenco" || fail "flamenco/kaustik.js"
fi

# part.sbatch: exit code 75 queues the task again. As Slurm does, the signal goes to the step, not to the script.
cat >"$work/srun" <<'STUB'
#!/usr/bin/env bash
while [[ $1 == --* ]]; do shift; done
echo $$ >"$(dirname "$0")/step"
exec "$@"
STUB
cat >"$work/scontrol" <<'STUB'
#!/usr/bin/env bash
echo "$*" >>"$(dirname "$0")/requeued"
STUB
chmod +x "$work/srun" "$work/scontrol"
cp -r "$root/scenes/cornell_box/." "$work"
mv "$work/cornell_box.xml" "$work/scene.xml"
cd "$work"
part() {
  PATH=$work:$PATH KAUSTIK=$kaustik KAUSTIK_SCENE=scene.xml KAUSTIK_FOLDER=. KAUSTIK_PARTS=$1 SLURM_CPUS_PER_TASK=1 \
    SLURM_ARRAY_JOB_ID=17 SLURM_ARRAY_TASK_ID=$2 exec "$root/contrib/slurm/part.sbatch" -D size=24 --set film.width=24 \
    --set film.height=24 --integrator path --threads 1 "${@:3}"
}
(part 2 2 --passes 1000000 --spp 1000000 --every 0.05s) >log 2>&1 &
job=$!
for ((i = 0; i < 600; ++i)); do
  [[ -s part_2.kpt ]] && break
  sleep 0.1
done
kill -TERM "$(<step)" || { cat log >&2; exit 1; }
code=0
wait "$job" || code=$?
[[ $code -eq 75 ]] || { fail "part.sbatch ended with $code"; cat log >&2; }
[[ -f requeued && $(<requeued) == "requeue 17_2" ]] || fail "the task was not queued again"
[[ -s part_2.kpt ]] || fail "there is no checkpoint"

# All parts, and the merge.
rm -f part_2.kpt requeued
for number in 1 2 3; do
  (part 3 "$number" --passes 5 --spp 5) >log 2>&1 || { fail "part $number"; cat log >&2; }
done
PATH=$work:$PATH KAUSTIK=$kaustik KAUSTIK_FOLDER=. KAUSTIK_PARTS=3 SLURM_CPUS_PER_TASK=1 \
  "$root/contrib/slurm/merge.sbatch" >log 2>&1 || { fail "merge.sbatch"; cat log >&2; }
[[ -s whole.kpt && -s picture.exr && ! -e requeued ]] || fail "the parts were not merged"

# submit.sh: what it submits, by a stand-in that tells.
cat >sbatch <<'STUB'
#!/usr/bin/env bash
echo "$*" >>"$(dirname "$0")/submitted"
wc -l <"$(dirname "$0")/submitted"
STUB
chmod +x sbatch
PATH=$work:$PATH "$root/contrib/slurm/submit.sh" scene.xml 6 --passes 12 --set film.width=9 >log || fail "submit.sh"
expect() { grep -q -e "$1" submitted || fail "submit.sh did not submit: $1"; }
expect 'learn.sbatch --set film.width=9$'
expect '--dependency=afterok:1 .*--array=1-6 .*part.sbatch --passes 12 --set film.width=9$'
expect '--dependency=afterok:2 .*merge.sbatch$'
rm submitted
PATH=$work:$PATH "$root/contrib/slurm/submit.sh" scene.xml 6 --integrator path >log || fail "submit.sh"
[[ $(wc -l <submitted) -eq 2 ]] || fail "path has nothing to learn"

[[ $failures -eq 0 ]] || { echo "$failures failures"; exit 1; }
echo "contrib: what can be checked here is right"
