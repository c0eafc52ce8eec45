# Writes OUTPUT, a source that holds the bytes of all files FOLDER/PATTERN: see kaustik_embed().
file(GLOB files LIST_DIRECTORIES false ${FOLDER}/${PATTERN})
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
#include \"${HEADER}\"

namespace ${NAMESPACE} {
namespace {

${arrays}
}  // namespace

const std::vector<${TYPE}>& ${FUNCTION}() {
  static const std::vector<${TYPE}> all = {
${rows}  };
  return all;
}

}  // namespace ${NAMESPACE}
")
