#pragma once
#include <functional>
#include <vector>

#include "kaustik/base/spectrum.h"
#include "kaustik/base/vec.h"

namespace kaustik {

/// Directional albedo of a reflecting lobe over wo, computed once from its own sampler. A lobe that
/// looks different along x and y must be symmetric about both axes.
class AlbedoTable {
 public:
  /// `weight(wo, u)` is f·cosθ_i/pdf of one sample, zero where it is absorbed.
  AlbedoTable(bool isotropic, const std::function<Spectrum(const Vec3f&, const Vec2f&)>& weight);
  /// Linear between the nodes; wo.z > 0.
  Spectrum operator()(const Vec3f& wo) const;

 private:
  int azimuths_;
  std::vector<Spectrum> nodes_;  ///< by azimuth in the first quadrant, then by cosine
};

}  // namespace kaustik
