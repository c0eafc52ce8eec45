#!/usr/bin/env bash
# scripts/check_docs.py must find each mistake planted in a page, and take pages without one.
# Usage: check_docs_test.sh
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
# shellcheck source=tests/support/planted_mistakes.sh
source "$root/tests/support/planted_mistakes.sh"

# Pages that are right, around docs/page.md.
mkdir -p "$folder/docs/pictures" "$folder/scenes/ring"
touch "$folder/docs/pictures/ring.png"
echo "<scene/>" >"$folder/scenes/ring/ring.xml"
cat >"$folder/README.md" <<'PAGE'
# A renderer
[Page](docs/page.md), [other page](docs/other.md#one-light--many-lights)
PAGE
cat >"$folder/docs/other.md" <<'PAGE'
# Other
## One light & many lights
## `--error`: how far off
## Again
## Again
PAGE
cat >"$folder/docs/old.md" <<'PAGE'
# Old

This page has moved: [page](page.md).
PAGE

check_page() {
  cat >"$folder/docs/page.md"
  "$root"/scripts/check_docs.py --root "$folder" 2>&1
}

long="words that make a line long $(printf 'very %.0s' {1..30})"
words=$(printf 'word\n%.0s' {1..1500})
check_page <<PAGE || failures=$((failures + 1))
# A page that is right

[Scene](../scenes/ring/ring.xml), [its folder](../scenes/ring), [heading](other.md#--error-how-far-off),
[itself](#a-page-that-is-right), [second of a name](other.md#again-1), \`[no link](none.md)\`, <a href="other.md">HTML</a>

[![ring](pictures/ring.png)](../scenes/ring/ring.xml)

| $long | in a table |
|---|---|
| a | b |

\$\$
L = \\sum_i L_i
\$\$

- $(printf 'x%.0s' {1..130})

<!-- $long -->
\`\`\`sh
echo $long [no link](none.md) \$\$ 
\`\`\`
<!-- parameters -->
$words
$long
<!-- end of parameters -->
PAGE
plant "docs/page.md:3: link to a file that is not there: none.md" <<'PAGE'
# Page

See [none](none.md).
PAGE
plant "docs/page.md:1: no heading of docs/other.md has the anchor #one-light-many-lights" <<'PAGE'
[GitHub drops the sign and keeps both blanks](other.md#one-light-many-lights)
PAGE
plant "docs/page.md:2: no heading of docs/page.md has the anchor #nothing" <<'PAGE'
# Page
[here](#nothing)
PAGE
plant "docs/page.md:1: picture to a file that is not there: pictures/none.png" <<'PAGE'
[![none](pictures/none.png)](../scenes/ring/ring.xml)
PAGE
plant "docs/page.md:1: picture to a file that is not there: pictures/none.jpg" <<'PAGE'
<img src="pictures/none.jpg" width="96">
PAGE
plant "docs/page.md:1: link to a file that is not there: ../scenes/none" <<'PAGE'
[`code` as its text](../scenes/none)
PAGE
plant "docs/page.md:3: link to a file that is not there: none.md" <<'PAGE'
By [reference].

[reference]: none.md
PAGE
plant "docs/page.md:1: link out of the repository: ../../elsewhere.md" <<'PAGE'
[elsewhere](../../elsewhere.md)
PAGE
plant "docs/page.md:1: link to a page that has moved: old.md" <<'PAGE'
[old](old.md)
PAGE
plant "docs/page.md:1: 1500 words" <<PAGE
$words
PAGE
plant "docs/page.md:2: 180 characters" <<PAGE
# Page
- $long
PAGE
plant "docs/page.md:2: \$\$ without its partner" <<'PAGE'
# Page
$$
L = 1
PAGE
plant "docs/page.md:1: \$\$ without its partner, or with a blank line before it" <<'PAGE'
$$
L = 1

$$
PAGE
echo "# Alone" >"$folder/docs/alone.md"
plant "docs/alone.md:1: no page links to this page" <<'PAGE'
# Page
PAGE
cat >>"$folder/docs/old.md" <<'PAGE'
[alone](alone.md)
PAGE
plant "docs/alone.md:1: no page links to this page" <<'PAGE'
A link in a page that has moved is none.
PAGE
[[ $failures == 0 ]] && echo "check_docs_test: passed"
exit "$failures"
