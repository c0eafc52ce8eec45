// gendaylit: the model of Perez, Seals and Michalsky, "All-Weather Model for Sky Luminance
// Distribution", Solar Energy 50 (1993) and 51 (1993) 423; efficacies by Perez, Ineichen, Seals,
// Michalsky and Stewart, "Modeling Daylight Availability and Irradiance Components from Direct and
// Global Irradiance", Solar Energy 44 (1990).

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kaustik/base/photometric_units.h"
#include "kaustik/loader/radiance/angles.h"
#include "kaustik/loader/radiance/generators.h"
#include "kaustik/loader/radiance/primitive_writer.h"
#include "kaustik/loader/radiance/sky_models.h"
#include "kaustik/loader/radiance/sky_writer.h"
#include "kaustik/loader/radiance/sun_place.h"

namespace kaustik::radiance {
namespace {

constexpr const char* daylight_usage =
    "gendaylit month day hour -W direct_normal diffuse_horizontal (W/m²), or -G, -L, -P for "
    "others, [-O 0|1|2] [-g reflectance] [-s] [-a latitude] [-o longitude] [-m meridian]";

/// W/m² and klux outside of the air.
constexpr double solar_constant = 1367, solar_klux = 127.5;
constexpr double sun_half_angle = 0.2665 * degree;
/// Of the water in the air, cm: gendaylit's default.
constexpr double water = 2;

/// Categories of clearness begin at these.
constexpr std::array<double, 8> clearness_bins = {1, 1.065, 1.23, 1.5, 1.95, 2.8, 4.5, 6.2};

/// Per category: a1 … a4, b1 …, c1 …, d1 …, e1 … e4.
constexpr double perez_table[8][20] = {
    {1.3525, -0.2576, -0.2690, -1.4366, -0.7670, 0.0007, 1.2734, -0.1233, 2.8000,  0.6004,
     1.2375, 1.0000,  1.8734,  0.6297,  0.9738,  0.2809, 0.0356, -0.1246, -0.5718, 0.9938},
    {-1.2219, -0.7730, 1.4148,  1.1016,  -0.2054, 0.0367, -3.9128, 0.9156, 6.9750,  0.1774,
     6.4477,  -0.1239, -1.5798, -0.5081, -1.7812, 0.1080, 0.2624,  0.0672, -0.2190, -0.4285},
    {-1.1000,  -0.2515, 0.8952,  0.0156, 0.2782, -0.1812, -4.5000, 1.1766, 24.7219, -13.0812,
     -37.7000, 34.8438, -5.0000, 1.5218, 3.9229, -2.6204, -0.0156, 0.1597, 0.4199,  -0.5562},
    {-0.5484,  -0.6654, -0.2672, 0.7117, 0.7234, -0.6219, -5.6812, 2.6297,  33.3389, -18.3000,
     -62.2500, 52.0781, -3.5000, 0.0016, 1.1477, 0.1062,  0.4659,  -0.3296, -0.0876, -0.0329},
    {-0.6000,  -0.3566, -2.5000, 2.3250,  0.2937, 0.0496, -5.6812, 1.8415, 21.0000, -4.7656,
     -21.5906, 7.2492,  -3.5000, -0.1554, 1.4062, 0.3988, 0.0032,  0.0766, -0.0656, -0.1294},
    {-1.0156, -0.3670, 1.0078,  1.4051,  0.2875,  -0.5328, -3.8500, 3.3750, 14.0000, -0.9999,
     -7.1406, 7.5469,  -3.4000, -0.1078, -1.0750, 1.5702,  -0.0672, 0.4016, 0.3017,  -0.4844},
    {-1.0000, 0.0211,  0.5025,  -0.5119, -0.3000, 0.1922, 0.7023, -1.6317, 19.0000, -5.0000,
     1.2438,  -1.9094, -4.0000, 0.0250,  0.3844,  0.2656, 1.0468, -0.3788, -2.4517, 1.4656},
    {-1.0500,  0.0289,  0.4260,  0.3590, -0.3250, 0.1156, 0.7781, 0.0025,  31.0625, -14.5000,
     -46.1148, 55.3750, -7.2312, 0.4050, 13.3500, 0.6234, 1.5000, -0.6426, 1.8564,  0.5636}};

/// Of diffuse light and of the sun's: a, b, c, d per category.
constexpr double diffuse_efficacies[8][4] = {
    {97.24, -0.46, 12.00, -8.91},   {107.22, 1.15, 0.59, -3.95},    {104.97, 2.96, -5.53, -8.77},
    {102.39, 5.59, -13.95, -13.90}, {100.71, 5.94, -22.75, -23.74}, {106.42, 3.83, -36.15, -28.83},
    {141.88, 1.90, -53.24, -14.03}, {152.23, 0.35, -45.27, -7.98}};
constexpr double direct_efficacies[8][4] = {
    {57.20, -4.55, -2.98, 117.12}, {98.99, -3.46, -1.21, 12.38},  {109.83, -4.90, -1.71, -8.81},
    {110.34, -5.84, -1.99, -4.56}, {106.36, -3.97, -1.75, -6.16}, {107.19, -1.25, -1.51, -26.73},
    {105.75, 0.77, -1.26, -34.44}, {101.18, 1.58, -1.10, -8.29}};

size_t category_of(double clearness) {
  size_t bin = 0;
  while (bin + 1 < clearness_bins.size() && clearness >= clearness_bins[bin + 1]) ++bin;
  return bin;
}

/// Of a day and a place of the sun: what relates light and the parameters of the model.
class PerezDay {
 public:
  explicit PerezDay(const SunPlace& place) : zenith_angle_(std::numbers::pi / 2 - place.altitude) {
    const double turn = 2 * std::numbers::pi * (place.day - 1) / 365;
    const double eccentricity = 1.00011 + 0.034221 * std::cos(turn) + 0.00128 * std::sin(turn) +
                                0.000719 * std::cos(2 * turn) + 0.000077 * std::sin(2 * turn);
    const double angle = std::min(zenith_angle_ / degree, 90.0);
    const double air_mass =
        1 / (std::cos(angle * degree) + 0.15 * std::pow(93.885 - angle, -1.253));
    outside_over_mass_ = solar_constant * eccentricity / air_mass;
    cubed_ = 1.041 * std::pow(zenith_angle_, 3);
  }

