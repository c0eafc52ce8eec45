#include "kaustik/loader/mitsuba3_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "kaustik/loader/object_parts.h"

namespace kaustik {
namespace {

namespace fs = std::filesystem;

constexpr size_t longest_name = 60;

/// As any system takes it.
std::string plain_name(std::string text) {
  for (char& c : text)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_' && c != '.') c = '_';
  return text.substr(0, longest_name);
}

struct KeyText {
  std::string operator()(bool b) const { return b ? "true" : "false"; }
  std::string operator()(int64_t number) const { return fmt::format("{}", number); }
  std::string operator()(double number) const { return fmt::format("{}", number); }
  std::string operator()(const std::string& text) const { return text; }
  std::string operator()(const Transform& transform) const {
    std::string text;
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column)
        text += fmt::format("{} ", transform.at(row, column));
    return text;
  }
  std::string operator()(const std::shared_ptr<const Array>& array) const {
    return fmt::format("{:x}", array->digest());
  }
  /// Nothing of the kind makes a difference to a mesh or a picture.
  template <typename Other>
  std::string operator()(const Other&) const {
    return {};
  }
};

std::string key_of(const Object& object, const std::set<std::string_view>& names) {
  std::string key = object.family + '\n' + object.type + '\n';
  for (const std::string_view name : names)
    if (const Property* property = find_property(object, name))
      key += fmt::format("{}={}\n", name, std::visit(KeyText(), property->value));
  for (const Child& child : object.children)
    if (child.object->family == "texture")
      key += fmt::format("{}\n", static_cast<const void*>(child.object.get()));
  return key;
}

}  // namespace

FilesToWrite::FilesToWrite(const std::string& scene_file) {
  const fs::path path(scene_file);
  stem_ = (path.parent_path() / path.stem()).string();
}

std::string FilesToWrite::new_name(const Object& source, const char* ending) {
  const auto* file = value_in<std::string>(source, "filename");
  const auto* material = value_in<std::string>(source, "material");
  std::string what = file ? fs::path(*file).stem().string() : source.type;
  if (material) what += "_" + (material->empty() ? "rest" : *material);
  const std::string name = stem_ + "_" + plain_name(what);
  std::string path = name + ending;
  for (int number = 2; !names_.insert(path).second; ++number)
    path = fmt::format("{}_{}{}", name, number, ending);
  return path;
}

void FilesToWrite::use(const std::string& key, const std::shared_ptr<Object>& user,
                       const Object& source, const Rgb& factor, const char* ending) {
  const auto [known, is_new] = known_.try_emplace(key, files_.size());
  if (is_new)
    files_.push_back({new_name(source, ending), std::make_shared<Object>(source), factor});
  files_[known->second].users.push_back(user);
  remove_property(*user, "filename");
  user->properties.insert(user->properties.begin(),
                          {"filename", files_[known->second].path, source.place});
}

void FilesToWrite::use_ply(const std::shared_ptr<Object>& shape, const Object& source) {
  const auto* is_flat = value_in<bool>(source, "face_normals");
  const bool is_placed = find_property(source, "max_smooth_angle") && !(is_flat && *is_flat);
  std::set<std::string_view> names = {
      "filename", "shape_index",      "material",     "flip_tex_coords", "scale",     "width",
      "height",   "max_smooth_angle", "face_normals", "positions",       "faces",     "normals",
      "uv",       "vertex_color",     "face_color",   "vertex_value",    "face_value"};
  if (is_placed) names.insert("to_world");
  shape->type = "ply";
  if (source.type == "heightfield") {
    const auto* is_smooth = value_in<bool>(source, "shading_normals");
    if (is_smooth && !*is_smooth) shape->properties.push_back({"face_normals", true, source.place});
    std::erase_if(shape->children,
                  [](const Child& child) { return child.object->family == "texture"; });
  }
  std::erase_if(shape->properties, [&](const Property& property) {
    return property.name != "face_normals" && property.name != "flip_normals" &&
           (property.name != "to_world" || is_placed);
  });
  use(key_of(source, names), shape, source, {1, 1, 1}, ".ply");
}

void FilesToWrite::use_exr(const std::shared_ptr<Object>& bitmap, const Rgb& factor) {
  const Object source = *bitmap;
  for (const char* name : {"gamma", "channel", "data", "invert", "power"})
    remove_property(*bitmap, name);
  const std::string key = key_of(source, {"filename", "data", "gamma", "channel", "raw",
                                          "as_number", "invert", "power"}) +
                          fmt::format("{} {} {}", factor.r, factor.g, factor.b);
  use(key, bitmap, source, factor, ".exr");
}

void FilesToWrite::use_exr_around(const std::shared_ptr<Object>& envmap) {
  Object source = *envmap;
  source.family = "texture";
  source.type = "bitmap";
  source.children.clear();
  std::erase_if(source.properties, [](const Property& p) { return p.name != "data"; });
  const std::string key = key_of(source, {"data"});
  source.properties.push_back({"raw", true, envmap->place});
  remove_property(*envmap, "data");
  use(key, envmap, source, {1, 1, 1}, ".exr");
}

void FilesToWrite::use_vol(const std::shared_ptr<Object>& volume) {
  const Object source = *volume;
  remove_property(*volume, "data");
  use(key_of(source, {"data"}), volume, source, {1, 1, 1}, ".vol");
}

}  // namespace kaustik
