#!/usr/bin/env bash
# Tries what `make package` has made where there is nothing else: kaustik_….deb in a bare Debian 12, by apt, and
# kaustik-….tar.xz, unpacked, in a bare Debian 12 and a bare Debian 13. Pictures have to be those of the build's program.
# Usage: try_packages.sh BUILD [FOLDER]; FOLDER keeps the bare Debians (scripts/bare_debian.sh). Needs root, for chroot,
# and the network, for what the .deb depends on.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
build=$(realpath "$1")
bare=${2:-$root/out/bare}
program=$build/kaustik
version=$("$program" --version)
name=kaustik-$version-linux-$(uname -m)
tarball=$build/$name.tar.xz
deb=$build/kaustik_${version}_$(dpkg --print-architecture).deb
scene=scenes/cornell_spheres/cornell_spheres.xml
picture=(-q -D size=96 --passes 2 --spp 4)
# Another libm rounds other numbers up, so that some paths go elsewhere. This much is far below the noise.
tolerance=1e-3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "try_packages: $*" >&2
  exit 1
}

in_bare() {
  "$root/scripts/bare_debian.sh" run "$@"
}

relative_mse() {
  "$program" compare "$1" "$2" | awk '$1 == "relative_mse" { print $2 }'
}

# Pictures of a suite, of what made them: the build's own system gives the same pixels, another one nearly.
check_pictures() {
  local folder=$1 suite=$2 what=$3 limit=$tolerance extension difference
  if grep -q "^VERSION_CODENAME=$suite\$" /etc/os-release; then limit=0; fi
  for extension in exr png; do
    difference=$(relative_mse "$folder/tmp/a.$extension" "$work/reference.$extension")
    awk -v d="$difference" -v most="$limit" 'BEGIN { exit !(d != "" && d + 0 <= most) }' ||
      fail "$what in $suite: $extension differs from that of the build, relative MSE '$difference', may be $limit"
    echo "$what in $suite: $extension as by the build's program, relative MSE $difference"
    rm "$folder/tmp/a.$extension"
  done
}

# FOLDER SUITE WHAT PROGRAM, with the program's path in the folder.
try_program() {
  local folder=$1 suite=$2 what=$3 path=$4 told
  told=$(in_bare "$folder" "$path" --version) || fail "$what does not start in $suite"
  [[ $told == "$version" ]] || fail "$what in $suite is version '$told', not $version"
  # From a folder that has no scenes.
  told=$(in_bare "$folder" sh -c 'cd /tmp && exec "$@"' sh "$path" info "$scene") || fail "$what in $suite has no $scene"
  [[ $told == *sensor* || $told == *camera* ]] || fail "$what in $suite tells of $scene: $told"
  in_bare "$folder" sh -c 'cd /tmp && exec "$@"' sh "$path" render "$scene" "${picture[@]}" -o a.exr -o a.png ||
    fail "$what does not render in $suite"
  check_pictures "$folder" "$suite" "$what"
}

try_tarball() {
  local folder=$work/$1 suite=$1 path=/opt/$name/bin/kaustik
  mkdir -p "$folder/opt" "$folder/tmp/others"
  tar -xJf "$tarball" -C "$folder/opt"
  try_program "$folder" "$suite" "the tarball" "$path"
  # Libraries of the same names that are for other programs.
  touch "$folder"/tmp/others/{libtbb.so.12,libembree3.so.3,libz.so.1,libtiff.so.6}
  in_bare "$folder" env LD_LIBRARY_PATH=/tmp/others "$path" --version >/dev/null ||
    fail "the tarball takes libraries from LD_LIBRARY_PATH"
}

try_deb() {
  local folder=$work/$1 suite=$1
  cp "$deb" "$folder/tmp/kaustik.deb"
  in_bare "$folder" sh -c 'apt-get update -qq && DEBIAN_FRONTEND=noninteractive apt-get install -y -qq \
    --no-install-recommends -o Dpkg::Use-Pty=0 -o Dpkg::Options::=--force-unsafe-io /tmp/kaustik.deb' >"$work/log" 2>&1 ||
    fail "$(basename "$deb") is not installed in $suite: $(cat "$work/log")"
  try_program "$folder" "$suite" "the .deb" /usr/bin/kaustik
}

# On a processor of 2008 there is a message, on one of 2009 it runs.
try_processors() {
  local path=$work/bookworm/opt/$name/bin/kaustik status=0
  [[ $(uname -m) == x86_64 ]] || return 0
  qemu-x86_64 -cpu Penryn "$path" --version >"$work/log" 2>&1 || status=$?
  if [[ $status != 1 ]] || ! grep -q 'SSE4.2 and POPCNT' "$work/log"; then
    fail "on a processor without SSE4.2 the program ends with $status: $(cat "$work/log")"
  fi
  qemu-x86_64 -cpu Nehalem "$path" render "$work/bookworm/opt/$name/share/kaustik/$scene" -q -D size=16 --passes 1 --spp 1 \
    -o "$work/nehalem.exr" || fail "the program does not render on x86-64-v2"
  echo "the tarball tells of processors below x86-64-v2, and renders on that"
}

try_again() {
  "$root/scripts/portable_tarball.py" "$build" "$work/again" >"$work/log" || fail "$(cat "$work/log")"
  cmp "$tarball" "$work/again/$name.tar.xz" || fail "the tarball is not the same when it is made again"
  echo "made again, the tarball is the same: sha256 $(sha256sum "$tarball" | cut -c1-64)"
}

[[ -e $tarball && -e $deb ]] || fail "there is no $tarball or no $deb: make package"
for suite in bookworm trixie; do
  "$root/scripts/bare_debian.sh" make "$bare/$suite.tar" "$suite"
done
"$program" render "$root/$scene" "${picture[@]}" -o "$work/reference.exr" -o "$work/reference.png"
for suite in trixie bookworm; do
  "$root/scripts/bare_debian.sh" unpack "$bare/$suite.tar" "$work/$suite"
  try_tarball "$suite"
done
try_deb bookworm
try_processors
try_again
echo "try_packages: passed; $(du -h --apparent-size "$tarball" "$deb" | sed "s,$build/,," | tr '\t\n' ' ;')"
