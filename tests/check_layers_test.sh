#!/usr/bin/env bash
# The layer check must pass on the sources as they are, and find each violation planted in a copy.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
expected=()

(cd "$root" && find include src apps python tests benchmarks CMakeLists.txt \
  \( -name '*.h' -o -name '*.cpp' -o -name CMakeLists.txt \) -exec cp --parents -t "$copy" {} +)

# plant FILE LINE MESSAGE: puts LINE at the end of FILE; the check must name the place and say MESSAGE.
plant() {
  local file=$1 line=$2 message=$3
  mkdir -p "$(dirname "$copy/$file")"
  printf '\n%s\n' "$line" >>"$copy/$file"
  expected+=("$file:$(wc -l <"$copy/$file"): $message")
}

"$root"/scripts/check_layers.sh "$root"
plant src/kaustik/base/vec.h '#include "kaustik/image/image.h"' "room 'base' must not include"
plant src/kaustik/light/light.h '#include "kaustik/material/bsdf.h"' "room 'light' must not include"
plant src/kaustik/irradiance/hemisphere.cpp '#  include "kaustik/photon/photon.h"' "must not include"
plant src/kaustik/loader/mitsuba_xml.cpp '#include "kaustik/scene/scene.h"' "description.h only"
plant src/kaustik/scene/scene.h '#include "kaustik/nowhere/thing.h"' "there is no room 'nowhere'"
# The two methods over photons know nothing of each other, and what is below knows neither.
plant src/kaustik/vcm/vcm.cpp '#include "kaustik/photonmap/photon_map_integrator.h"' "room 'vcm' must not include"
plant src/kaustik/vcm/gathering/gathered_light.h '#include "kaustik/vcm/plan/plans.h"' "folder 'vcm/gathering' must not include"
plant src/kaustik/vcm/settings.cpp '#include "kaustik/integrator/registry.h"' "room 'vcm' must not include"
plant src/kaustik/photonmap/photon_light.cpp '#include "kaustik/vcm/vcm.h"' "room 'photonmap' must not include"
plant src/kaustik/photon/photon_map.h '#include "kaustik/vcm/light_vertices.h"' "room 'photon' must not include"
plant src/kaustik/photon/light_pass.cpp '#include "kaustik/photonmap/photon_light.h"' "room 'photon' must not include"
plant src/kaustik/irradiance/hemisphere.cpp '#include "kaustik/vcm/vcm.h"' "room 'irradiance' must not include"
plant CMakeLists.txt 'kaustik_room(vcm kaustik_photon kaustik_photonmap)' "room 'vcm' must not link 'photonmap'"
plant CMakeLists.txt 'kaustik_room(photonmap kaustik_photon kaustik_vcm)' "room 'photonmap' must not link 'vcm'"
plant python/native/jobs.cpp '#include "kaustik/vcm/vcm.h"' "room 'python' must not include"
plant apps/kaustik/main.cpp '#include <pybind11/pybind11.h>' "pybind11"
# Subfolders.
plant src/kaustik/vcm/lessons/lesson.h '#include "kaustik/vcm/camera_path/connect.h"' "folder 'vcm/lessons' must not include"
plant src/kaustik/vcm/merging/matt_merging.h '#include "kaustik/vcm/plan/plans.h"' "folder 'vcm/merging' must not include"
plant src/kaustik/vcm/light_path/block.h '#include "kaustik/vcm/camera_path/inputs.h"' "folder 'vcm/light_path' must not include"
plant src/kaustik/photon/kd_tree/kd_tree.h '#include "kaustik/photon/coverage/merge_disk.h"' "folder 'photon/kd_tree' must not include"
plant src/kaustik/photon/emission/aim_light.cpp '#include "kaustik/photon/kd_tree/kd_tree.h"' "folder 'photon/emission' must not include"
plant src/kaustik/vcm/attic/thing.h '#include "kaustik/vcm/plan/plans.h"' "folder 'vcm/attic' must not include"
plant src/kaustik/attic/thing.h '#include "kaustik/base/vec.h"' "room 'attic'"
plant src/kaustik/scene/scene.h '#include "camera.h"' 'write "kaustik/ROOM/camera.h"'
plant apps/kaustik/main.cpp '#include "kaustik/photon/photon_map.h"' "room 'apps' must not include"
# What hosts see is for hosts, and shows nothing else.
plant include/kaustik/scene.h '#include "kaustik/scene/scene.h"' "hosts do not see"
plant include/kaustik/value.h '#include <Imath/ImathVec.h>' "must not include Imath"
plant src/kaustik/render/job.h '#include "kaustik/session.h"' "room 'render' must not include what is for hosts"
plant apps/kaustik/main.cpp '#include "kaustik/kaustik.h"' "room 'apps' must not include what is for hosts"
plant tests/library/scene_test.cpp '#include "kaustik/render/job.h"' "hosts do not see"
plant src/kaustik/library/mesh.cpp '#include "kaustik/photon/photon.h"' "room 'library' must not include"
plant CMakeLists.txt 'kaustik_shared_room(library kaustik_photon)' "room 'library' must not link 'photon'"
plant tests/base/error_test.cpp '#include "kaustik/scene/scene.h"' "tests of room 'base'"
plant src/kaustik/integrator/path.cpp '#include <embree3/rtcore.h>' "must not include Embree"
plant src/kaustik/scene/scene.h '#include <pugixml.hpp>' "must not include pugixml"
plant src/kaustik/render/film.h '#include <ImfHeader.h>' "must not include OpenEXR"
plant src/kaustik/render/film.cpp '#include <OpenEXR/ImfHeader.h>' "must not include OpenEXR"
plant src/kaustik/base/file.cpp '#include <jpeglib.h>' "must not include libjpeg"
plant src/kaustik/irradiance/hemisphere.h '#include <hwy/highway.h>' "must not include Highway"
plant src/kaustik/base/vec.h '#include <cairo/cairo.h>' "belongs to no library"
plant src/kaustik/transport/vertex.h 'struct RTCSceneTy; RTCScene* scene;' "names of Embree"
plant src/kaustik/scene/scene.h 'namespace pugi { class node; } pugi::node* n;' "names of pugixml"
plant CMakeLists.txt 'kaustik_room(light kaustik_base kaustik_material)' "must not link 'material'"

if output=$("$root"/scripts/check_layers.sh "$copy"); then
  echo "not one violation was found"
  exit 1
fi
failures=0
for violation in "${expected[@]}"; do
  place=${violation%%: *}: message=${violation#*: }
  if ! grep -F -- "$place" <<<"$output" | grep -qF -- "$message"; then
    echo "not found: $violation"
    failures=$((failures + 1))
  fi
done
echo "$output"
[[ $failures -eq 0 ]] || { echo "$failures failures"; exit 1; }
