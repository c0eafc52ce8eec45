#include "kaustik/loader/radiance/environment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kaustik/base/array.h"
#include "kaustik/base/error.h"
#include "kaustik/loader/radiance/angles.h"
#include "kaustik/loader/radiance/cal_program.h"
#include "kaustik/loader/radiance/placement.h"
#include "kaustik/loader/radiance/surface_parts.h"

namespace kaustik::radiance {
namespace {

/// Sources up to this size are suns; larger ones are drawn into the picture.
constexpr double largest_sun_degrees = 6;
/// Of the picture. Rows are nodes from the zenith to the nadir, the middle one the horizon.
constexpr size_t columns = 512, rows = 257;

/// World from the space of pictures, whose upper edge is +y.
Transform world_from_picture() { return Transform::rotate({1, 0, 0}, 90); }

Vec3d direction_at(double turn, double from_zenith) {
  const double phi = 2 * std::numbers::pi * turn, sine = std::sin(from_zenith);
  return {sine * std::sin(phi), sine * std::cos(phi), std::cos(from_zenith)};
}

}  // namespace

void EnvironmentMaker::add(const Primitive& primitive, const Transform& placed,
                           const Modifier* modifier) {
  if (primitive.reals.size() != 4)
    throw Error(ErrorKind::input,
                fmt::format("{} has {} numbers where 4 are needed", name_of(primitive),
                            primitive.reals.size()),
                "give a direction and the angle across it in degrees", primitive.place);
  const auto ignored = [&](const std::string& why) {
    deviations_.ignored(name_of(primitive), why, primitive.place);
  };
  const auto& reals = primitive.reals;
  const Vec3d direction = placed_vector(placed, {reals[0], reals[1], reals[2]});
  const double degrees = std::clamp(reals[3], 0.0, 360.0);
  const Look look = look_of(modifier);
  const auto radiance = look.material ? MaterialMaker::radiance_of(*look.material) : std::nullopt;
  if (!radiance) return ignored("its modifier is no light, and it is left out");
  if (!(direction.length() > 0) || !is_usable(direction) || degrees <= 0)
    return ignored("it has no direction or no size");
  if (largest_of(*radiance) <= 0) return;
  if (const std::string remark = luminance_remark(*radiance); !remark.empty())
    deviations_.approximated(name_of(primitive), remark, primitive.place);
  Source source{
      direction.normalized(), std::cos(degrees / 2 * degree), *radiance, {}, primitive.place};
  if (degrees >= 360) source.cos_half_angle = -2;
  for (const Modifier* modifier_of_light : look.patterns) {
    if (is_picture(*modifier_of_light)) {
      deviations_.ignored(name_of(*modifier_of_light->primitive),
                          "pictures around the scene are left out: the light counts without it",
                          modifier_of_light->place());
    } else if (const auto pattern = patterns_.pattern(*modifier_of_light)) {
      source.patterns.push_back(pattern);
    }
  }
  if (degrees <= largest_sun_degrees)
    suns_.emplace_back(std::move(source), degrees);
  else
    wide_.push_back(std::move(source));
}

/// The first one that covers it, as in Radiance.
std::optional<Rgb> EnvironmentMaker::radiance_at(const Vec3d& direction) const {
  for (const Source& source : wide_) {
    if (direction.dot(source.direction) < source.cos_half_angle - 1e-9) continue;
    Rgb radiance = source.radiance;
    PatternPoint point;
    point.position = direction;
    point.direction = direction;
    point.normal = -direction;
    try {
      for (const auto& pattern : source.patterns) radiance = product(radiance, pattern->at(point));
    } catch (const CalError&) {
      return Rgb{0, 0, 0};
    }
    return clamped(radiance, 1e30);
  }
  return std::nullopt;
}

bool EnvironmentMaker::is_even() const {
  return wide_.size() == 1 && wide_[0].cos_half_angle < -1 && wide_[0].patterns.empty();
}

/// A disc of even light; its irradiance is that of all of it.
void EnvironmentMaker::add_sun(Object& scene, const Source& source, double degrees) {
  Rgb radiance = source.radiance;
  PatternPoint point;
  point.direction = source.direction;
  point.normal = -source.direction;
  try {
    for (const auto& pattern : source.patterns) radiance = product(radiance, pattern->at(point));
  } catch (const CalError&) {
    return;
  }
  const double projected = std::numbers::pi * std::pow(std::sin(degrees / 2 * degree), 2);
  const ObjectPointer sun = make_object("emitter", "sun", source.place);
  give(*sun, "irradiance", times(clamped(radiance, 1e30), projected));
  give(*sun, "sun_direction", source.direction);
  give(*sun, "sun_aperture", std::max(degrees, 1e-3));
  // Its horizon lies across the direction, so that none of it is cut off.
  const Vec3d z = source.direction;
  const Vec3d other = std::fabs(z.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  const Vec3d x = other.cross(z).normalized(), y = z.cross(x);
  const double matrix[4][4] = {
      {x.x, y.x, z.x, 0}, {x.y, y.y, z.y, 0}, {x.z, y.z, z.z, 0}, {0, 0, 0, 1}};
  give(*sun, "to_world", Transform(matrix));
  nest(scene, sun);
}

void EnvironmentMaker::finish(Object& scene) {
  for (const auto& [source, degrees] : suns_) add_sun(scene, source, degrees);
  if (wide_.empty()) return;
  const Place& place = wide_[0].place;
  if (is_even()) {
    const ObjectPointer light = make_object("emitter", "constant", place);
    give(*light, "radiance", wide_[0].radiance);
    nest(scene, light);
    return;
  }
  std::vector<float> values;
  values.reserve(3 * columns * rows);
  for (size_t row = 0; row < rows; ++row)
    for (size_t column = 0; column < columns; ++column) {
      const double turn = (double(column) + 0.5) / columns;
      const double step = std::numbers::pi / (rows - 1), middle = step * double(row);
      // Edges between sources fall between rows: each is the mean of both of its halves.
      Rgb sum;
      for (const double shift : {-0.25, 0.25}) {
        const double angle = std::clamp(middle + shift * step, 0.0, std::numbers::pi);
        const Rgb half = radiance_at(direction_at(turn, angle)).value_or(Rgb{0, 0, 0});
        sum = {sum.r + half.r / 2, sum.g + half.g / 2, sum.b + half.b / 2};
      }
      for (const double value : {sum.r, sum.g, sum.b})
        values.push_back(float(std::min(value, 1e30)));
    }
  const ObjectPointer light = make_object("emitter", "envmap", place);
  give(*light, "data", Array::of<float>({rows, columns, 3}, std::move(values)));
  give(*light, "to_world", world_from_picture());
  nest(scene, light);
}

}  // namespace kaustik::radiance
