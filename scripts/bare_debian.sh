#!/usr/bin/env bash
# A Debian that has only what is essential, apt, and the named packages: made by mmdebstrap, or kept from the time before.
# Usage: bare_debian.sh make TAR SUITE [PACKAGE…]     makes TAR, unless it is there, from where apt has its packages
#        bare_debian.sh unpack TAR FOLDER
#        bare_debian.sh run FOLDER COMMAND…           with /proc and /dev, which only COMMAND sees; needs root
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)

make_bare() {
  local tar=$1 suite=$2 mirror partial
  local packages=("${@:3}") options=()
  [[ ! -e $tar ]] || return 0
  "$root/scripts/install_packages.sh" bare
  mkdir -p "$(dirname "$tar")"
  # shellcheck disable=SC2016 # apt puts in what these stand for
  mirror=$(apt-get indextargets --format '$(ORIGIN) $(LABEL) $(SITE)' 'Created-By: Packages' |
    sed -n '/^Debian Debian /{s///p;q}')
  [[ ${#packages[@]} -eq 0 ]] || options=(--include="$(IFS=,; echo "${packages[*]}")")
  echo "making a bare $suite, $tar"
  partial=$tar.part.tar
  mmdebstrap --quiet --variant=minbase --dpkgopt=force-unsafe-io "${options[@]}" "$suite" "$partial" ${mirror:+"$mirror"}
  mv "$partial" "$tar"
}

unpack() {
  mkdir -p "$2"
  tar -xf "$1" -C "$2" --exclude='./dev/*'
  # Names and proxies are those of this machine.
  cp -L /etc/resolv.conf "$2/etc/resolv.conf"
  apt-config dump | grep -E '^Acquire::.*Proxy' >"$2/etc/apt/apt.conf.d/90proxy" || true
}

run() {
  # shellcheck disable=SC2016 # the inner shell puts them in
  unshare --mount --pid --fork sh -c \
    'mount --rbind /dev "$1/dev" && mount -t proc proc "$1/proc" && exec chroot "$@"' sh "$@"
}

case "${1:-}" in
  make) make_bare "${@:2}" ;;
  unpack) unpack "$2" "$3" ;;
  run) run "${@:2}" ;;
  *) sed -n '2,5s/^# //p' "$0" >&2; exit 2 ;;
esac
