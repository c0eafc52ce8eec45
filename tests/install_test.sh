#!/usr/bin/env bash
# Installs a build, moves the installation, and builds and runs examples/library against it, from a copy that sees neither
# the sources nor what libkaustik links. Usage: install_test.sh BUILD_FOLDER COMPILER
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
build=$1
compiler=$2
source "$root/tests/support/script.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

install_component() {
  cmake --install "$build" --prefix "$work/$1" --component "$1" >"$work/install.log" || fail "$(cat "$work/install.log")"
}

check_program_alone() {
  [[ -x $work/program/bin/kaustik ]] || fail "component program has no bin/kaustik"
  local library_parts
  library_parts=$(find "$work/program" -name '*.h' -o -name '*.a' -o -name '*.so*' -o -name '*.cmake')
  [[ -z $library_parts ]] || fail "component program has parts of the library: $library_parts"
  "$work/program/bin/kaustik" info "$work/program/share/kaustik/scenes/cornell_spheres/cornell_spheres.xml" >/dev/null ||
    fail "the installed program cannot read the installed scene"
  (cd "$work" && program/bin/kaustik info scenes/cornell_spheres/cornell_spheres.xml) >/dev/null ||
    fail "the installed program does not find its scenes by scenes/…"
  [[ -s $work/program/share/doc/kaustik/docs/comparisons.md ]] || fail "component program has no pages"
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

# The headers show the standard library and one another, and no macros but their attribute.
check_headers() {
  local line header
  grep -rhoE '^ *# *include "[^"]+"' "$1" | sort -u | while read -r line; do
    header=${line#*\"} header=${header%\"}
    [[ -e $1/$header ]] || fail "installed headers include $header, which is not installed"
  done
  line=$(grep -rnoE '^ *# *include <[^>]*[/.][^>]*>' "$1" || true)
  [[ -z $line ]] || fail "installed headers include what is not of the standard library: $line"
  line=$(grep -rnE '^ *# *define' "$1" | grep -v 'define KAUSTIK_EXPORT ' || true)
  [[ -z $line ]] || fail "installed headers define macros: $line"
}

check_no_paths() {
  local name
  name=$(grep -rlF -e "$root" -e "$(cd "$build" && pwd)" "$1" || true)
  [[ -z $name ]] || fail "files tell where Kaustik was built: $name"
}

# What runs is one library, which the other component's link leads to, and no archives.
check_library_alone() {
  local files
  files=$(cd "$work/library" && find . -type f -o -type l | sed 's,.*/,,' | sort | tr '\n' ' ')
  [[ $files =~ ^libkaustik\.so\.0\ libkaustik\.so\.0\.[0-9.]+\ $ ]] || fail "component library has: $files"
  files=$(find "$work/development" -name '*.a')
  [[ -z $files ]] || fail "component development has archives: $files"
}

# The example, and each header by itself.
make_consumer() {
  cp -r "$root/examples/library" "$work/consumer"
  cat >>"$work/consumer/CMakeLists.txt" <<'EOF'
add_compile_options(-Wall -Wextra -Wpedantic -Wshadow -Werror)
file(GLOB headers_alone *_alone.cpp)
add_library(headers OBJECT ${headers_alone})
target_link_libraries(headers PRIVATE kaustik::kaustik)
EOF
  local header
  for header in "$work"/prefix/include/kaustik/*.h; do
    header=$(basename "$header")
    echo "#include <kaustik/$header>" >"$work/consumer/${header%.h}_alone.cpp"
  done
}

# Without any of what libkaustik links itself.
configure() {
  local hidden=() name
  for name in PkgConfig Threads Imath TBB fmt OpenEXR TIFF PNG JPEG pugixml ZLIB embree; do
    hidden+=(-D "CMAKE_DISABLE_FIND_PACKAGE_$name=ON")
  done
  cmake -S "$1" -B "$1/build" -D CMAKE_PREFIX_PATH="$work/prefix" -D CMAKE_CXX_COMPILER="$compiler" "${hidden[@]}" \
    >"$work/log" 2>&1
}

# Name, expected mean and output: that mean is as much within a hundredth.
check_mean() {
  awk -v name="$1:" -v want="$2" '$1 == name { found = 1; mean = $(NF - 3) }
    END { exit !found || mean < want - 0.01 * want || mean > want + 0.01 * want }' <<<"$3" ||
    fail "mean radiance '$1' is not $2: $3"
}

# The version of the library, of the headers, of the package and of the program is one.
check_version() {
  cat >>"$work/consumer/CMakeLists.txt" <<'EOF'
add_executable(version version.cpp)
target_link_libraries(version PRIVATE kaustik::kaustik)
target_compile_definitions(version PRIVATE FOUND="${kaustik_VERSION}")
EOF
  cat >"$work/consumer/version.cpp" <<'EOF'
#include <kaustik/version.h>

#include <cstdio>
int main() {
  std::printf("%s %s %s %d.%d.%d\n", kaustik::v0::version(), kaustik::v0::header_version, FOUND,
              kaustik::v0::header_version_major, kaustik::v0::header_version_minor,
              kaustik::v0::header_version_patch);
}
EOF
  configure "$work/consumer" && cmake --build "$work/consumer/build" --target version >"$work/log" 2>&1 || fail "$(cat "$work/log")"
  local told expected
  told=$("$work/consumer/build/version")
  expected=$("$work/program/bin/kaustik" --version)
  [[ -n $expected && $told == "$expected $expected $expected $expected" ]] ||
    fail "versions of the library, the headers, the package, and by parts are '$told', that of the program is '$expected'"
}

# Without CMake.
check_pkg_config() {
  command -v pkg-config >/dev/null || return 0
  local folder flags
  folder=$(dirname "$(find "$work/prefix" -name kaustik.pc)")
  flags=$(PKG_CONFIG_PATH=$folder pkg-config --cflags --libs kaustik) || fail "pkg-config does not find kaustik"
  # shellcheck disable=SC2086 # they are words
  "$compiler" -std=c++20 "$work/consumer/main.cpp" -o "$work/by_pkg_config" $flags -Wl,-rpath,"$(dirname "$folder")" ||
    fail "pkg-config's flags do not build the example: $flags"
  check_mean scene 0.5 "$("$work/by_pkg_config")"
  # The whole program of the manual.
  awk '/^```cpp/ { inside = 1; text = ""; next }
       /^```/ { if (inside && text ~ /int main/) printf "%s", text; inside = 0 }
       inside { text = text $0 "\n" }' "$root/docs/guides/cpp.md" >"$work/manual.cpp"
  # shellcheck disable=SC2086 # they are words
  "$compiler" -std=c++20 "$work/manual.cpp" -o "$work/manual" $flags -Wl,-rpath,"$(dirname "$folder")" ||
    fail "the program of docs/guides/cpp.md does not compile"
  make_sky
  output=$("$work/manual" "$work/sky.xml" "$work/manual.exr")
  [[ $output == "mean: 2.0000 W/(sr·m²)" && -s $work/manual.exr ]] || fail "the manual's program has told: $output"
}

# A sky of radiance 2.
make_sky() {
  cat >"$work/sky.xml" <<'EOF'
<scene version="3.0.0">
  <emitter type="constant"><rgb name="radiance" value="2"/></emitter>
  <sensor type="perspective"><film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/></film></sensor>
</scene>
EOF
}

install_component program
check_program_alone
install_component library
install_component development
check_library_alone
mkdir "$work/prefix"
cp -a "$work/library/." "$work/development/." "$work/prefix"
rm -r "$work/library" "$work/development"
check_headers "$work/prefix/include"
check_no_paths "$work/prefix"

make_consumer
configure "$work/consumer" || fail "$(cat "$work/log")"
cmake --build "$work/consumer/build" >"$work/log" 2>&1 || fail "$(cat "$work/log")"
check_version
# Half of a sky of 1 is reflected, and of one of 2.
output=$("$work/consumer/build/mean_radiance")
check_mean scene 0.5 "$output"
check_mean brighter 1 "$output"
check_pkg_config
# The other example: a picture, and how bright it is at points.
output=$("$work/consumer/build/rippled_glass" "$work/glass.jpg" 32 2 2>"$work/log") || fail "$(cat "$work/log")"
[[ -s $work/glass.jpg && $output == *"irradiance at (-0.3, -1): "*" W/m²"* ]] || fail "rippled_glass has told: $output"

make_sky
check_mean scene 2 "$("$work/consumer/build/mean_radiance" "$work/sky.xml" "$work/sky.exr")"
[[ -s $work/sky.exr ]] || fail "the example wrote no picture"
status=0
"$work/consumer/build/mean_radiance" "$work/none.xml" 2>"$work/log" || status=$?
[[ $status == 2 ]] && grep -q none.xml "$work/log" || fail "a scene that is not there ends with $status: $(cat "$work/log")"

# A version that this is not, and an installation without its library, are refused.
sed -i 's/find_package(kaustik 0.1/find_package(kaustik 0.9/' "$work/consumer/CMakeLists.txt"
! configure "$work/consumer" || fail "version 0.9 is found"
grep -q "0.1" "$work/log" || fail "$(cat "$work/log")"
sed -i 's/find_package(kaustik 0.9/find_package(kaustik 0.1/' "$work/consumer/CMakeLists.txt"
rm "$(find "$work/prefix" -name 'libkaustik.so.0.*')"
! configure "$work/consumer" || fail "an installation without libkaustik is found"
echo "install_test: passed"
