// Lamps whose patterns depend on the direction, as those of ies2rad: measured intensities.

#include "kaustik/loader/radiance/luminaires.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kaustik/base/photometric_units.h"
#include "kaustik/loader/radiance/cal_program.h"
#include "kaustik/loader/radiance/placement.h"
#include "kaustik/loader/radiance/surface_parts.h"

namespace kaustik::radiance {
namespace {

/// Files have 2.5° or 5° between their angles.
constexpr int gamma_count = 73, plane_count = 72;
constexpr double row_degrees = 2.5, column_degrees = 5;

/// Intensities over turn and angle, row by row.
struct Intensities {
  std::vector<double> values;
  int good = 0;  ///< where the pattern has a value
};

Vec3d photometric_direction(int row, int column) {
  const double gamma = row * row_degrees * std::numbers::pi / 180;
  const double c = column * column_degrees * std::numbers::pi / 180;
  return {-std::sin(gamma) * std::cos(c), std::sin(gamma) * std::sin(c), std::cos(gamma)};
}

/// Of a surface of radiance 1, W/sr.
Intensities intensities_of(const DirectedLight& light, const LampSurface& surface,
                           const Transform& to_world) {
  Intensities found;
  for (int row = 0; row < gamma_count; ++row)
    for (int column = 0; column < plane_count; ++column) {
      const Vec3d direction =
          Vec3d(to_world.vector(Vec3f(photometric_direction(row, column)))).normalized();
      const double seen =
          surface.area * (surface.normal ? std::max(0.0, surface.normal->dot(direction)) : 1.0);
      double value = 0;
      if (seen > 0) try {
          const PatternPoint point{surface.middle, surface.normal.value_or(direction), -direction};
          value = seen;
          for (const auto& [pattern, modifier] : light.patterns) {
            const Rgb factor = pattern->at(point);
            value *= std::max(0.0, (factor.r + factor.g + factor.b) / 3);
          }
          ++found.good;
        } catch (const CalError&) {
          value = 0;
        }
      found.values.push_back(std::isfinite(value) ? value : 0);
    }
  return found;
}

/// Whether all columns are alike.
bool is_rotational(const Intensities& found, double largest) {
  for (int row = 0; row < gamma_count; ++row)
    for (int column = 1; column < plane_count; ++column)
      if (std::fabs(found.values[size_t(row * plane_count + column)] -
                    found.values[size_t(row * plane_count)]) > 1e-5 * largest)
        return false;
  return true;
}

/// As a file of a luminaire, in cd.
std::string profile_of(const Intensities& found, double largest) {
  const int planes = is_rotational(found, largest) ? 1 : plane_count;
  std::string text = fmt::format("IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 {} {} 1 2 0 0 0\n1 1 0\n",
                                 gamma_count, planes);
  for (int row = 0; row < gamma_count; ++row) text += fmt::format("{} ", row * row_degrees);
  text += '\n';
  for (int plane = 0; plane < planes; ++plane) text += fmt::format("{} ", plane * column_degrees);
  for (int plane = 0; plane < planes; ++plane) {
    text += '\n';
    for (int row = 0; row < gamma_count; ++row)
      text += fmt::format("{:.5g} ",
                          lumens_per_watt_white * found.values[size_t(row * plane_count + plane)]);
  }
  return text + '\n';
}

}  // namespace

std::optional<ObjectPointer> luminaire_of(const DirectedLight& light, const LampSurface& surface,
                                          const Place& place) {
  // The axes of the file of functions: those of ies2rad have the photometric zero at −z, C 0 at +x.
  const Transform& placed = light.patterns.front().second->placed;
  const Vec3d down = -placed_vector(placed, Vec3d(0, 0, 1)).normalized();
  const Vec3d up = placed_vector(placed, Vec3d(0, 1, 0)).normalized();
  // Not within the surface.
  const Vec3d origin = surface.normal
                           ? surface.middle + *surface.normal * (1e-3 * std::sqrt(surface.area))
                           : surface.middle;
  const Transform to_world = Transform::look_at(origin, origin + down, up);
  const Intensities found = intensities_of(light, surface, to_world);
  if (found.good == 0) return std::nullopt;
  const double largest = *std::ranges::max_element(found.values);
  if (!(largest > 0)) return ObjectPointer();
  const ObjectPointer emitter = make_object("emitter", "goniometric", place);
  give(*emitter, "profile", profile_of(found, largest));
  give(*emitter, "intensity", light.radiance);
  give(*emitter, "to_world", to_world);
  return emitter;
}

}  // namespace kaustik::radiance
