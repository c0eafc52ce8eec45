#pragma once
#include "kaustik/base/spectrum.h"
#include "kaustik/base/vec.h"

namespace kaustik {

/// (1 − cosine)⁵, what Schlick's approximation weights grazing light with.
inline float schlick_weight(float cosine) {
  const float m = std::clamp(1 - cosine, 0.0f, 1.0f), m_sq = m * m;
  return m_sq * m_sq * m;
}

/// μ (1 − μ)⁶, by which metals fall short of Schlick's approximation toward their edge (Lazányi and
/// Szirmay-Kalos, "Fresnel Term Approximations for Metals", 2005); largest at a cosine of 1/7.
inline float lazanyi_weight(float cosine) {
  const float m = std::clamp(1 - cosine, 0.0f, 1.0f), m_sq = m * m;
  return cosine * m_sq * m_sq * m_sq;
}
inline constexpr float lazanyi_cosine = 1.0f / 7;

/// What a metal reflects by that: F0 + (F90 − F0) schlick_weight(μ) − edge lazanyi_weight(μ).
struct LazanyiMetal {
  Spectrum normal, grazing, edge;

  /// That reflects `at_edge` at lazanyi_cosine.
  static LazanyiMetal through(const Spectrum& normal, const Spectrum& grazing,
                              const Spectrum& at_edge) {
    const Spectrum schlick = normal + (grazing - normal) * schlick_weight(lazanyi_cosine);
    return {normal, grazing, (schlick - at_edge) / lazanyi_weight(lazanyi_cosine)};
  }
  /// At one angle, or on the mean: of the means of 1, schlick_weight and lazanyi_weight. Of dark
  /// metals with a dark edge the last term may be more than there is.
  Spectrum reflectance(float one, float schlick, float lazanyi) const {
    const Spectrum sum = normal * (one - schlick) + grazing * schlick - edge * lazanyi;
    return {std::max(sum[0], 0.0f), std::max(sum[1], 0.0f), std::max(sum[2], 0.0f),
            std::max(sum[3], 0.0f)};
  }
  Spectrum reflectance(float cosine) const {
    return reflectance(1, schlick_weight(cosine), lazanyi_weight(cosine));
  }
};

}  // namespace kaustik
