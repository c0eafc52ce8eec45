#!/usr/bin/env bash
# Runs every benchmark of a build folder; each measured claim is one line of JSON on the output.
set -euo pipefail
build=${1:?usage: run_benchmarks.sh BUILD_FOLDER}
here=$(dirname "$0")

if ! "$here"/install_packages.sh bench; then
  echo "Blender is not to be had here: the comparison with Cycles is left out" >&2
fi
failed=0
shopt -s nullglob
for program in "$build"/benchmarks/*_bench; do
  echo "# $(basename "$program")" >&2
  "$program" || { echo "$program failed" >&2; failed=1; }
done
exit $failed