  double zenith_angle() const { return zenith_angle_; }
  double brightness(double diffuse) const { return diffuse / outside_over_mass_; }
  double clearness(double direct, double diffuse) const {
    return ((diffuse + direct) / diffuse + cubed_) / (1 + cubed_);
  }
  double diffuse(double brightness) const { return brightness * outside_over_mass_; }
  double direct(double clearness, double diffuse) const {
    return diffuse * (clearness - 1) * (1 + cubed_);
  }
  double diffuse_efficacy(double clearness, double brightness) const {
    const double* e = diffuse_efficacies[category_of(clearness)];
    return e[0] + e[1] * water + e[2] * std::cos(zenith_angle_) + e[3] * std::log(brightness);
  }
  double direct_efficacy(double clearness, double brightness) const {
    const double* e = direct_efficacies[category_of(clearness)];
    return std::max(
        0.0, e[0] + e[1] * water + e[2] * std::exp(5.73 * zenith_angle_ - 5) + e[3] * brightness);
  }
  std::array<double, 5> coefficients(double clearness, double brightness) const;

 private:
  double zenith_angle_, outside_over_mass_ = 0, cubed_ = 0;
};

std::array<double, 5> PerezDay::coefficients(double clearness, double brightness) const {
  const double z = zenith_angle_;
  const size_t bin = category_of(clearness);
  const double* x = perez_table[bin];
  if (clearness > 1.065 && clearness < 2.8) brightness = std::max(brightness, 0.2);
  std::array<double, 5> c{};
  for (size_t i = 0; i < 5; ++i)
    c[i] = x[4 * i] + x[4 * i + 1] * z + brightness * (x[4 * i + 2] + x[4 * i + 3] * z);
  if (bin == 0) {
    c[2] = std::exp(std::pow(brightness * (x[8] + x[9] * z), x[10])) - x[11];
    c[3] = -std::exp(brightness * (x[12] + x[13] * z)) + x[14] + brightness * x[15];
  }
  return c;
}

/// The sun's light on a surface that faces it, and the sky's on the ground: W/m², then lux.
struct MeasuredLight {
  double direct = 0, diffuse = 0;
  double direct_lux = 0, diffuse_lux = 0;
  double clearness = 1, brightness = 0.2;
};

/// Bounds of what the model was made from.
constexpr double most_clearness = 12.0, least_brightness = 0.01, most_brightness = 0.6;

void find_parameters(const PerezDay& day, MeasuredLight& light) {
  light.brightness = std::clamp(day.brightness(light.diffuse), least_brightness, most_brightness);
  light.clearness = std::clamp(day.clearness(light.direct, light.diffuse), 1.0, most_clearness);
}

/// From illuminances, by steps that the efficacies take.
void find_from_lux(const PerezDay& day, MeasuredLight& light) {
  light.diffuse = light.diffuse_lux * solar_constant / (1000 * solar_klux);
  light.direct = light.direct_lux * solar_constant / (1000 * solar_klux);
  for (int step = 0; step < 5; ++step) {
    find_parameters(day, light);
    light.diffuse =
        light.diffuse_lux / std::max(day.diffuse_efficacy(light.clearness, light.brightness), 1.0);
    const double efficacy = day.direct_efficacy(light.clearness, light.brightness);
    light.direct = efficacy > 0 ? light.direct_lux / efficacy : 0;
  }
  find_parameters(day, light);
}

struct DaylightOptions {
  std::string input;  ///< "-W", "-G", "-L", "-P"
  double first = 0, second = 0;
  int output = 0;  ///< 0: visible W, 1: all W, 2: lm
  double reflectance = 0.2;
  bool has_sun = true;
};

DaylightOptions read_options(CommandArguments& arguments, SunPlaceReader& reader) {
  DaylightOptions options;
  while (!arguments.at_end()) {
    const std::string option = arguments.text();
    if (reader.take_option(option)) continue;
    if (option == "-W" || option == "-G" || option == "-L" || option == "-P") {
      options.input = option;
      options.first = arguments.number();
      options.second = arguments.number();
    } else if (option == "-O") {
      options.output = int(std::clamp(arguments.number(), 0.0, 2.0));
    } else if (option == "-g") {
      options.reflectance = arguments.number();
    } else if (option == "-s" || option == "+s") {
      options.has_sun = option == "+s";
    } else if (option == "-i") {
      arguments.number();  // minutes that are averaged; counts at sunrise and sunset alone
    } else if (option != "-w") {
      arguments.refuse(fmt::format("'gendaylit' has no option '{}' here", option.substr(0, 40)));
    }
  }
  if (options.input.empty()) arguments.refuse("'gendaylit' is given no light");
  return options;
}

MeasuredLight light_of(const DaylightOptions& options, const PerezDay& day, double sine,
                       const CommandArguments& arguments) {
  MeasuredLight light;
  if (options.input == "-P") {
    light.clearness = std::clamp(options.first, 1.0, most_clearness);
    light.brightness = std::clamp(options.second, least_brightness, most_brightness);
    light.diffuse = day.diffuse(light.brightness);
    light.direct = day.direct(light.clearness, light.diffuse);
  } else if (options.input == "-L") {
    light.direct_lux = options.first;
    light.diffuse_lux = options.second;
  } else {
    light.direct = options.input == "-G" ? options.first / sine : options.first;
    light.diffuse = options.second;
  }
  const bool by_lux = options.input == "-L";
  if (!((by_lux ? light.diffuse_lux : light.diffuse) > 0) ||
      !((by_lux ? light.direct_lux : light.direct) >= 0))
    arguments.refuse("the light of 'gendaylit' is below zero, or no light of the sky");
  if (by_lux) {
    find_from_lux(day, light);
    return light;
  }
  if (options.input != "-P") find_parameters(day, light);
  light.diffuse_lux = light.diffuse * day.diffuse_efficacy(light.clearness, light.brightness);
  light.direct_lux = light.direct * day.direct_efficacy(light.clearness, light.brightness);
  return light;
}

/// ∫ L cosθ over the upper hemisphere of the relative distribution, by the midpoint rule.
double horizontal_integral(const std::array<double, 5>& c, const Vec3d& to_sun) {
  constexpr int rings = 200, sectors = 200;
  double sum = 0;
  for (int ring = 0; ring < rings; ++ring) {
    const double z = std::sqrt((ring + 0.5) / rings), s = std::sqrt(1 - z * z);  // even in z²
    for (int sector = 0; sector < sectors; ++sector) {
      const double phi = 2 * std::numbers::pi * (sector + 0.5) / sectors;
      const double cosine =
          std::clamp(Vec3d(s * std::cos(phi), s * std::sin(phi), z).dot(to_sun), -1.0, 1.0);
      sum += (1 + c[0] * std::exp(c[1] / std::max(z, 0.01))) *
             (1 + c[2] * std::exp(c[3] * std::acos(cosine)) + c[4] * cosine * cosine);
    }
  }
  return sum * std::numbers::pi / (rings * sectors);
}

}  // namespace

std::string generate_perez_sky(const Words& words, const GeneratorContext& context) {
  CommandArguments arguments(words, daylight_usage, context.place);
  SunPlaceReader reader(arguments);
  const DaylightOptions options = read_options(arguments, reader);
  SunPlace place = reader.place();
  tell_of_sun_place(reader, "gendaylit", context);
  lower_the_sun(place, "gendaylit", context);
  const Vec3d to_sun = place.direction();
  if (!(to_sun.z > 0)) arguments.refuse("the sun of 'gendaylit' stands below the horizon");
  const PerezDay day(place);
  const MeasuredLight light = light_of(options, day, to_sun.z, arguments);
  const double diffuse = options.output == 0   ? light.diffuse_lux / lumens_per_watt_white
                         : options.output == 1 ? light.diffuse
                                               : light.diffuse_lux;
  const double direct = options.output == 0   ? light.direct_lux / lumens_per_watt_white
                        : options.output == 1 ? light.direct
                                              : light.direct_lux;
  const auto c = day.coefficients(light.clearness, light.brightness);
  const double factor = std::max(0.0, diffuse / horizontal_integral(c, to_sun));
  const bool shines = options.has_sun && light.clearness > 1 && direct > 0;
  const double ground =
      options.reflectance / std::numbers::pi * (diffuse + (shines ? direct * to_sun.z : 0));
  PrimitiveWriter writer(context.place);
  if (shines)
    add_sun(writer, direct / (2 * std::numbers::pi * (1 - std::cos(sun_half_angle))), to_sun,
            2 * sun_half_angle / degree);
  writer.line("void brightfunc skyfunc\n2 skybright perezlum.cal\n0");
  writer.line(fmt::format("10 {} {} {} {} {} {} {} {} {} {}", factor, ground, c[0], c[1], c[2],
                          c[3], c[4], to_sun.x, to_sun.y, to_sun.z));
  return writer.take();
}

}  // namespace kaustik::radiance
