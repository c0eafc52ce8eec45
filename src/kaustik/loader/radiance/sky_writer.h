#pragma once
// What gensky and gendaylit have in common.

#include "kaustik/loader/radiance/angles.h"

#include "kaustik/loader/radiance/generators.h"
#include "kaustik/loader/radiance/primitive_writer.h"
#include "kaustik/loader/radiance/sun_place.h"

namespace kaustik::radiance {

/// A disc at infinity; `degrees` is the whole angle across it.
inline void add_sun(PrimitiveWriter& writer, double radiance, const Vec3d& to_sun, double degrees) {
  writer.add("void", "light", "solar", {radiance, radiance, radiance});
  writer.add("solar", "source", "sun", {to_sun.x, to_sun.y, to_sun.z, degrees});
}

inline void tell_of_sun_place(const SunPlaceReader& reader, const std::string& program,
                              const GeneratorContext& context) {
  if (reader.has_year())
    context.deviations.approximated(
        program, "the year is left out: the sun stands where it does in a mean year",
        context.place);
}

/// Models of clear skies end where the sun stands in the zenith.
inline void lower_the_sun(SunPlace& place, const std::string& program,
                          const GeneratorContext& context) {
  constexpr double highest = 87 * degree;
  if (place.altitude <= highest) return;
  place.altitude = highest;
  context.deviations.approximated(
      program, "the sun stands so high that its altitude is lowered to 87 degrees, as in Radiance",
      context.place);
}

}  // namespace kaustik::radiance
