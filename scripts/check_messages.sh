#!/usr/bin/env bash
# Messages speak of objects and properties, since a scene may come from a program: how things are written in a
# file of some format only its loader says, and the place tells where. Looks for the spelling of XML in the string literals of
# src/ and apps/ (but for the page that one writes). What the command line calls a thing only apps/ says: others are
# Python's and other programs' as well. Usage: check_messages.sh [ROOT]; prints FILE:LINE and what is wrong there.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
cd "${1:-$here/..}"

find src apps \( -name '*.h' -o -name '*.cpp' \) -not -path apps/kaustik/page_opener.cpp -print | LC_ALL=C sort |
  xargs awk '
    # Meshes and pictures have formats of their own, which know elements and tags.
    function may_write_xml() { return FILENAME ~ /^src\/kaustik\/loader\// }
    function words_of_xml() { return FILENAME ~ /^apps\/|\/(base|image|geometry)\// ? "" : "(^|[^a-z_])(elements?|attributes?|tags?|XML)([^a-z_]|$)" }
    # Tables of parameters are the pages of `kaustik help`.
    function may_name_options() { return FILENAME ~ /^apps\/|\/type_tables\.cpp$/ }
    /^[ \t]*#[ \t]*include/ { next }
    {
      ++lines
      rest = $0
      sub(/^[ \t]*\/\/.*/, "", rest)
      while (match(rest, /"([^"\\]|\\.)*"/)) {
        text = substr(rest, RSTART + 1, RLENGTH - 2)
        rest = substr(rest, RSTART + RLENGTH)
        if (!may_name_options() && text ~ /(^|[^-a-z])--[a-z]|(^|[ (`])-D([ =]|$)|command line/) {
          printf "%s:%d: a message names what the command line has: \"%s\"\n", FILENAME, FNR, text
          ++complaints
        }
        if (may_write_xml()) continue
        if (text ~ /<\/?[A-Za-z]|\/>|&(lt|gt|amp);/ || (words_of_xml() != "" && text ~ words_of_xml())) {
          printf "%s:%d: a message is written in XML: \"%s\"\n", FILENAME, FNR, text
          ++complaints
        }
      }
    }
    END {
      if (complaints) exit 1
      if (!lines) { print "no sources found"; exit 1 }
      printf "no message in %d lines is written in XML, or names options of the command line\n", lines
    }'
