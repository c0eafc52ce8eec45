// gensky.

#include <cmath>
#include <numbers>

#include "kaustik/loader/radiance/generators.h"
#include "kaustik/loader/radiance/primitive_writer.h"
#include "kaustik/loader/radiance/sky_writer.h"
#include "kaustik/loader/radiance/sun_place.h"

namespace kaustik::radiance {
namespace {

constexpr const char* cie_sky_usage =
    "gensky month day hour [-s|+s|-c|-u|-i|+i] [-g reflectance] [-b|-B zenith] [-r|-R sun] "
    "[-t turbidity] [-a latitude] [-o longitude] [-m meridian], or -ang altitude azimuth …";

/// lm/W by which gensky turns luminances into radiances, of the sky and of the sun.
constexpr double sky_efficacy = 203, sun_efficacy = 208;
/// Solid angle of the sun's disc of half a degree, sr.
constexpr double sun_solid_angle = 5.98e-5;

enum class SkyType { clear = 1, overcast = 2, uniform = 3, intermediate = 4 };

/// Either is given, or by its irradiance, or neither.
struct GivenLight {
  bool is_given = false, is_irradiance = false;
  double value = 0;
};

struct CieSky {
  SkyType type = SkyType::clear;
  bool has_sun = true;
  double reflectance = 0.2, turbidity = 2.45;
  GivenLight zenith, sun;

  bool is_cloudy() const { return type == SkyType::overcast || type == SkyType::uniform; }
  double zenith_value(double altitude) const;
  /// Horizontal irradiance of the sky over π times its radiance at the zenith.
  double irradiance_factor(double altitude) const;
  double zenith_radiance(double altitude) const;
  double sun_radiance(double altitude) const;
};

/// What the relative distribution is at the zenith.
double CieSky::zenith_value(double altitude) const {
  const double from_zenith = std::numbers::pi / 2 - altitude, z = std::sin(altitude);
  if (type == SkyType::clear)
    return 0.274 * (0.91 + 10 * std::exp(-3 * from_zenith) + 0.45 * z * z);
  return (2.739 + 0.9891 * std::sin(0.3119 + 2.6 * altitude)) *
         std::exp(-from_zenith * (0.4441 + 1.48 * altitude));
}

/// Of the relative distribution by polynomials, as in gensky.
double CieSky::irradiance_factor(double altitude) const {
  if (type == SkyType::uniform) return 1;
  if (type == SkyType::overcast) return 7.0 / 9;
  constexpr double clear[5] = {2.766521, 0.547665, -0.369832, 0.009237, 0.059229};
  constexpr double intermediate[5] = {3.5556, -2.7152, -1.3081, 1.0660, 0.60227};
  const double* c = type == SkyType::clear ? clear : intermediate;
  const double x = altitude / (std::numbers::pi / 4) - 1;
  const double sum = c[0] + x * (c[1] + x * (c[2] + x * (c[3] + x * c[4])));
  return sum / zenith_value(altitude) / std::numbers::pi;
}

double CieSky::zenith_radiance(double altitude) const {
  if (zenith.is_given)
    return zenith.is_irradiance ? zenith.value / (irradiance_factor(altitude) * std::numbers::pi)
                                : zenith.value;
  const double cloudy = 8.6 * std::sin(altitude) + 0.123;
  const double clear = (1.376 * turbidity - 1.81) * std::tan(altitude) + 0.38;
  const double kilo = is_cloudy()                     ? cloudy
                      : type == SkyType::intermediate ? (clear + cloudy) / 2
                                                      : clear;
  return std::max(0.0, kilo * 1000 / sky_efficacy);
}

double CieSky::sun_radiance(double altitude) const {
  const double z = std::sin(altitude);
  if (sun.is_given) return sun.is_irradiance ? sun.value / (sun_solid_angle * z) : sun.value;
  const double clear = 1.5e9 / sun_efficacy * (1.147 - 0.147 / std::max(z, 0.16));
  return type == SkyType::intermediate ? 0.15 * clear : clear;
}

/// True if it was an option of the sky itself.
bool take_sky_option(const std::string& option, CommandArguments& arguments, CieSky& sky) {
  const char letter = option.size() == 2 ? option[1] : '\0';
  const auto given = [&](char irradiance) {
    return GivenLight{true, letter == irradiance, arguments.number()};
  };
  switch (letter) {
    case 's':
    case 'i':
      sky.type = letter == 's' ? SkyType::clear : SkyType::intermediate;
      sky.has_sun = option[0] == '+';
      return true;
    case 'c':
    case 'u':
      sky.type = letter == 'c' ? SkyType::overcast : SkyType::uniform;
      return true;
    case 'g':
      sky.reflectance = arguments.number();
      return true;
    case 't':
      sky.turbidity = arguments.number();
      return true;
    case 'b':
    case 'B':
      sky.zenith = given('B');
      return true;
    case 'r':
    case 'R':
      sky.sun = given('R');
      return true;
    default:
      return false;
  }
}

}  // namespace

std::string generate_cie_sky(const Words& words, const GeneratorContext& context) {
  CommandArguments arguments(words, cie_sky_usage, context.place);
  SunPlaceReader reader(arguments);
  CieSky sky;
  while (!arguments.at_end()) {
    const std::string option = arguments.text();
    if (!reader.take_option(option) && !take_sky_option(option, arguments, sky))
      arguments.refuse(fmt::format("'gensky' has no option '{}'", option.substr(0, 40)));
  }
  SunPlace place = reader.place();
  tell_of_sun_place(reader, "gensky", context);
  if (!sky.is_cloudy()) lower_the_sun(place, "gensky", context);
  const Vec3d to_sun = place.direction();
  const double zenith = sky.zenith_radiance(place.altitude);
  double ground = zenith * sky.irradiance_factor(place.altitude);
  PrimitiveWriter writer(context.place);
  const bool may_shine =
      !sky.is_cloudy() && to_sun.z > 0 && !(sky.sun.is_given && sky.sun.value <= 0);
  if (may_shine) {
    const double sun = sky.sun_radiance(place.altitude);
    ground += 6e-5 / std::numbers::pi * sun * to_sun.z;
    if (sky.has_sun) add_sun(writer, sun, to_sun, 0.5);
  }
  ground *= sky.reflectance;
  writer.line("void brightfunc skyfunc\n2 skybr skybright.cal\n0");
  if (sky.is_cloudy())
    writer.line(fmt::format("3 {} {} {}", int(sky.type), zenith, ground));
  else
    writer.line(fmt::format("7 {} {} {} {} {} {} {}", int(sky.type), zenith, ground,
                            sky.zenith_value(place.altitude), to_sun.x, to_sun.y, to_sun.z));
  return writer.take();
}

}  // namespace kaustik::radiance
