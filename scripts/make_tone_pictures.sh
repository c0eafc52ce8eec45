#!/usr/bin/env bash
# Makes the pictures of docs/guides/tone_mapping.md and docs/reference/tonemap (three minutes on two cores).
# Usage: make_tone_pictures.sh [PROGRAM]
set -euo pipefail
cd "$(dirname "$0")/.."
program=${1:-build/release/kaustik}
out=docs/pictures/tone
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
mkdir -p "$out"

"$program" render scenes/cornell_box/cornell_box.xml -q -D size=200 --passes 16 --spp 256 \
  -o "$work/box.exr"
show() { "$program" tonemap -q "$work/box.exr" -o "$out/$1.png" "${@:2}"; }
show histogram
show histogram_paper --set smooth=false
show contrast_sensitivity --set contrast_sensitivity=true
show glare --set glare=true
show human --set human=true
# As if the lamp had 1/256 and 1/16384 of its light: dusk and starlight.
show human_dusk --set human=true --exposure -8
show human_starlight --set human=true --exposure -14
show color_sensitivity --set color_sensitivity=true --exposure -8
show acuity --set acuity=true --exposure -17
show linear --operator linear --exposure 1
show reinhard --operator reinhard
show reinhard_local --operator reinhard --set local=true
show aces --operator aces --exposure 2.5
show falsecolor --operator falsecolor
show falsecolor_log --operator falsecolor --set scale=log --set contours=lines
show falsecolor_bands --operator falsecolor --set contours=bands --set maximum=50
"$program" render scenes/museum/museum.xml -q -D size=320 --set film.quantity=irradiance \
  --passes 6 --spp 24 -o "$work/museum.exr"
"$program" tonemap -q "$work/museum.exr" -o "$out/illuminance.png" --operator falsecolor \
  --set scale=log
