#include "kaustik/loader/gltf/gltf_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kaustik/loader/framing.h"
#include "kaustik/loader/object_maker.h"

namespace kaustik::gltf {
namespace {

constexpr double degrees_per_radian = 180 / std::numbers::pi;

Vec3d axis_of(const Transform& transform, int column) {
  return {transform.at(0, column), transform.at(1, column), transform.at(2, column)};
}

std::string free_id(std::string id, std::set<std::string>& ids) {
  std::string candidate = id;
  constexpr size_t most_in_turn = 100;  // where more are alike the search would take long
  for (size_t i = 2; !ids.insert(candidate).second; i += i < most_in_turn ? 1 : ids.size())
    candidate = fmt::format("{} {}", id, i);
  return candidate;
}

std::shared_ptr<Object> perspective(const File& file, const JsonValue& camera) {
  const JsonValue* lens = camera.find("perspective");
  const double angle = lens ? file.number(*lens, "yfov", 0) : 0;
  if (!(angle > 0 && angle < std::numbers::pi))
    file.fail(camera, "the camera's 'yfov' is not between 0 and π", "give an angle in radians");
  auto sensor = make_object("sensor", "perspective", file.place(camera));
  give(*sensor, "fov", std::clamp(angle * degrees_per_radian, 1e-4, 179.9));
  give(*sensor, "fov_axis", "y");
  return sensor;
}

std::shared_ptr<Object> orthographic(const File& file, const JsonValue& camera) {
  const JsonValue* lens = camera.find("orthographic");
  if (!lens || !(std::fabs(file.number(*lens, "xmag", 0)) > 0))
    file.fail(camera, "the camera's 'xmag' is 0", "give half of the picture's width");
  return make_object("sensor", "orthographic", file.place(camera));
}

double aspect_of(const File& file, const JsonValue& camera, bool is_orthographic) {
  const JsonValue* lens = camera.find(is_orthographic ? "orthographic" : "perspective");
  if (!is_orthographic) return file.number(*lens, "aspectRatio", 0);
  const double x = std::fabs(file.number(*lens, "xmag", 1));
  const double y = std::fabs(file.number(*lens, "ymag", 0));
  return y > 0 ? x / y : 0;
}

}  // namespace

Transform view_of(const File& file, const PlacedNode& placed) {
  const Vec3d origin = axis_of(placed.to_world, 3);
  try {
    return Transform::look_at(origin, origin - axis_of(placed.to_world, 2),
                              axis_of(placed.to_world, 1));
  } catch (const std::invalid_argument&) {
    file.fail(*placed.node, "the node's transform leaves it no direction", "give other factors");
  }
}

std::shared_ptr<Object> sensor_of(const File& file, const PlacedNode& placed,
                                  std::set<std::string>& ids) {
  const JsonValue* camera = file.referred(*placed.node, "camera", "cameras");
  if (!camera) return nullptr;
  const bool is_orthographic = file.text(*camera, "type", "perspective") == "orthographic";
  auto sensor = is_orthographic ? orthographic(file, *camera) : perspective(file, *camera);
  Transform to_world = view_of(file, placed);
  if (is_orthographic) {
    const double half = std::fabs(file.number(*camera->find("orthographic"), "xmag", 1));
    to_world = to_world * Transform::scale({half, half, 1});
  }
  give(*sensor, "to_world", to_world);
  const std::string own = file.text(*camera, "name", "camera");
  sensor->id = free_id(file.text(*placed.node, "name", own), ids);
  put(*sensor, "", film_of_aspect(aspect_of(file, *camera, is_orthographic), sensor->place));
  return sensor;
}

std::shared_ptr<Object> lamp_of(const File& file, const PlacedNode& placed, const Options& options,
                                Deviations& deviations) {
  const JsonValue* named = file.extension(*placed.node, "KHR_lights_punctual");
  const JsonValue* all = file.extension(file.root(), "KHR_lights_punctual");
  const auto index = named ? file.count(*named, "light") : std::nullopt;
  if (!index) return nullptr;
  const JsonValue* lights = all ? all->find("lights") : nullptr;
  if (!lights || *index >= lights->items().size())
    file.fail(*named, fmt::format("light {} is named, which the file has not", *index),
              "export the file again");
  const JsonValue& light = lights->items()[*index];
  const std::vector<double> color = file.numbers(light, "color", {1, 1, 1});
  const double watts = std::max(0.0, file.number(light, "intensity", 1)) / options.lamp_efficacy;
  const Rgb value = {std::max(0.0, color[0]) * watts, std::max(0.0, color[1]) * watts,
                     std::max(0.0, color[2]) * watts};
  const std::string type = file.text(light, "type", "");
  const std::string name = file.name_of("light", light, *index);
  const Place place = file.place(light);
  if (light.find("range"))
    deviations.ignored(name, "it shines beyond its 'range', as light does", place);
  if (type == "directional") {
    auto lamp = make_object("emitter", "directional", place);
    give(*lamp, "irradiance", value);
    give(*lamp, "direction", axis_of(placed.to_world, 2) * -1.0);
    return lamp;
  }
  if (type == "point") {
    auto lamp = make_object("emitter", "point", place);
    give(*lamp, "intensity", value);
    give(*lamp, "position", axis_of(placed.to_world, 3));
    return lamp;
  }
  if (type != "spot") {
    deviations.ignored(name, fmt::format("lamps of type '{}' are left out", type.substr(0, 80)),
                       place);
    return nullptr;
  }
  const JsonValue* given = light.find("spot");
  const JsonValue none(JsonValue::Members(), light.offset());
  const JsonValue& cone = given ? *given : none;
  const double outer =
      std::clamp(file.number(cone, "outerConeAngle", std::numbers::pi / 4), 0.0, std::numbers::pi);
  const double inner = std::clamp(file.number(cone, "innerConeAngle", 0), 0.0, outer);
  auto lamp = make_object("emitter", "spot", place);
  give(*lamp, "intensity", value);
  give(*lamp, "cutoff_angle", outer * degrees_per_radian);
  give(*lamp, "beam_width", inner * degrees_per_radian);
  give(*lamp, "falloff", "square");
  give(*lamp, "to_world", view_of(file, placed));
  return lamp;
}

}  // namespace kaustik::gltf
