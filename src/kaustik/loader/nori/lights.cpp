#include "kaustik/loader/nori/lights.h"

#include <cmath>
#include <numbers>

#include "kaustik/loader/object_maker.h"

namespace kaustik::nori {
namespace {

constexpr Rgb white{1, 1, 1};

Rgb times(const Rgb& colour, double factor) {
  return {colour.r * factor, colour.g * factor, colour.b * factor};
}

/// `totalwidth` and `falloffstart` are angles to the axis; the power is that of a cone which falls
/// smoothly: Φ = 2π·I·(1 − (cos falloffstart + cos totalwidth)/2), as in pbrt.
std::shared_ptr<Object> spot_of(Given& given, Reading& reading) {
  const Place& place = given.element().place;
  auto lamp = make_object("emitter", "spot", place);
  const double cutoff = given.number({"totalwidth", "cutoffangle"}).value_or(20);
  const double beam = given.number({"falloffstart", "beamwidth"}).value_or(0.75 * cutoff);
  give(*lamp, "cutoff_angle", cutoff);
  give(*lamp, "beam_width", std::min(beam, cutoff));
  give(*lamp, "falloff", "smooth");
  const double radians = std::numbers::pi / 180;
  const double share = 1 - 0.5 * (std::cos(beam * radians) + std::cos(cutoff * radians));
  if (const auto power = given.colour({"power"}); power && share > 0)
    give(*lamp, "intensity", times(*power, 0.5 / (std::numbers::pi * share)));
  else
    give(*lamp, "intensity", given.colour({"intensity", "radiance"}).value_or(white));
  const Vec3d origin = given.point({"position", "origin"}).value_or(Vec3d(0, 0, 0));
  Vec3d way = given.point({"direction"}).value_or(Vec3d(0, 0, 1));
  if (const auto target = given.point({"lookat", "target"})) way = *target - origin;
  if (const auto own = given.transform({"toworld"})) {
    give(*lamp, "to_world", *own);
  } else if (way.length() > 0 && std::isfinite(way.length())) {
    const Vec3d up = std::fabs(way.y) < 0.9 * way.length() ? Vec3d(0, 1, 0) : Vec3d(1, 0, 0);
    give(*lamp, "to_world", Transform::look_at(origin, origin + way, up));
  }
  reading.approximated(given.element(), "spots of Nori's forks differ: it falls off as in pbrt");
  return lamp;
}

/// In the emitter itself or in its texture.
std::string picture_name(const Object& element) {
  for (const Property& property : element.properties)
    if (plain_name(property.name) == "filename")
      if (const auto* name = std::get_if<std::string>(&property.value)) return *name;
  for (const Child& child : element.children)
    if (child.object->family == "texture")
      if (std::string name = picture_name(*child.object); !name.empty()) return name;
  return {};
}

std::shared_ptr<Object> surroundings_of(Given& given, Reading& reading) {
  const Object& element = given.element();
  given.skip({"filename"});
  auto light = make_object("emitter", "envmap", element.place);
  const auto path = reading.path_of(picture_name(element), element.place, "it gives no light");
  if (!path) {
    given.skip({"strength", "scale", "intensity", "toworld"});
    return nullptr;
  }
  give(*light, "filename", *path);
  if (const auto strength = given.number({"strength", "scale", "intensity"}))
    give(*light, "scale", *strength);
  if (const auto own = given.transform({"toworld"})) give(*light, "to_world", *own);
  reading.approximated(element,
                       "forks turn their pictures in different ways: its upper edge is +y here");
  return light;
}

std::shared_ptr<Object> distant_of(Given& given) {
  auto light = make_object("emitter", "directional", given.element().place);
  give(*light, "irradiance",
       given.colour({"irradiance", "radiance", "power", "intensity"}).value_or(white));
  give(*light, "direction", given.point({"direction"}).value_or(Vec3d(0, 0, 1)));
  return light;
}

}  // namespace

std::shared_ptr<Object> point_lamp(const Rgb& power, const Vec3d& position, const Place& place) {
  auto lamp = make_object("emitter", "point", place);
  give(*lamp, "intensity", times(power, 0.25 / std::numbers::pi));
  give(*lamp, "position", position);
  return lamp;
}

std::shared_ptr<Object> even_light(const Rgb& radiance, bool is_visible, const Place& place) {
  auto light = make_object("emitter", "constant", place);
  give(*light, "radiance", radiance);
  if (!is_visible) give(*light, "visible", false);
  return light;
}

bool is_surroundings(const Object& element) {
  return (element.type.starts_with("env") || element.type.starts_with("infinite")) &&
         !picture_name(element).empty();
}

std::shared_ptr<Object> lamp_of(const Object& element, Reading& reading) {
  Given given(element, reading.deviations);
  if (!is_surroundings(element)) reading.ignore_parts(element);
  const std::string& type = element.type;
  if (type.starts_with("point")) {
    const Vec3d position = given.point({"position", "origin"}).value_or(Vec3d(0, 0, 0));
    if (const auto power = given.colour({"power"}))
      return point_lamp(*power, position, element.place);
    const Rgb intensity = given.colour({"intensity", "radiance", "energy"}).value_or(white);
    return point_lamp(times(intensity, 4 * std::numbers::pi), position, element.place);
  }
  if (type.starts_with("spot")) return spot_of(given, reading);
  if (is_surroundings(element)) return surroundings_of(given, reading);
  if (type == "distant" || type.starts_with("directional")) return distant_of(given);
  constexpr double all_directions = 180;
  const bool is_even =
      type == "constant" || type.starts_with("env") || type == "background" ||
      (type == "distantdisk" && given.number({"thetaa"}).value_or(0) >= all_directions);
  if (is_even) {
    given.skip({"toworld"});
    return even_light(given.colour({"radiance", "color"}).value_or(white), true, element.place);
  }
  reading.ignored(element, "there is no such light here");
  return nullptr;
}

std::shared_ptr<Object> area_lamp_of(const Object& element, Reading& reading) {
  Given given(element, reading.deviations);
  reading.ignore_parts(element);
  if (element.type != "area") {
    reading.ignored(element, "there is no such light of a mesh here");
    return nullptr;
  }
  auto lamp = make_object("emitter", "area", element.place);
  give(*lamp, "radiance", given.colour({"radiance"}).value_or(white));
  return lamp;
}

}  // namespace kaustik::nori
