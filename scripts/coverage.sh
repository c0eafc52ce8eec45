#!/usr/bin/env bash
# Builds with clang++ so that lines are counted, runs all tests but the long ones, and prints which
# share of the lines of each room has run. Usage: coverage.sh [FILTER], what `ctest -R` takes.
# build/coverage/lines.txt tells it of each file; to see which lines of one have not run:
#   llvm-cov-14 show build/coverage/kaustik -instr-profile build/coverage/all.profdata src/kaustik/base/warp.cpp
set -euo pipefail
cd "$(dirname "$0")/.."
build=build/coverage
cmake --preset coverage >/dev/null
cmake --build --preset coverage
rm -rf $build/profiles
# Lines that ran in tests that failed have run, too.
ctest --preset coverage ${1:+-R "$1"} || echo "some tests failed; what they ran counts all the same"
llvm-profdata-14 merge -sparse $build/profiles/*.profraw -o $build/all.profdata
objects=()
for program in $build/tests/test_* $build/tests/fuzz_scenes $build/make_scenes $build/libkaustik.so; do
  [[ -f $program && -x $program ]] && objects+=(-object "$program")
done
llvm-cov-14 report $build/kaustik "${objects[@]}" -instr-profile $build/all.profdata \
  src/kaustik apps scenes >$build/lines.txt
scripts/coverage_by_room.awk $build/lines.txt
