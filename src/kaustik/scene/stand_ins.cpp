// The part of SceneBuilder that finds something for what a scene lacks, or for what nobody knows.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kaustik/scene/find_row.h"
#include "kaustik/scene/scene_builder.h"
#include "kaustik/scene/types_to_come.h"

namespace kaustik {
namespace {

/// What other renderers call the colour of a surface.
bool is_colour(const std::string& name) {
  return name == "reflectance" || name == "diffuse_reflectance" || name == "base_color" ||
         name == "color";
}

/// Of filters of polarised light, where light is not; null: it is none.
std::shared_ptr<const Object> sheet_instead_of(const Object& filter) {
  if (filter.type == "retarder")
    return std::make_shared<Object>(Object{"bsdf", "null", "", {}, {}, filter.place});
  if (filter.type != "polarizer" && filter.type != "circular") return nullptr;
  auto sheet = std::make_shared<Object>(
      Object{"bsdf", "mask", "", {{"opacity", 0.5, filter.place}}, {}, filter.place});
  sheet->children.push_back(
      {"", std::make_shared<Object>(Object{
               "bsdf", "diffuse", "", {{"reflectance", 0.0, filter.place}}, {}, filter.place})});
  return sheet;
}

bool has(const Object& object, const std::string& name) {
  return std::any_of(object.properties.begin(), object.properties.end(),
                     [&](const Property& property) { return property.name == name; }) ||
         std::any_of(object.children.begin(), object.children.end(),
                     [&](const Child& child) { return child.name == name; });
}

}  // namespace

std::shared_ptr<const Bsdf> SceneBuilder::usual_bsdf() {
  static const Object half{"bsdf", "diffuse", "", {}, {}, {}};
  return create_bsdf(half, nullptr);
}

std::shared_ptr<const Bsdf> SceneBuilder::black_bsdf() {
  static const Object black{"bsdf", "diffuse", "", {{"reflectance", 0.0, {}}}, {}, {}};
  return create_bsdf(black, nullptr);
}

std::shared_ptr<const Bsdf> SceneBuilder::bsdf_instead_of(const Object& object,
                                                          const BuiltShape* on) {
  for (const Child& child : object.children)
    if (child.object->family == "bsdf") {
      leave_out(object, fmt::format("'{}' in it stands for it", child.object->type));
      return make_bsdf(child.object, on);
    }
  if (const auto sheet = sheet_instead_of(object)) {
    leave_out(object, sheet->type == "null" ? "light passes" : "half of the light passes");
    stand_ins_.push_back(sheet);
    return create_bsdf(*sheet, on);
  }
  const auto matt = std::make_shared<Object>();
  matt->family = "bsdf";
  matt->type = "diffuse";
  matt->place = object.place;
  for (const Property& property : object.properties)
    if (is_colour(property.name) && matt->properties.empty())
      matt->properties.push_back({"reflectance", property.value, property.place});
  for (const Child& child : object.children)
    if (is_colour(child.name) && matt->properties.empty() && matt->children.empty())
      matt->children.push_back({"reflectance", child.object});
  leave_out(object, "a matt surface stands for it");
  stand_ins_.push_back(matt);
  return create_bsdf(*matt, on);
}

const Object* SceneBuilder::emitter_instead_of(const PendingLight& pending) {
  const Object& emitter = *pending.object;
  const std::vector<std::string> valid = names_of(light_types());
  const bool is_to_come = remedy_for_type_to_come(emitter).has_value();
  if (!is_to_come && !is_foreign(emitter, valid)) {
    unknown_type(emitter, valid);
    return nullptr;
  }
  if (is_strict_) {
    not_here_yet(emitter);
    return nullptr;
  }
  const char* instead = pending.shape                ? "area"
                        : has(emitter, "intensity")  ? "point"
                        : has(emitter, "irradiance") ? "directional"
                        : has(emitter, "radiance")   ? "constant"
                                                     : "";
  if (*instead == '\0' || (pending.shape && !has(emitter, "radiance"))) {
    leave_out(emitter, "it is left out");
    return nullptr;
  }
  leave_out(emitter, fmt::format("'{}' stands for it", instead));
  const auto known = std::make_shared<Object>(emitter);
  known->type = instead;
  stand_ins_.push_back(known);
  return known.get();
}

const Object* SceneBuilder::shape_instead_of(const Object& shape) {
  if (!is_foreign(shape, names_of(shape_types()))) return nullptr;
  for (const Property& property : shape.properties) {
    const auto* file = std::get_if<std::string>(&property.value);
    if (property.name != "filename" || !file) continue;
    for (const char* type : {"obj", "ply", "serialized"}) {
      if (!file->ends_with(std::string(".") + type)) continue;
      leave_out(shape, fmt::format("'{}' stands for it", type));
      const auto known = std::make_shared<Object>(shape);
      known->type = type;
      stand_ins_.push_back(known);
      return known.get();
    }
  }
  return nullptr;
}

const Object* SceneBuilder::sensor_instead_of(const Object& sensor) {
  if (is_strict_ || sensor.type != "perspective_rdist") return nullptr;
  leave_out(sensor, "'perspective' stands for it, without its radial distortion");
  const auto pinhole = std::make_shared<Object>(sensor);
  pinhole->type = "perspective";
  std::erase_if(pinhole->properties,
                [](const Property& property) { return property.name == "kc"; });
  stand_ins_.push_back(pinhole);
  return pinhole.get();
}

bool SceneBuilder::place_camera(const Place& place) {
  if (shapes_.empty() && instances_.empty()) {
    problems_.add("the scene has no camera",
                  "add a sensor of type 'perspective', with a 'to_world'", place);
    return false;
  }
  // Mitsuba's: along z, before the scene, as far back as its larger side fills 45 degrees.
  constexpr double field = 45;
  const Vec3f size = bounds_.max - bounds_.min, centre = (bounds_.max + bounds_.min) * 0.5f;
  const double side = double(max_abs(size));
  const double back = side / (2 * std::tan(field / 2 * std::numbers::pi / 180));
  const Transform to_world =
      Transform::translate({double(centre.x), double(centre.y), double(bounds_.min.z) - back});
  const auto camera = std::make_shared<Object>();
  *camera = {"sensor", "perspective", "", {{"fov", field, place}, {"to_world", to_world, place}},
             {},       place};
  stand_ins_.push_back(camera);
  sensor_ = camera.get();
  told_unless_strict(
      "the scene has no camera",
      "add a sensor of type 'perspective', with a 'to_world'; one that looks along z "
      "at the whole scene stands for it",
      place);
  return true;
}

}  // namespace kaustik
