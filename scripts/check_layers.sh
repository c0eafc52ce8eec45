#!/usr/bin/env bash
# Checks who includes whom: the rooms of src/kaustik against the table of docs/developer/architecture.md, and
# each library against the room that owns it. Usage: check_layers.sh [ROOT]; prints FILE:LINE and
# what is wrong there.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
cd "${1:-$here/..}"

find include src apps python tests benchmarks \( -name '*.h' -o -name '*.cpp' \) -print | LC_ALL=C sort |
  xargs awk -f "$here"/check_layers.awk CMakeLists.txt
