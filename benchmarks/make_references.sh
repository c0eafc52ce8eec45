#!/usr/bin/env bash
# Makes the references of render_bench: path tracing without L S+ D E, plus light tracing with only
# that, both unbiased. Usage: benchmarks/make_references.sh TIME_PER_PICTURE (such as 60m)
set -euo pipefail
cd "$(dirname "$0")/.."
time=${1:?say how long: 60m}
program=build/release/kaustik
mkdir -p benchmarks/references
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for name in cornell_box metal_ring; do
  scene=scenes/$name/$name.xml
  "$program" render "$scene" --integrator path --set integrator.components=emission,direct,indirect,specular \
    --time "$time" --seed 1000 --float -o "$work/path.exr"
  "$program" render "$scene" --integrator lighttracer --set integrator.components=caustic \
    --time "$time" --seed 1000 --float -o "$work/caustic.exr"
  build/release/benchmarks/add_images_tool "$work/path.exr" "$work/caustic.exr" "benchmarks/references/$name.exr"
done
