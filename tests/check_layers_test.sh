#!/usr/bin/env bash
# The layer check must pass on the sources as they are, and find each violation planted in a copy.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
failures=0

fresh_copy() {
  rm -rf "${copy:?}"/*
  cp -r "$root"/{src,apps,tests,benchmarks,CMakeLists.txt} "$copy"
}

# plant FILE LINE MESSAGE: with LINE at the end of FILE, the check must fail and name the place.
plant() {
  local file=$1 line=$2 message=$3 output place
  fresh_copy
  mkdir -p "$(dirname "$copy/$file")"
  printf '\n%s\n' "$line" >>"$copy/$file"
  place="$file:$(wc -l <"$copy/$file"): "
  if output=$("$root"/scripts/check_layers.sh "$copy"); then
    echo "not found: '$line' in $file"
    failures=$((failures + 1))
  elif [[ $output != *"$place"*"$message"* ]]; then
    printf "'%s' in %s gave\n  %s\ninstead of\n  %s…%s\n" "$line" "$file" "$output" "$place" "$message"
    failures=$((failures + 1))
  else
    echo "$output"
  fi
}

"$root"/scripts/check_layers.sh "$root"
plant src/kaustik/base/vec.h '#include "kaustik/image/image.h"' "room 'base' must not include"
plant src/kaustik/light/light.h '#include "kaustik/material/bsdf.h"' "room 'light' must not include"
plant src/kaustik/irradiance/hemisphere.cpp '#  include "kaustik/photon/photon.h"' "must not include"
plant src/kaustik/loader/mitsuba_xml.cpp '#include "kaustik/scene/scene.h"' "description.h only"
plant src/kaustik/scene/scene.h '#include "kaustik/nowhere/thing.h"' "there is no room 'nowhere'"
plant src/kaustik/attic/thing.h '#include "kaustik/base/vec.h"' "room 'attic'"
plant src/kaustik/scene/scene.h '#include "camera.h"' 'write "kaustik/ROOM/camera.h"'
plant apps/kaustik/main.cpp '#include "kaustik/photon/photon_map.h"' "room 'apps' must not include"
plant tests/base/error_test.cpp '#include "kaustik/scene/scene.h"' "tests of room 'base'"
plant src/kaustik/integrator/path.cpp '#include <embree3/rtcore.h>' "must not include Embree"
plant src/kaustik/scene/scene.h '#include <pugixml.hpp>' "must not include pugixml"
plant src/kaustik/render/film.h '#include <ImfHeader.h>' "must not include OpenEXR"
plant src/kaustik/render/film.cpp '#include <OpenEXR/ImfHeader.h>' "must not include OpenEXR"
plant src/kaustik/base/file.cpp '#include <jpeglib.h>' "must not include libjpeg"
plant src/kaustik/irradiance/hemisphere.h '#include <hwy/highway.h>' "must not include Highway"
plant src/kaustik/base/vec.h '#include <boost/any.hpp>' "belongs to no library"
plant src/kaustik/transport/vertex.h 'struct RTCSceneTy; RTCScene* scene;' "names of Embree"
plant src/kaustik/scene/scene.h 'namespace pugi { class node; } pugi::node* n;' "names of pugixml"
plant CMakeLists.txt 'kaustik_room(light kaustik_base kaustik_material)' "must not link 'material'"

[[ $failures -eq 0 ]] || { echo "$failures failures"; exit 1; }
