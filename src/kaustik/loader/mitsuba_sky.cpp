#include "kaustik/loader/mitsuba_sky.h"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kaustik/loader/object_parts.h"

namespace kaustik::mitsuba {
namespace {

/// Since Mitsuba 2.0.
constexpr Version first_with_daylight = {3, 7, 0};

/// Angle across the sun's disk, degrees, that 0.6 scales.
constexpr double sun_aperture_degrees = 0.5358;

/// A number that the object gives no more; null where it gives none.
std::optional<double> without_number(Object& object, std::string_view name) {
  const std::optional<double> number = number_in(object, name);
  if (number) remove_property(object, name);
  return number;
}

bool is_daylight(const Object& object) {
  return object.family == "emitter" &&
         (object.type == "sun" || object.type == "sky" || object.type == "sunsky");
}

/// The space of a sky of 0.6 from that of one of today, whose +z is the zenith, +x south and +y
/// west. It mirrors: seen from above, today's south, west and north follow one another the wrong
/// way round, as in Mitsuba 3.
Transform old_from_new() {
  const double rows[4][4] = {{0, -1, 0, 0}, {0, 0, 1, 0}, {1, 0, 0, 0}, {0, 0, 0, 1}};
  return Transform(rows);
}

}  // namespace

bool lacks_units(const Object& object) {
  const auto is_units = [](const Property& property) { return property.name == "units"; };
  return is_daylight(object) &&
         std::none_of(object.properties.begin(), object.properties.end(), is_units);
}

bool means_units_of_mitsuba(Version version) {
  return version < first_with_snake_case || version >= first_with_daylight;
}

void upgrade_sky(Object& object, Version version) {
  if (lacks_units(object) && means_units_of_mitsuba(version))
    object.properties.push_back({"units", std::string("mitsuba"), object.place});
  const bool is_sun = object.type == "sun", is_sky = object.type == "sky";
  if (version >= first_with_snake_case || !is_daylight(object)) return;
  if (const auto scale = without_number(object, "scale")) {
    if (!is_sky) multiply_number(object, "sun_scale", *scale);
    if (!is_sun) multiply_number(object, "sky_scale", *scale);
  }
  const auto wider = without_number(object, "sun_radius_scale");
  if (wider && !is_sky)
    object.properties.push_back({"sun_aperture", *wider * sun_aperture_degrees, object.place});
  Property* to_world = find_property(object, "to_world");
  if (!to_world)
    object.properties.push_back({"to_world", old_from_new(), object.place});
  else if (const auto* placed = std::get_if<Transform>(&to_world->value))
    to_world->value = *placed * old_from_new();
}

std::shared_ptr<Object> emitter_of_dark_scenes(Version version, const Place& place) {
  if (version >= first_with_snake_case) return nullptr;
  const auto emitter = std::make_shared<Object>();
  emitter->family = "emitter";
  emitter->place = place;
  if (version < Version{0, 4, 0}) {
    emitter->type = "constant";
    emitter->properties = {{"radiance", 0.8, place}};
    return emitter;
  }
  // A sun that is larger than the real one, so that it is found sooner.
  emitter->type = "sunsky";
  emitter->properties = {{"scale", 2.0, place},
                         {"sun_radius_scale", 15.0, place},
                         {"to_world", Transform::rotate({0, 1, 0}, -120), place}};
  upgrade_sky(*emitter, version);
  return emitter;
}

}  // namespace kaustik::mitsuba
