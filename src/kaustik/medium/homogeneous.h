#pragma once
#include <array>

#include "kaustik/base/spectral_value.h"
#include "kaustik/medium/medium.h"

namespace kaustik {

/// The same everywhere.
class HomogeneousMedium final : public Medium {
 public:
  /// `extinction` σ_t ≥ 0; `scattering` σ_s in [0, σ_t], per lane; finite.
  HomogeneousMedium(const SpectralValue& extinction, const SpectralValue& scattering,
                    std::shared_ptr<const PhaseFunction> phase = isotropic_phase_function());

  bool is_like(const Medium& other) const override;
  Spectrum extinction(const Vec3f&, const Wavelengths& wavelengths) const override {
    return extinction_.at(wavelengths);
  }
  Spectrum scattering(const Vec3f&, const Wavelengths& wavelengths) const override {
    return scattering_.at(wavelengths);
  }
  float mean_extinction(const Vec3f&) const override { return mean_extinction_; }
  float typical_extinction() const override { return mean_extinction_; }

  Spectrum transmittance(const MediumSegment& segment, const Wavelengths& wavelengths,
                         const Sampler&) const override {
    return transmittance(segment.length, wavelengths);
  }
  Flight sample_flight(const MediumSegment& segment, const Spectrum& shares,
                       const Wavelengths& wavelengths, Sampler& sampler) const override {
    return sample_flight(segment.length, shares, wavelengths, sampler.next_2d());
  }
  Flight sample_collision(const MediumSegment& segment, const Spectrum& shares,
                          const Wavelengths& wavelengths, Sampler& sampler) const override {
    return sample_collision(segment.length, shares, wavelengths, sampler.next_2d());
  }

  // The same by the length of the segment, which is all that matters here, and the numbers.
  /// exp(−σ_t d), the law of Beer and Lambert.
  Spectrum transmittance(float length, const Wavelengths& wavelengths) const;
  /// The extinction of a lane is sampled; the density is the sum over all lanes (balance
  /// heuristic), so the weight is bounded by the albedo times sum over share.
  Flight sample_flight(float length, const Spectrum& shares, const Wavelengths& wavelengths,
                       const Vec2f& u) const;
  /// The lane by whose extinction a flight is sampled, by a number in [0, 1).
  static int flying_lane(const Spectrum& shares, float u);
  /// The weight of a flight that collides, and of one that comes to the end of the segment. `left`:
  /// per lane, up to a common factor, the probability that its light comes as far.
  Spectrum collided(const Spectrum& left, const Spectrum& shares,
                    const Wavelengths& wavelengths) const;
  static Spectrum passed(const Spectrum& left, const Spectrum& shares);
  Flight sample_collision(float length, const Spectrum& shares, const Wavelengths& wavelengths,
                          const Vec2f& u) const;

 private:
  SpectralValue extinction_, scattering_;
  float mean_extinction_;
  std::array<Spectrum, 4> looks_;  ///< what tells media apart: in RGB mode and at some wavelengths
};

}  // namespace kaustik
