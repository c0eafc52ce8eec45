#!/usr/bin/env bash
# Runs every benchmark of a build folder; each measured claim is one line of JSON on the output.
set -euo pipefail
build=${1:?usage: run_benchmarks.sh BUILD_FOLDER}
failed=0
shopt -s nullglob
for program in "$build"/benchmarks/*_bench; do
  echo "# $(basename "$program")" >&2
  "$program" || { echo "$program failed" >&2; failed=1; }
done
exit $failed
