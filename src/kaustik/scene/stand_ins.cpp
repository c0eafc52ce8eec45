// The part of SceneBuilder that finds something for what a scene lacks, or for what nobody knows.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kaustik/scene/scene_builder.h"

namespace kaustik {
namespace {

/// What other renderers call the colour of a surface.
bool is_colour(const std::string& name) {
  return name == "reflectance" || name == "diffuse_reflectance" || name == "base_color" ||
         name == "color";
}

}  // namespace

std::shared_ptr<const Bsdf> SceneBuilder::usual_bsdf() {
  static const Object half{"bsdf", "diffuse", "", {}, {}, {}};
  return create_bsdf(half);
}

std::shared_ptr<const Bsdf> SceneBuilder::black_bsdf() {
  static const Object black{"bsdf", "diffuse", "", {{"reflectance", 0.0, {}}}, {}, {}};
  return create_bsdf(black);
}

std::shared_ptr<const Bsdf> SceneBuilder::bsdf_instead_of(const Object& object) {
  for (const Child& child : object.children)
    if (child.object->family == "bsdf") {
      leave_out(object, fmt::format("'{}' in it stands for it", child.object->type));
      return make_bsdf(child.object);
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
  return create_bsdf(*matt);
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
