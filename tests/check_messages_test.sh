#!/usr/bin/env bash
# The check of messages must pass on the sources as they are, and find each message planted in a copy.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
# shellcheck source=tests/support/planted_mistakes.sh
source "$root/tests/support/planted_mistakes.sh"

cp -r "$root"/{src,apps} "$copy"

# check FILE LINE: what the check says of the sources with LINE at the end of FILE.
check() {
  local status=0
  printf '\n%s\n' "$2" >>"$copy/$1"
  "$root"/scripts/check_messages.sh "$copy" || status=$?
  cp "$root/$1" "$copy/$1"
  return $status
}

plant() { must_be_refused "$1:$(($(wc -l <"$root/$1") + 2)): " check "$1" "$2"; }

spare() {
  local output
  if ! output=$(check "$1" "$2"); then
    printf "is right: '%s' in %s\n%s\n" "$2" "$1" "$output"
    failures=$((failures + 1))
  fi
}

"$root"/scripts/check_messages.sh "$root"
plant src/kaustik/scene/scene_builder.cpp 'const char* a = "add <sensor type=\"perspective\">";'
plant src/kaustik/scene/media.cpp '    "put it inside the <shape> that shines",'
plant src/kaustik/material/mask.cpp 'const std::string a = "write <ref id=…/> or " + name + "</texture>";'
plant src/kaustik/light/area_light.cpp 'const char* a = "the attribute is missing";'
plant src/kaustik/render/film.cpp 'const char* a = "this element is unknown";'
plant src/kaustik/render/job.cpp 'const char* a = "render it with the same --seed";'
plant src/kaustik/loader/mitsuba_xml.cpp 'const char* a = "define it: -D name=…";'
plant src/kaustik/integrator/registry.cpp 'throw Error(place_in("command line"));'
plant apps/kaustik/main.cpp 'const char* a = "give <emitter> more power";'
spare src/kaustik/scene/scene_builder.cpp '// add <sensor type="perspective"> with a to_world'
spare src/kaustik/scene/scene_builder.cpp 'const bool a = "a"[0] <b["b"];'
spare src/kaustik/loader/mitsuba_xml.cpp 'const char* a = "add <sensor>";'
spare src/kaustik/material/mask.cpp 'const char* a = "mesh_attribute";'
spare src/kaustik/geometry/ply_reader.cpp 'const char* a = "unknown element";'
spare apps/kaustik/main.cpp 'const char* a = "command line: --seed";'
spare src/kaustik/loader/mitsuba_xml.cpp 'const char* a = "<!-- a remark -->, -s 2";'
spare apps/kaustik/scene_options.cpp 'const char* a = "Scene file (Mitsuba XML)";'

[[ $failures -eq 0 ]] || { echo "$failures failures"; exit 1; }
