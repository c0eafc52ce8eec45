#!/usr/bin/env bash
# scripts/docs_commands.py must find each mistake planted in a page, and take a page without one.
# Usage: docs_commands_test.sh PROGRAM
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
program=$(realpath "$1")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
# shellcheck source=tests/support/planted_mistakes.sh
source "$root/tests/support/planted_mistakes.sh"

check_page() {
  cat >"$folder/page.md"
  "$root"/scripts/docs_commands.py "$program" "$folder/page.md" 2>&1
}

check_page <<'PAGE' || failures=$((failures + 1))
A page that is right, with `kaustik render scene.xml --time 5s`, `make test` and
<!-- given: sed 's|"meshes/|"scenes/metal_ring/meshes/|' scenes/metal_ring/metal_ring.xml >scene.xml -->
```sh
kaustik render scene.xml --spp 4096 --integrator path -o a.exr   # would take minutes
test -s a.exr
```
<!-- not run: needs root -->
```sh
make install
build/release/benchmarks/glossy_tool 8 64 rough_wall diffuse_samples=16
scripts/worth.py devices --page docs/ablation.md
```
PAGE
plant "no option --time" <<'PAGE'
`kaustik info scene.xml --time 5s`
PAGE
plant "no 'kaustik rendre'" <<'PAGE'
`kaustik rendre scene.xml`
PAGE
plant "no target 'tests'" <<'PAGE'
<!-- not run: needs root -->
```sh
make tests
```
PAGE
plant "no option --samples" <<'PAGE'
<!-- not run: needs hours -->
```sh
kaustik render scene.xml --samples 5
```
PAGE
plant "page.md:2: exit code" <<'PAGE'
A wrong option:
```sh
kaustik render scenes/metal_ring/metal_ring.xml --samples 5
```
PAGE
plant "no such parameter" <<'PAGE'
```sh
kaustik help nothing_of_that_name || { echo no such parameter; false; }
```
PAGE
plant "cannot read the time" <<'PAGE'
A wrong value, which is not made short:
```sh
kaustik render scenes/metal_ring/metal_ring.xml --time 5parsecs
```
PAGE
plant "exit code" <<'PAGE'
A file that no command has made:
```sh
kaustik tonemap none.exr -o none.png
```
PAGE
plant "does not say that it is" <<'PAGE'
```
kaustik info scenes/metal_ring/metal_ring.xml
```
PAGE
plant "no program 'shiny_tool'" <<'PAGE'
`shiny_tool 8 64 rough_wall` prints it.
PAGE
plant "no program 'test_nothing'" <<'PAGE'
`build/release/tests/test_nothing --gtest_filter=a`
PAGE
plant "no preset builds into" <<'PAGE'
`build/releese/kaustik`
PAGE
plant "'time_tool' knows no option --sizes" <<'PAGE'
`time_tool --sizes 800 museum auto 5s`
PAGE
plant "there is no scripts/none.sh" <<'PAGE'
`scripts/none.sh`
PAGE
plant "'worth.py' knows no option --pages" <<'PAGE'
<!-- not run: takes hours -->
```sh
scripts/worth.py devices --pages docs/ablation.md
```
PAGE
plant "no preset 'relaese'" <<'PAGE'
`cmake --preset relaese`
PAGE

# plant_help MESSAGE TEXT: so must a program whose `learn --help` ends with TEXT.
plant_help() {
  cat >"$folder/kaustik" <<SCRIPT
#!/bin/sh
"$program" "\$@"
status=\$?
[ "\$*" != "learn --help" ] || echo "$2"
exit \$status
SCRIPT
  chmod +x "$folder/kaustik"
  must_be_refused "$1" "$root"/scripts/docs_commands.py "$folder/kaustik" help
}
plant_help "kaustik learn --help:" "  kaustik learn scene.xml -o b.kln --no-such-option"
plant_help "no 'kaustik lern'" "Learn with it: -o, or so (kaustik lern)."
[[ $failures == 0 ]] && echo "docs_commands_test: passed"
exit "$failures"
