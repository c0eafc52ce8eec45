// The part of SceneBuilder that finds something for files that are not there.

#include <fmt/format.h>

#include <filesystem>

#include "kaustik/base/photometric_units.h"
#include "kaustik/scene/scene_builder.h"

namespace kaustik {
namespace {

std::shared_ptr<Object> instead_of(const Object& object, const char* type,
                                   std::vector<std::pair<std::string, Value>> properties) {
  auto made = std::make_shared<Object>();
  made->family = object.family;
  made->type = type;
  made->id = object.id;
  made->place = object.place;
  for (auto& [name, value] : properties)
    made->properties.push_back({name, std::move(value), object.place});
  return made;
}

double scale_of(const Object& emitter) {
  for (const Property& property : emitter.properties) {
    if (property.name != "scale") continue;
    if (const auto* number = std::get_if<double>(&property.value)) return *number;
    if (const auto* integer = std::get_if<int64_t>(&property.value)) return double(*integer);
  }
  return 1;
}

/// Of a luminaire: as bright as many are, at its place.
std::shared_ptr<Object> point_instead_of(const Object& luminaire) {
  constexpr double candelas = 1000;
  auto point = instead_of(luminaire, "point",
                          {{"intensity", candelas / lumens_per_watt_white * scale_of(luminaire)}});
  for (const Property& property : luminaire.properties)
    if (property.name == "to_world") point->properties.push_back(property);
  return point;
}

}  // namespace

bool SceneBuilder::lacks_file(const Object& object, const TypeInfo& info,
                              const std::string& consequence) {
  if (is_strict_) return false;
  for (const Property& property : object.properties) {
    const Parameter* row = info.find(property.name);
    const auto* path = std::get_if<std::string>(&property.value);
    std::error_code ignored;
    if (!row || row->kind != ParameterKind::file || !path || path->empty() ||
        std::filesystem::exists(*path, ignored))
      continue;
    if (left_out_.insert(&object).second)
      warnings_.push_back(fmt::format("{}: there is no file '{}': {}", text_of(property.place),
                                      *path, consequence));
    return true;
  }
  return false;
}

std::shared_ptr<Object> SceneBuilder::stand_in_for_file(const Object& object,
                                                        const TypeInfo& info) {
  std::shared_ptr<Object> made;
  if (object.family == "texture" && lacks_file(object, info, "a magenta checker stands for it"))
    made = instead_of(object, "checkerboard",
                      {{"color0", Rgb{0.8, 0, 0.8}},
                       {"color1", Rgb{0.1, 0.1, 0.1}},
                       {"to_uv", Transform::scale({8, 8, 1})}});
  if (object.type == "goniometric" && lacks_file(object, info, "a point of 1000 cd stands for it"))
    made = point_instead_of(object);
  else if (object.family == "emitter" && lacks_file(object, info, "even light stands for it"))
    made = instead_of(object, "constant", {{"radiance", scale_of(object)}});
  if (object.family == "volume" && lacks_file(object, info, "it is 0 everywhere"))
    made = instead_of(object, "constvolume", {{"value", 0.0}});
  if (made) stand_ins_.push_back(made);
  return made;
}

}  // namespace kaustik
