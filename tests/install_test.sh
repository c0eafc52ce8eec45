#!/usr/bin/env bash
# Installs a build, moves the installation, and builds and runs examples/library against it, from a copy that does not see
# the sources. Usage: install_test.sh BUILD_FOLDER COMPILER
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
build=$1
compiler=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
  echo "install_test: $*" >&2
  exit 1
}

install_component() {
  cmake --install "$build" --prefix "$work/$1" --component "$1" >"$work/install.log" || fail "$(cat "$work/install.log")"
}

check_program_alone() {
  [[ -x $work/program/bin/kaustik ]] || fail "component program has no bin/kaustik"
  local library_parts
  library_parts=$(find "$work/program" -name '*.h' -o -name '*.a' -o -name '*.cmake')
  [[ -z $library_parts ]] || fail "component program has parts of the library: $library_parts"
  "$work/program/bin/kaustik" info "$work/program/share/kaustik/scenes/cornell_spheres/cornell_spheres.xml" >/dev/null ||
    fail "the installed program cannot read the installed scene"
  check_manual "$work/program/share"
}

# Man pages and completions are those of the installed program.
check_manual() {
  local program=$work/program/bin/kaustik
  "$program" man render | cmp -s - "$1/man/man1/kaustik-render.1" || fail "man1/kaustik-render.1 is not what the program prints"
  [[ -s $1/man/man1/kaustik.1 ]] || fail "component program has no man1/kaustik.1"
  "$program" completion bash | cmp -s - "$1/bash-completion/completions/kaustik" || fail "no completions for bash"
  "$program" completion zsh | cmp -s - "$1/zsh/site-functions/_kaustik" || fail "no completions for zsh"
  cmp -s "$1/zsh/site-functions/_kaustik" "$1/zsh/vendor-completions/_kaustik" || fail "no completions for zsh on Debian"
  "$program" completion fish | cmp -s - "$1/fish/vendor_completions.d/kaustik.fish" || fail "no completions for fish"
}

# What headers include is installed, or belongs to the packages that find_package(kaustik) finds.
check_headers() {
  local line header
  grep -rhoE '^ *# *include "[^"]+"' "$1" | sort -u | while read -r line; do
    header=${line#*\"} header=${header%\"}
    [[ -e $1/$header ]] || fail "installed headers include $header, which is not installed"
  done
  line=$(grep -rnoE '^ *# *include <[a-z0-9A-Z_]+(/|\.h)[^>]*>' "$1" | grep -vE '<(Imath|fmt)/' || true)
  [[ -z $line ]] || fail "installed headers show libraries that Kaustik hides: $line"
}

check_no_paths() {
  local name
  name=$(grep -rlF -e "$root" -e "$(cd "$build" && pwd)" "$1" || true)
  [[ -z $name ]] || fail "files tell where Kaustik was built: $name"
}

# The example, and a module with the library in it, as those of Python are.
make_consumer() {
  cp -r "$root/examples/library" "$work/consumer"
  cat >>"$work/consumer/CMakeLists.txt" <<'EOF'
add_compile_options(-Wall -Wextra -Wpedantic -Werror)
add_library(module MODULE module.cpp)
target_link_libraries(module PRIVATE kaustik::kaustik)
EOF
  cat >"$work/consumer/module.cpp" <<'EOF'
#include "kaustik/loader/scene_format.h"
#include "kaustik/render/resume.h"
extern "C" void load(const char* path) { kaustik::load_scene(path); }
EOF
}

configure() {
  cmake -S "$1" -B "$1/build" -D CMAKE_PREFIX_PATH="$work/prefix" -D CMAKE_CXX_COMPILER="$compiler" >"$work/log" 2>&1
}

# Output and expected mean, with the noise of 65 536 paths.
check_mean() {
  awk -v want="$2" '{ for (i = NF - 2; i <= NF; ++i) if ($i < want - 0.005 || $i > want + 0.005) bad = 1 }
    END { exit NR != 1 || bad }' <<<"$1" || fail "mean radiance is not $2: $1"
}

# The version of the headers, of the package and of the program is one.
check_version() {
  cat >>"$work/consumer/CMakeLists.txt" <<'EOF'
add_executable(version version.cpp)
target_link_libraries(version PRIVATE kaustik::kaustik)
target_compile_definitions(version PRIVATE FOUND="${kaustik_VERSION}")
EOF
  cat >"$work/consumer/version.cpp" <<'EOF'
#include <cstdio>
#include "kaustik/base/version.h"
int main() {
  std::printf("%s %s %d.%d.%d\n", KAUSTIK_VERSION, FOUND, KAUSTIK_VERSION_MAJOR, KAUSTIK_VERSION_MINOR,
              KAUSTIK_VERSION_PATCH);
}
EOF
  configure "$work/consumer" && cmake --build "$work/consumer/build" --target version >"$work/log" 2>&1 || fail "$(cat "$work/log")"
  local told expected
  told=$("$work/consumer/build/version")
  expected=$("$work/program/bin/kaustik" --version)
  [[ -n $expected && $told == "$expected $expected $expected" ]] ||
    fail "versions of the headers, the package, and by parts are '$told', that of the program is '$expected'"
}

install_component program
check_program_alone
install_component development
mv "$work/development" "$work/prefix"
check_headers "$work/prefix/include"
check_no_paths "$work/prefix"

make_consumer
configure "$work/consumer" || fail "$(cat "$work/log")"
cmake --build "$work/consumer/build" >"$work/log" 2>&1 || fail "$(cat "$work/log")"
check_version
# Half of a sky of 1 is reflected.
check_mean "$("$work/consumer/build/mean_radiance")" 0.5

cat >"$work/sky.xml" <<'EOF'
<scene version="3.0.0">
  <emitter type="constant"><rgb name="radiance" value="2"/></emitter>
  <sensor type="perspective"><film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/></film></sensor>
</scene>
EOF
check_mean "$("$work/consumer/build/mean_radiance" "$work/sky.xml")" 2
status=0
"$work/consumer/build/mean_radiance" "$work/none.xml" 2>"$work/log" || status=$?
[[ $status == 2 ]] && grep -q none.xml "$work/log" || fail "a scene that is not there ends with $status: $(cat "$work/log")"

# A version that this is not, and a library that lacks a part, are refused.
sed -i 's/find_package(kaustik 0.1/find_package(kaustik 0.9/' "$work/consumer/CMakeLists.txt"
! configure "$work/consumer" || fail "version 0.9 is found"
grep -q "0.1" "$work/log" || fail "$(cat "$work/log")"
sed -i 's/find_package(kaustik 0.9/find_package(kaustik 0.1/' "$work/consumer/CMakeLists.txt"
rm "$(find "$work/prefix" -name libkaustik_vcm.a)"
! configure "$work/consumer" || fail "an installation without libkaustik_vcm.a is found"
echo "install_test: passed"
