#!/usr/bin/env bash
# Installs the Debian packages of the named groups: build, check, coverage, package, package-test, bare, bench, mpi,
# python, wheel, notebooks, view, docs. Asks nothing, and needs no network when everything is there already.
set -euo pipefail

build=(cmake ninja-build pkg-config python3 libembree-dev libtbb-dev libimath-dev libopenexr-dev libtiff-dev
  libpng-dev libjpeg62-turbo-dev libwebp-dev libhwy-dev libpugixml-dev zlib1g-dev libcli11-dev libfmt-dev libgtest-dev libnanoflann-dev nlohmann-json3-dev libdraco-dev
  libboost1.81-dev)
check=(clang clang-format lld libclang-rt-14-dev)
coverage=(llvm-14)
package=(dpkg-dev file patchelf)
package_test=(qemu-user)
bare=(mmdebstrap)
bench=(blender povray)
mpi=(libopenmpi-dev openmpi-bin)
python=(python3 python3-dev python3-venv python3-pytest python3-numpy pybind11-dev)
wheel=(patchelf)
notebooks=(python3-nbclient python3-nbformat python3-ipykernel python3-matplotlib)
view=(chromium)
docs=(mkdocs mkdocs-material python3-pymdownx doxygen)
# Whoever has them from elsewhere keeps those.
command -v npm >/dev/null || { view+=(nodejs npm); docs+=(nodejs npm); }

wanted=()
for group in "$@"; do
  case $group in
    build) wanted+=("${build[@]}") ;;
    check) wanted+=("${check[@]}") ;;
    coverage) wanted+=("${coverage[@]}") ;;
    package) wanted+=("${package[@]}") ;;
    package-test) wanted+=("${package_test[@]}") ;;
    bare) wanted+=("${bare[@]}") ;;
    bench) wanted+=("${bench[@]}") ;;
    mpi) wanted+=("${mpi[@]}") ;;
    python) wanted+=("${python[@]}") ;;
    wheel) wanted+=("${wheel[@]}") ;;
    notebooks) wanted+=("${notebooks[@]}") ;;
    view) wanted+=("${view[@]}") ;;
    docs) wanted+=("${docs[@]}") ;;
    *) echo "$0: no group '$group'; there are build, check, coverage, package, package-test, bare, bench, mpi, python, wheel, notebooks, view and docs" >&2; exit 2 ;;
  esac
done

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  echo "$0: no apt-get here: install what corresponds to these Debian packages yourself:" >&2
  echo "  ${wanted[*]}" >&2
  exit 0
fi

missing=()
for name in "${wanted[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$name" 2>/dev/null) || status=
  [[ $status == installed ]] || missing+=("$name")
done
[[ ${#missing[@]} -gt 0 ]] || exit 0

as_root=()
if [[ $(id -u) -ne 0 ]]; then
  if ! command -v sudo >/dev/null; then
    echo "$0: missing packages, and neither root nor sudo to install them: ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "installing ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
