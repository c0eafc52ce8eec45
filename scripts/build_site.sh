#!/usr/bin/env bash
# Builds the documentation as a site, build/site: the pages of docs by mkdocs, the C++ interface by Doxygen below api/.
# Needs what `scripts/install_packages.sh docs` installs; MathJax comes from npm, once. To read it:
# python3 -m http.server --bind 127.0.0.1 --directory build/site 8000
# Usage: build_site.sh [--no-api]
set -euo pipefail
cd "$(dirname "$0")/.."
case "${1:-}" in
  --no-api) has_api=0 ;;
  "") has_api=1 ;;
  *) echo "usage: $0 [--no-api]" >&2; exit 2 ;;
esac

packages=build/site_packages
if ! cmp -s scripts/site/package-lock.json $packages/package-lock.json || [[ ! -d $packages/node_modules/mathjax ]]; then
  mkdir -p $packages
  cp scripts/site/package.json scripts/site/package-lock.json $packages
  npm ci --prefix $packages --no-audit --no-fund --silent
fi

# What it tells besides warnings, such as which pages are in no navigation, is of no use.
mkdocs build --strict >$packages/mkdocs.txt 2>&1 || { grep -v '^INFO\|^  - ' $packages/mkdocs.txt >&2; exit 1; }
if [[ $has_api == 1 ]]; then
  doxygen -l $packages/api_layout.xml
  sed -i 's|<tab type="mainpage".*|&<tab type="user" url="../index.html" title="Manual"/>|' $packages/api_layout.xml
  KAUSTIK_VERSION=$(sed -n 's/^project(kaustik VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt) doxygen scripts/site/Doxyfile
fi
echo "build/site: $(find build/site -name '*.html' -not -path '*/api/*' | wc -l) pages"
