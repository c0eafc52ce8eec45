#!/usr/bin/env bash
# Renders with a wheel of `make wheel` in a Debian 12 that has nothing but python3: what the wheel lacks is not there.
# Usage: try_wheel.sh WHEEL [BARE.tar]; BARE.tar is that Debian, and is made (scripts/bare_debian.sh) if it is not there.
# Needs root, for chroot.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
wheel=$(realpath "$1")
bare=${2:-$root/out/bare/bookworm_python3.tar}

"$root/scripts/bare_debian.sh" make "$bare" bookworm python3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$root/scripts/bare_debian.sh" unpack "$bare" "$work"
cp "$wheel" "$root/python/tests/wheel_trial.py" "$work/tmp/"
# There is no pip: a wheel is an archive of what it installs.
"$root/scripts/bare_debian.sh" run "$work" python3 -m zipfile -e "/tmp/$(basename "$wheel")" /opt/kaustik
"$root/scripts/bare_debian.sh" run "$work" env PYTHONPATH=/opt/kaustik PYTHONDONTWRITEBYTECODE=1 \
  python3 /tmp/wheel_trial.py
