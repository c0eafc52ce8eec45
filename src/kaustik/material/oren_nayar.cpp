#include "kaustik/material/oren_nayar.h"

#include <algorithm>

namespace kaustik {

OrenNayar::OrenNayar(float roughness)
    : roughness_(roughness),
      scale_(1 / (1 + (0.5f - 2 / (3 * pi)) * roughness)),
      mean_(scale_ * (1 + (2.0f / 3 - 28 / (15 * pi)) * roughness)) {}

float OrenNayar::albedo_of_once(float cosine) const {
  const float sine = safe_sqrt(1 - cosine * cosine);
  const float along = sine * (std::acos(std::min(cosine, 1.0f)) - sine * cosine) +
                      (2.0f / 3) * (sine / cosine * (1 - sine * sine * sine) - sine);
  return std::min(1.0f, scale_ * (1 + roughness_ * inv_pi * along));
}

Spectrum OrenNayar::several_times(const Spectrum& color) const {
  return color * color * mean_ / (Spectrum(1) - color * (1 - mean_));
}

float OrenNayar::between(float cos_o, float cos_i) const {
  return (1 - albedo_of_once(cos_o)) * (1 - albedo_of_once(cos_i)) / std::max(1e-7f, 1 - mean_);
}

Spectrum OrenNayar::eval(const Spectrum& color, const Vec3f& wo, const Vec3f& wi) const {
  const float across = wo.x * wi.x + wo.y * wi.y;
  const float once =
      scale_ * (1 + roughness_ * (across > 0 ? across / std::max(wo.z, wi.z) : across));
  return (color * once + several_times(color) * between(wo.z, wi.z)) * inv_pi;
}

Spectrum OrenNayar::around(const Spectrum& color, float cos_o, float cos_i) const {
  // The mean of cosφ, where it is above 0, is 1/π.
  const float sines = safe_sqrt((1 - cos_o * cos_o) * (1 - cos_i * cos_i));
  const float once = scale_ * (1 + roughness_ * inv_pi * sines * (1 / std::max(cos_o, cos_i) - 1));
  return color * once + several_times(color) * between(cos_o, cos_i);
}

Spectrum OrenNayar::albedo(const Spectrum& color, float cosine) const {
  const float once = albedo_of_once(cosine);
  return color * once + several_times(color) * (1 - once);
}

}  // namespace kaustik
