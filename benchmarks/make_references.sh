#!/usr/bin/env bash
# Makes the references of render_bench and cycles_bench: path tracing without L S+ D E, plus light
# tracing with only that, both unbiased. Takes about an hour on two quiet cores; samples of one pass
# stratify one another, so the passes are few and large. A render that is interrupted (Ctrl-C) keeps
# the passes that are finished. Usage: benchmarks/make_references.sh [SCENE ...]
set -euo pipefail
cd "$(dirname "$0")/.."
program=build/release/kaustik
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# scene, integrator, components, samples per pixel, passes: adds a part to the sum
part() {
  "$program" render "scenes/$1/$1.xml" --integrator "$2" --set integrator.components="$3" \
    --spp "$4" --passes "$5" --seed 1000 --float -o "$work/$1-$2-$3.exr"
}
# scene: the sum of its parts
finish() {
  mkdir -p benchmarks/references
  build/release/benchmarks/add_images_tool "benchmarks/references/$1.exr" "$work/$1"-*.exr
}

[ $# -gt 0 ] || set -- cornell_box metal_ring
for scene in "$@"; do
  case "$scene" in
    cornell_box) # nothing in it is specular
      part cornell_box path emission,direct,indirect 8192 2
      finish cornell_box
      ;;
    metal_ring) # the lamp in the mirror, by way of the table, is what `path` takes most samples for
      part metal_ring path emission,direct,indirect 1024 2
      part metal_ring path specular 10240 10
      part metal_ring lighttracer caustic 1536 6
      finish metal_ring
      ;;
    *)
      echo "no reference is made of $scene" >&2
      exit 2
      ;;
  esac
done
