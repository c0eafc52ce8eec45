#!/usr/bin/env bash
# Renders with a wheel of `make wheel` in a Debian 12 that has nothing but python3: what the wheel lacks is not there.
# Usage: try_wheel.sh WHEEL [BARE.tar]; BARE.tar is that Debian, and is made (by mmdebstrap, from the network) if it is
# not there. Needs root, for chroot.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
wheel=$(realpath "$1")
bare=${2:-$root/out/bare.tar}

if [[ ! -e $bare ]]; then
  "$root/scripts/install_packages.sh" wheel
  mkdir -p "$(dirname "$bare")"
  mmdebstrap --quiet --variant=minbase --include=python3 --dpkgopt=force-unsafe-io bookworm "$bare"
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
tar -xf "$bare" -C "$work" --exclude='./dev/*'
cp "$wheel" "$root/python/tests/wheel_trial.py" "$work/tmp/"
# There is no pip: a wheel is an archive of what it installs.
chroot "$work" python3 -m zipfile -e "/tmp/$(basename "$wheel")" /opt/kaustik
chroot "$work" env PYTHONPATH=/opt/kaustik PYTHONDONTWRITEBYTECODE=1 python3 /tmp/wheel_trial.py
