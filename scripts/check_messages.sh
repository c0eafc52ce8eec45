#!/usr/bin/env bash
# Messages speak of objects and properties, since a scene may come from a program: how things are written in a
# file of some format only its loader says, and the place tells where. Looks for the spelling of XML in the string literals of
# src/ and apps/ (but for the page that one writes). Usage: check_messages.sh [ROOT]; prints FILE:LINE and what is wrong there.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
cd "${1:-$here/..}"

find src apps \( -name '*.h' -o -name '*.cpp' \) -not -path 'src/kaustik/loader/*' -not -path apps/kaustik/page_opener.cpp -print | LC_ALL=C sort |
  xargs awk '
    # Meshes and pictures have formats of their own, which know elements and tags.
    function words_of_xml() { return FILENAME ~ /^apps\/|\/(base|image|geometry)\// ? "" : "(^|[^a-z_])(elements?|attributes?|tags?|XML)([^a-z_]|$)" }
    /^[ \t]*#[ \t]*include/ { next }
    {
      ++lines
      rest = $0
      sub(/^[ \t]*\/\/.*/, "", rest)
      while (match(rest, /"([^"\\]|\\.)*"/)) {
        text = substr(rest, RSTART + 1, RLENGTH - 2)
        rest = substr(rest, RSTART + RLENGTH)
        if (text ~ /<\/?[A-Za-z]|\/>|&(lt|gt|amp);/ || (words_of_xml() != "" && text ~ words_of_xml())) {
          printf "%s:%d: a message is written in XML: \"%s\"\n", FILENAME, FNR, text
          ++complaints
        }
      }
    }
    END {
      if (complaints) exit 1
      if (!lines) { print "no sources found"; exit 1 }
      printf "no message in %d lines is written in XML\n", lines
    }'
