#!/usr/bin/env bash
# Prints docs/parameters.md: what `kaustik help` knows of every type.
# Usage: make_parameters_page.sh [PROGRAM] > docs/parameters.md
set -euo pipefail
program=${1:-build/release/kaustik}

cat <<'END'
# Parameters of every type

Made by `make docs` from the tables in the program; not to be edited. `kaustik help TYPE` prints the
same. In a scene file a parameter is a child of its object, as in
`<integrator type="photonmap"><integer name="caustic_neighbors" value="200"/></integrator>`; on the
command line it is `--set integrator.caustic_neighbors=200`, or `--set ID.radius=2` for an object
with an id.
END
"$program" help | awk '/^[a-z]+$/ { print }' | while read -r family; do
  printf '\n## %s\n\n```\n' "$family"
  "$program" help "$family"
  printf '```\n'
done
