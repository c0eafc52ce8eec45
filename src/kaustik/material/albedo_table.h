#pragma once
#include <functional>
#include <vector>

#include "kaustik/base/spectrum.h"
#include "kaustik/base/vec.h"

namespace kaustik {

/// Directional albedo of a reflecting lobe by the direction of view, computed once by sampling;
/// good to about a percent.
class AlbedoTable {
 public:
  /// `weight(wo, u)`: the lobe's f·cosθ_i/pdf for a direction sampled with u, zero where absorbed.
  AlbedoTable(bool isotropic, const std::function<Spectrum(const Vec3f&, const Vec2f&)>& weight);
  /// wo.z > 0.
  Spectrum operator()(const Vec3f& wo) const;

 private:
  int azimuths_;  ///< over a quarter turn; 1: isotropic
  std::vector<Spectrum> nodes_;
};

/// The same for a lobe with a parameter that varies from `low` to `high`.
class AlbedoTables {
 public:
  /// `weight(parameter, wo, u)` as above.
  AlbedoTables(float low, float high, bool isotropic,
               const std::function<Spectrum(float, const Vec3f&, const Vec2f&)>& weight);
  Spectrum operator()(float parameter, const Vec3f& wo) const;

 private:
  float low_, high_;
  std::vector<AlbedoTable> tables_;
};

}  // namespace kaustik
