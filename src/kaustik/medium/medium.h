#pragma once
#include "kaustik/base/spectrum.h"

namespace kaustik {

/// What fills the space between surfaces. Immutable, thread-safe. No medium is vacuum.
class Medium {
 public:
  virtual ~Medium() = default;
  /// Share of the light of each lane that is left after `distance` (scene units, ≥ 0, may be
  /// infinite) on a straight line.
  virtual Spectrum transmittance(float distance) const = 0;
};

/// Homogeneous and absorbing: the law of Beer and Lambert.
class AbsorbingMedium final : public Medium {
 public:
  /// `absorption`: coefficient per scene unit of each lane, ≥ 0.
  explicit AbsorbingMedium(const Spectrum& absorption) : absorption_(absorption) {}
  Spectrum transmittance(float distance) const override;

 private:
  Spectrum absorption_;
};

}  // namespace kaustik
