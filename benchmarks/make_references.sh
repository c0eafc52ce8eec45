#!/usr/bin/env bash
# Makes the references of render_bench and cycles_bench: path tracing without L S+ D E, plus light
# tracing with only that, both unbiased. Takes about an hour and a half on two quiet cores; samples
# of one pass stratify one another, so the passes are few and large. A render that is interrupted
# (Ctrl-C) keeps the passes that are finished. Usage: benchmarks/make_references.sh [SCENE ...]
set -euo pipefail
cd "$(dirname "$0")/.."
program=build/release/kaustik
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

render() { # scene, integrator, components, samples per pixel, passes, output
  "$program" render "scenes/$1/$1.xml" --integrator "$2" --set integrator.components="$3" \
    --spp "$4" --passes "$5" --seed 1000 --float -o "$6"
}

# scene, samples per pixel and passes of `path`, and of `lighttracer`
make_reference() {
  mkdir -p benchmarks/references
  render "$1" path emission,direct,indirect,specular "$2" "$3" "$work/path.exr"
  render "$1" lighttracer caustic "$4" "$5" "$work/caustic.exr"
  build/release/benchmarks/add_images_tool "$work/path.exr" "$work/caustic.exr" \
    "benchmarks/references/$1.exr"
}

[ $# -gt 0 ] || set -- cornell_box metal_ring
for scene in "$@"; do
  case "$scene" in
    cornell_box) make_reference cornell_box 16384 4 4 2 ;; # nothing in it makes caustics
    metal_ring) make_reference metal_ring 3072 6 1536 6 ;;
    *) echo "no reference is made of $scene" >&2; exit 2 ;;
  esac
done
