#include "kaustik/loader/scene_format.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "kaustik/base/error.h"
#include "kaustik/base/file.h"
#include "kaustik/base/gzip.h"
#include "kaustik/loader/gltf/gltf_scene.h"
#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/loader/nori_scene.h"
#include "kaustik/loader/obj_scene.h"
#include "kaustik/loader/pbrt_scene.h"
#include "kaustik/loader/radiance/radiance_scene.h"

namespace kaustik {
namespace {

/// Of a file, for the choice of its format: comments and the like may stand before what tells.
constexpr size_t head_bytes = size_t{64} << 10;
constexpr size_t most_text_bytes = size_t{512} << 20;

/// In lower case; what gzip adds does not count.
std::string name_of(const std::string& path) {
  std::string name = path;
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  return name;
}

bool has_extension(const SceneFormat& format, const std::string& name) {
  return std::any_of(format.extensions.begin(), format.extensions.end(),
                     [&](std::string_view extension) { return name.ends_with(extension); });
}

std::string list_of(const std::vector<SceneFormat>& formats) {
  std::string list;
  for (const SceneFormat& format : formats)
    list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", format.name,
                        fmt::join(format.extensions, ", "));
  return list;
}

/// Null: none.
const SceneFormat* find_format(const std::vector<SceneFormat>& formats, std::string_view head,
                               const std::string& path) {
  const std::string name = name_of(path);
  const SceneFormat *by_contents = nullptr, *by_name = nullptr;
  for (const SceneFormat& format : formats) {
    const bool is_named_so = has_extension(format, name);
    if (is_named_so && !by_name) by_name = &format;
    // Of several that recognise it, the one whose name it has.
    if (format.recognises(head) && (!by_contents || is_named_so)) by_contents = &format;
  }
  return by_contents ? by_contents : by_name;
}

std::string text_of(const std::vector<uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

/// Unpacked.
std::string head_of(const std::string& path) {
  std::vector<uint8_t> start;
  try {
    start = read_file_start(path, head_bytes);
  } catch (const Error& error) {
    const Problem& problem = error.problems().front();
    throw Error(error.kind(), problem.message, problem.remedy, place_in(path));
  }
  return text_of(unpacked_start(start, head_bytes));
}

}  // namespace

const std::vector<SceneFormat>& scene_formats() {
  static const std::vector<SceneFormat> formats = {
      {"Mitsuba XML", {".xml"}, is_mitsuba_xml, load_mitsuba_xml, parse_mitsuba_xml},
      {"pbrt", {".pbrt"}, is_pbrt, load_pbrt, parse_pbrt},
      {"glTF", {".gltf", ".glb"}, is_gltf, load_gltf, parse_gltf},
      {"OBJ", {".obj"}, is_obj, load_obj_scene, parse_obj_scene},
      {"Radiance", {".rad", ".rif", ".vf", ".oct"}, is_radiance, load_radiance, parse_radiance},
      {"Nori XML", {".xml"}, is_nori, load_nori, parse_nori}};
  return formats;
}

const SceneFormat& choose_format(const std::vector<SceneFormat>& formats, std::string_view head,
                                 const std::string& path) {
  if (const SceneFormat* found = find_format(formats, head, path)) return *found;
  throw Error(ErrorKind::input, "this is no scene in a format that Kaustik knows",
              fmt::format("give one of: {}", list_of(formats)), place_in(path));
}

bool has_scene_name(const std::string& path) {
  const std::string name = name_of(path);
  const std::vector<SceneFormat>& formats = scene_formats();
  return std::any_of(formats.begin(), formats.end(),
                     [&](const SceneFormat& format) { return has_extension(format, name); });
}

bool is_scene_file(const std::string& path) {
  return find_format(scene_formats(), head_of(path), path) != nullptr;
}

Description load_scene(const std::string& path, const LoadOptions& options) {
  return choose_format(scene_formats(), head_of(path), path).load(path, options);
}

Description parse_scene(std::string text, std::string name_for_messages,
                        const std::string& base_folder, const LoadOptions& options) {
  const Place where = place_in(name_for_messages);
  text = text_of(unpacked({text.begin(), text.end()}, most_text_bytes, where));
  const std::string_view head = std::string_view(text).substr(0, head_bytes);
  return choose_format(scene_formats(), head, name_for_messages)
      .parse(text, std::move(name_for_messages), base_folder, options);
}

}  // namespace kaustik
