#include "kaustik/loader/radiance/sky_models.h"

#include <algorithm>
#include <cmath>

namespace kaustik::radiance {

std::optional<SkyModel> SkyModel::of(std::string_view function, std::string_view file,
                                     std::span<const double> a) {
  SkyModel sky;
  const size_t slash = file.rfind('/');
  if (slash != std::string_view::npos) file.remove_prefix(slash + 1);
  if (file == "skybright.cal" && (function == "skybr" || function == "skybright")) {
    if (a.size() < 3) return std::nullopt;
    const bool is_old = function == "skybright";  // its first argument says whether it is cloudy
    const double type = std::floor(a[0] + 0.5);
    sky.type_ = is_old      ? (a[0] > 0 ? Type::overcast : Type::clear)
                : type == 1 ? Type::clear
                : type == 2 ? Type::overcast
                : type == 4 ? Type::intermediate
                            : Type::uniform;
    sky.zenith_ = a[1];
    sky.ground_ = a[2];
    if (sky.type_ == Type::overcast || sky.type_ == Type::uniform) return sky;
    if (a.size() < 7 || !(a[3] > 0)) return std::nullopt;
    sky.norm_ = a[3];
    sky.to_sun_ = {a[4], a[5], a[6]};
    return sky;
  }
  if (file == "perezlum.cal" && function == "skybright" && a.size() >= 10) {
    sky.type_ = Type::perez;
    sky.zenith_ = a[0];
    sky.ground_ = a[1];
    std::copy(a.begin() + 2, a.begin() + 7, sky.perez_.begin());
    sky.to_sun_ = {a[7], a[8], a[9]};
    return sky;
  }
  return std::nullopt;
}

double SkyModel::radiance(const Vec3d& direction) const {
  const double up = std::pow(direction.z + 1.01, 10);
  return (up * above_horizon(direction) + ground_ / up) / (up + 1 / up);
}

/// CIE S 003 for clear and overcast skies; Matsuura's intermediate sky (CIE 110, 1994); Perez,
/// Seals and Michalsky, "All-Weather Model for Sky Luminance Distribution", Solar Energy 50 (1993).
double SkyModel::above_horizon(const Vec3d& direction) const {
  const double z = direction.z;
  const double cos_sun = std::clamp(direction.dot(to_sun_), -1.0, 1.0), sun = std::acos(cos_sun);
  switch (type_) {
    case Type::uniform:
      return zenith_;
    case Type::overcast:
      return zenith_ * (1 + 2 * z) / 3;
    case Type::clear:
      return zenith_ * (0.91 + 10 * std::exp(-3 * sun) + 0.45 * cos_sun * cos_sun) *
             (z > 0.01 ? 1 - std::exp(-0.32 / z) : 1.0) / norm_;
    case Type::intermediate: {
      const double from_zenith = std::acos(std::clamp(z, -1.0, 1.0));
      const double sun_zenith = std::acos(std::clamp(to_sun_.z, -1.0, 1.0));
      return zenith_ *
             ((1.35 * std::sin(5.631 - 3.59 * from_zenith) + 3.12) *
                  std::sin(4.396 - 2.6 * sun_zenith) +
              6.37 - from_zenith) /
             2.326 *
             std::exp(-0.563 * sun * ((2.629 - from_zenith) * (1.562 - sun_zenith) + 0.812)) /
             norm_;
    }
    case Type::perez:
      return zenith_ * (1 + perez_[0] * std::exp(perez_[1] / std::max(z, 0.01))) *
             (1 + perez_[2] * std::exp(perez_[3] * sun) + perez_[4] * cos_sun * cos_sun);
  }
  return 0;
}

}  // namespace kaustik::radiance
