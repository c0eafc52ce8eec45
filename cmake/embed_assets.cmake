# Writes OUTPUT, a source that holds the bytes of all files in FOLDER: cmake -D FOLDER=… -D OUTPUT=… -P embed_assets.cmake
file(GLOB files LIST_DIRECTORIES false ${FOLDER}/*)
list(SORT files)
set(arrays)
set(rows)
set(number 0)
foreach(path ${files})
  get_filename_component(name ${path} NAME)
  file(READ ${path} digits HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${digits}")
  # A line for each of the file.
  string(REPLACE "0x0a," "0x0a,\n" bytes "${bytes}")
  file(SIZE ${path} size)
  string(APPEND arrays "constexpr unsigned char asset_${number}[] = {${bytes}0};\n")
  string(APPEND rows "      {\"${name}\", {reinterpret_cast<const char*>(asset_${number}), ${size}}},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUTPUT} "// Made by cmake/embed_assets.cmake.
#include \"kaustik/view/assets.h\"

namespace kaustik::view {
namespace {

${arrays}
}  // namespace

const std::vector<Asset>& assets() {
  static const std::vector<Asset> all = {
${rows}  };
  return all;
}

}  // namespace kaustik::view
")
