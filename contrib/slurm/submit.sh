#!/usr/bin/env bash
# Submits a picture as a job array and a merge that depends on it.
# Usage: submit.sh SCENE.xml PARTS [options of kaustik render: --passes, --spp, -D, --set, --integrator, --seed]
# README.md tells of KAUSTIK, KAUSTIK_SBATCH, KAUSTIK_PART_SBATCH and KAUSTIK_LEARN.
set -euo pipefail

if [[ $# -lt 2 || ! $2 =~ ^[1-9][0-9]*$ ]]; then
  sed -n '2,4s/^# //p' "$0" >&2
  exit 2
fi
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
scene=$1 parts=$2
shift 2
[[ -r $scene ]] || { echo "$0: cannot read the scene '$scene'" >&2; exit 2; }

folder=$(basename "${scene%.xml}").parts
mkdir -p "$folder/log"
export KAUSTIK=${KAUSTIK:-kaustik} KAUSTIK_SCENE=$scene KAUSTIK_FOLDER=$folder KAUSTIK_PARTS=$parts
read -r -a options <<<"${KAUSTIK_SBATCH:-}"
read -r -a part_options <<<"${KAUSTIK_PART_SBATCH:-}"
options+=(--parsable --chdir="$PWD" --export=ALL)

# What `learn` takes of the options of `render`.
learn_options=()
learns=${KAUSTIK_LEARN:-yes}
arguments=("$@")
for ((i = 0; i < ${#arguments[@]}; ++i)); do
  case ${arguments[i]} in
    -D | --define | --set | --integrator | --camera | --seed)
      learn_options+=("${arguments[i]}" "${arguments[i + 1]}")
      ((++i)) ;;
    --strict) learn_options+=(--strict) ;;
  esac
done
case " ${learn_options[*]-} " in
  *" --integrator path "* | *" --integrator lighttracer "* | *" --integrator photonmap "*) learns=no ;;
esac

after=()
if [[ $learns != no ]]; then
  export KAUSTIK_LEARNED=$folder/scene.kln
  job=$(sbatch "${options[@]}" "${part_options[@]}" --output="$folder/log/learn.txt" \
    "$here/learn.sbatch" "${learn_options[@]}")
  after=(--dependency="afterok:${job%%;*}" --kill-on-invalid-dep=yes)
  echo "learn: job ${job%%;*}"
fi
job=$(sbatch "${options[@]}" "${part_options[@]}" "${after[@]}" --array="1-$parts" \
  --output="$folder/log/part_%a.txt" "$here/part.sbatch" "$@")
echo "$parts parts: job ${job%%;*}"
job=$(sbatch "${options[@]}" --dependency="afterok:${job%%;*}" --kill-on-invalid-dep=yes \
  --output="$folder/log/merge.txt" "$here/merge.sbatch")
echo "merge: job ${job%%;*}, which writes $folder/whole.kpt and $folder/picture.exr"
