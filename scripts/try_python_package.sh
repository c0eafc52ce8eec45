#!/usr/bin/env bash
# Unpacks python3-kaustik_….deb of `make package` and renders with what is in it, as Debian's Python finds it.
# Usage: try_python_package.sh PACKAGE.deb
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
dpkg-deb -x "$1" "$work"
depends=$(dpkg-deb -f "$1" Depends)
for name in 'python3 (>= 3.' 'libembree' 'libtbb' 'libopenexr'; do
  [[ $depends == *"$name"* ]] || { echo "$0: $1 does not ask for $name: $depends" >&2; exit 1; }
done
ldd "$work"/usr/lib/python3/dist-packages/kaustik/_native*.so | grep -q 'not found' &&
  { echo "$0: the compiled part lacks libraries" >&2; exit 1; }
cd "$work"
env -u PYTHONHOME PYTHONPATH=usr/lib/python3/dist-packages PYTHONDONTWRITEBYTECODE=1 \
  /usr/bin/python3 "$root/python/examples/first_caustic.py" ring.png
[[ -s ring.png ]]
echo "$(basename "$1") renders; it asks for $depends"
