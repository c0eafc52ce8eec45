#!/usr/bin/env bash
# Makes references, benchmarks/references/SCENE.exr with the standard error of each pixel. Each
# component of the light (docs/developer/vocabulary.md) comes from what finds it best without bias: path
# tracing what it can, light tracing what lamps focus (L S+ D E) and what only they find. What
# mirrors, glass and water show of such light no unbiased method finds in reasonable time; there, and
# for light that is scattered on from it, it is auto, whose bias shrinks with the passes: the tests
# compare its means with those of the unbiased methods. A render that is interrupted (Ctrl-C) keeps
# the passes that are finished. Usage: benchmarks/make_references.sh [SCENE ...]; without names: all
# that bench_scenes measures by default and does not have. EFFORT=0.1 takes a tenth of the minutes.
set -euo pipefail
cd "$(dirname "$0")/.."
program=build/release/kaustik
references=${REFERENCES:-benchmarks/references}
effort=${EFFORT:-1}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# scene: its file, and what makes its picture as large as the reference is to be
file_of() {
  case "$1" in
    peer_*) echo "benchmarks/peer_scenes/${1#peer_}/scene.xml" ;;
    plain_*) echo "$work/$1.xml" ;;
    pool_among_lamps | hundredth_of_a_floor | door_ajar | hall_of_lamps) echo "benchmarks/scenes/$1.xml" ;;
    *) echo "scenes/$1/$1.xml" ;;
  esac
}
size_of() {
  case "$1" in
    peer_* | pool_among_lamps | hundredth_of_a_floor | door_ajar | hall_of_lamps) ;;
    plain_gallery_*) echo "--set film.width=400 --set film.height=300" ;;
    plain_*) echo "--set film.width=400 --set film.height=400" ;;
    gallery_*) echo "-D width=400 -D height=300" ;;
    *) echo "-D size=400" ;;
  esac
}
# scene, integrator, components, options of the length: adds a part to the sum
part() {
  # shellcheck disable=SC2046
  "$program" render "$(file_of "$1")" $(size_of "$1") --integrator "$2" \
    --set integrator.components="$3" "${@:4}" --seed 1000 --float -o "$work/$1-$2-$3.exr"
}
# scene, integrator, components, minutes
minutes() {
  part "$1" "$2" "$3" --time "$(awk "BEGIN { print $4 * $effort * 60 }")s"
}
# scene: as every renderer gets it, with shapes, materials and lamps that all have
write_plain_room() {
  build/release/benchmarks/peers/bench_peers --scenes "$1" --write "$work"
}
# scene: the sum of its parts
finish() {
  mkdir -p "$references"
  build/release/benchmarks/add_images_tool "$references/$1.exr" "$work/$1"-*.exr
}

make_reference() {
  local scene=$1
  case "$scene" in
    # Nothing in it is specular. Samples of one pass stratify one another: few, large passes.
    cornell_box)
      part "$scene" path emission,direct,indirect --spp 8192 --passes 2
      ;;
    peer_cornell)
      minutes "$scene" path emission,direct,indirect 10
      ;;
    metal_ring)
      minutes "$scene" path emission,direct 2
      minutes "$scene" bdpt indirect 2
      minutes "$scene" lighttracer caustic 4
      minutes "$scene" auto specular 10
      ;;
    peer_ring)
      minutes "$scene" path emission,direct 1
      minutes "$scene" bdpt indirect 1
      minutes "$scene" lighttracer caustic 1
      minutes "$scene" auto specular 3
      ;;
    cornell_spheres | peer_cornell_glass)
      minutes "$scene" path emission,direct 1
      minutes "$scene" lighttracer caustic 1
      minutes "$scene" lighttracer indirect 5
      minutes "$scene" auto specular 3
      ;;
    # All light comes through the water: only paths from the lamps find it.
    pool_below | peer_pool_below)
      minutes "$scene" path emission,direct 0.5
      minutes "$scene" lighttracer caustic 8
      minutes "$scene" auto indirect 3
      minutes "$scene" auto specular 3
      ;;
    # And nearly all that is seen is seen through it.
    pool_above | peer_pool_above)
      minutes "$scene" path emission,direct 0.5
      minutes "$scene" lighttracer caustic,indirect 4
      minutes "$scene" auto specular 5
      ;;
    # Lamps among crystals, whose focused light is scattered again.
    atrium)
      minutes "$scene" path emission,direct 10
      minutes "$scene" lighttracer caustic 20
      minutes "$scene" bdpt indirect 60
      minutes "$scene" vcm specular 30
      ;;
    # Lamps behind walls.
    peer_hidden_light)
      minutes "$scene" path emission,direct,caustic,specular 0.5
      minutes "$scene" lighttracer indirect 8
      ;;
    # What auto learns, chooses and guides is measured on these: make ablation.
    door_ajar)
      part "$scene" bdpt all --passes 640
      ;;
    hall_of_lamps)
      part "$scene" path all --passes 320
      ;;
    # Paths from the lamps that reach what is seen are far too rare for lighttracer and bdpt.
    pool_among_lamps)
      part "$scene" auto all --passes 512
      ;;
    hundredth_of_a_floor)
      part "$scene" auto all --passes 2560
      ;;
    maze | point_spotlight)
      minutes "$scene" path all 60
      ;;
    # In rooms with many small lamps bdpt has a third to a fifth of path's noise in the same time.
    gallery_1 | gallery_2 | museum)
      minutes "$scene" bdpt all 60
      ;;
    # Rooms that other renderers get, too (bench_peers).
    plain_museum | plain_gallery_1)
      write_plain_room "$scene"
      minutes "$scene" bdpt all 10
      ;;
    plain_atrium)
      write_plain_room "$scene"
      minutes "$scene" path emission,direct 2
      minutes "$scene" lighttracer caustic 3
      minutes "$scene" bdpt indirect 6
      minutes "$scene" vcm specular 3
      ;;
    *)
      echo "no reference is made of $scene" >&2
      exit 2
      ;;
  esac
  finish "$scene"
}

if [ $# -eq 0 ]; then
  for scene in cornell_box cornell_spheres metal_ring pool_below atrium gallery_1; do
    [ -e "$references/$scene.exr" ] || set -- "$@" "$scene"
  done
fi
for scene in "$@"; do make_reference "$scene"; done
