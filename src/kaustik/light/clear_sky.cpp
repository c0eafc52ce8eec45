#include "kaustik/light/clear_sky.h"

#include "kaustik/base/color.h"
#include "kaustik/base/photometric_units.h"

namespace kaustik {
namespace {

constexpr double sun_solid_angle = 6.7443e-5;  // sr, that the radiances below go with
constexpr double ozone_thickness = 0.35;       // cm
constexpr int step = 10;                       // nm, from 380 to 750

/// Radiance of the sun outside of the air, 100 W/(m²·nm·sr), every 10 nm from 380 nm (Preetham,
/// Shirley and Smits 1999, table 2).
constexpr std::array<double, 38> sun_radiance = {
    165.5, 162.3, 211.2, 258.8, 258.2, 242.3, 267.6, 296.6, 305.4, 300.6, 306.6, 288.3, 287.1,
    278.2, 271.0, 272.3, 263.6, 255.0, 250.6, 253.1, 253.5, 251.3, 246.3, 241.7, 236.8, 232.1,
    228.2, 223.4, 219.7, 215.3, 211.0, 207.3, 202.4, 198.7, 194.3, 190.7, 186.3, 182.6};

/// Absorption of ozone per cm of its thickness, every 10 nm from 380 nm (the same table).
constexpr std::array<double, 38> ozone_absorption = {
    0,     0,     0,     0,     0,     0,     0,     0.003, 0.006, 0.009, 0.014, 0.021, 0.030,
    0.040, 0.048, 0.063, 0.075, 0.085, 0.103, 0.120, 0.120, 0.115, 0.125, 0.120, 0.105, 0.090,
    0.079, 0.067, 0.057, 0.048, 0.036, 0.028, 0.023, 0.018, 0.014, 0.011, 0.010, 0.009};

/// Relative mass of the air on the way of a ray (Kasten and Young 1989, eq. 3 and table II).
double air_mass(double sun_height) {
  const double elevation = std::asin(std::min(sun_height, 1.0)) * 180 / std::numbers::pi;
  return 1 / (sun_height + 0.50572 * std::pow(elevation + 6.07995, -1.6364));
}

/// Parts of sunlight that pass what the air is made of.
struct Transmittance {
  double molecules, ozone, aerosols;
};
Transmittance transmittance(size_t i, double turbidity, double mass) {
  const double micrometers = 1e-3 * (380 + step * double(i));
  const double aerosol_amount = 0.04608365822050 * turbidity - 0.04586025928522;
  return {std::exp(-mass * 0.008735 * std::pow(micrometers, -4.08)),
          std::exp(-mass * ozone_absorption[i] * ozone_thickness),
          std::exp(-mass * aerosol_amount * std::pow(micrometers, -1.3))};
}

/// Light of the sky on the ground over light of the sun outside of the air, and the share that the
/// sky sends back (Bird and Hulstrom 1981, pp. 39 to 41), with transmittances for light rather than
/// for all radiation.
void scatter(const Transmittance& t, double mass, double& sky, double& albedo) {
  constexpr double aerosol_absorptance = 0.1, forward = 0.84;
  const double absorbed =
      aerosol_absorptance * (1 - mass + std::pow(mass, 1.06)) * (1 - t.aerosols);
  const double aerosols_without_scattering = 1 - absorbed;
  const double aerosol_scattering = t.aerosols / aerosols_without_scattering;
  sky = 0.79 * t.ozone * aerosols_without_scattering *
        (0.5 * (1 - t.molecules) + forward * (1 - aerosol_scattering)) /
        (1 - mass + std::pow(mass, 1.02));
  albedo = 0.0685 + (1 - forward) * (1 - aerosol_scattering);
}

double cubic(const std::array<double, 4>& c, double x) {
  return ((c[0] * x + c[1]) * x + c[2]) * x + c[3];
}

}  // namespace

Daylight daylight(double turbidity, double sun_height) {
  const double mass = air_mass(sun_height);
  Vec3d xyz(0, 0, 0);
  double outside = 0;
  Transmittance mean{0, 0, 0};
  for (size_t i = 0; i < sun_radiance.size(); ++i) {
    const Vec3d matching = cie_xyz_at(380 + step * double(i));
    const double irradiance = 100 * sun_radiance[i] * sun_solid_angle * step;  // W/m²
    const Transmittance t = transmittance(i, turbidity, mass);
    xyz += matching * (irradiance * t.molecules * t.ozone * t.aerosols);
    const double weight = irradiance * matching.y;
    outside += weight;
    mean.molecules += weight * t.molecules;
    mean.ozone += weight * t.ozone;
    mean.aerosols += weight * t.aerosols;
  }
  mean = {mean.molecules / outside, mean.ozone / outside, mean.aerosols / outside};

  Daylight result;
  const Rgb rgb = rgb_from_xyz(xyz * (lumens_per_watt_555 / lumens_per_watt_white));
  result.sun_rgb = Vec3d(rgb.r, rgb.g, rgb.b);
  double share = 0;
  scatter(mean, mass, share, result.sky_albedo);
  result.sky_illuminance = share * lumens_per_watt_555 * outside * sun_height;
  return result;
}

ClearSky::ClearSky(double turbidity, const Vec3d& to_sun) : to_sun_(to_sun) {
  const double t = turbidity;
  perez_[0] = {0.17872 * t - 1.46303, -0.35540 * t + 0.42749, -0.02266 * t + 5.32505,
               0.12064 * t - 2.57705, -0.06696 * t + 0.37027};
  perez_[1] = {-0.01925 * t - 0.25922, -0.06651 * t + 0.00081, -0.00041 * t + 0.21247,
               -0.06409 * t - 0.89887, -0.00325 * t + 0.04517};
  perez_[2] = {-0.01669 * t - 0.26078, -0.09495 * t + 0.00921, -0.00792 * t + 0.21023,
               -0.04405 * t - 1.65369, -0.01092 * t + 0.05291};
  const double s = std::acos(std::clamp(to_sun.z, 0.0, 1.0));
  const double x = t * t * cubic({0.00166, -0.00375, 0.00209, 0}, s) +
                   t * cubic({-0.02903, 0.06377, -0.03202, 0.00394}, s) +
                   cubic({0.11693, -0.21196, 0.06052, 0.25886}, s);
  const double y = t * t * cubic({0.00275, -0.00610, 0.00317, 0}, s) +
                   t * cubic({-0.04214, 0.08970, -0.04153, 0.00516}, s) +
                   cubic({0.15346, -0.26756, 0.06670, 0.26688}, s);
  zenith_ = {1 / value(perez_[0], 1, s), x / value(perez_[1], 1, s), y / value(perez_[2], 1, s)};
}

double ClearSky::value(const Perez& p, double cos_theta, double gamma) {
  const double cos_gamma = std::cos(gamma);
  return (1 + p[0] * std::exp(p[1] / cos_theta)) *
         (1 + p[2] * std::exp(p[3] * gamma) + p[4] * cos_gamma * cos_gamma);
}

Vec3d ClearSky::xyz(const Vec3d& direction) const {
  if (!(direction.z > 0)) return {0, 0, 0};
  const double gamma = std::acos(std::clamp(direction.dot(to_sun_), -1.0, 1.0));
  // On the horizon itself the function has a limit, which its terms reach well before.
  const double height = std::max(direction.z, 1e-3);
  const double luminance = zenith_[0] * value(perez_[0], height, gamma);
  const double x = zenith_[1] * value(perez_[1], height, gamma);
  const double y = zenith_[2] * value(perez_[2], height, gamma);
  return {luminance * x / y, luminance, luminance * (1 - x - y) / y};
}

}  // namespace kaustik
