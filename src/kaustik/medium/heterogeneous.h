#pragma once
#include <algorithm>
#include <optional>

#include "kaustik/medium/homogeneous.h"
#include "kaustik/volume/grid_crossing.h"

namespace kaustik {

/// Extinction that is a density, which varies over space, times a value, which varies with the
/// wavelength. Everything that the law of Beer and Lambert says of a homogeneous medium holds with
/// the depth D(s) = ∫ ρ dt in place of the distance s, for all wavelengths alike. Depths are exact.
/// Flights and rough transmittances cross a fine grid by looks at few of its places
/// (grid_tracking.h): unbiased, without steps.
class HeterogeneousMedium final : public Medium {
 public:
  /// The density is that of the grid, none of whose values is negative, relative to its largest,
  /// and zero outside of the box; null: it is 1 everywhere. `densest`: what there is of density 1.
  /// Where `albedo` is given, it stands for the share of the extinction that is scattered, of which
  /// `densest` scatters all.
  HeterogeneousMedium(HomogeneousMedium densest, std::shared_ptr<const GridVolume> density,
                      std::shared_ptr<const Volume> albedo);

  bool has_place() const override { return density_ || albedo_; }
  bool is_like(const Medium& other) const override;
  Spectrum extinction(const Vec3f& position, const Wavelengths& wavelengths) const override {
    return densest_.extinction(position, wavelengths) * density_at(position);
  }
  Spectrum scattering(const Vec3f& position, const Wavelengths& wavelengths) const override {
    return densest_.scattering(position, wavelengths) *
           (albedo_at(position, wavelengths) * density_at(position));
  }
  /// Even where there is nothing not zero: paths that are found there, a little beside what is
  /// denser, count all the same.
  float mean_extinction(const Vec3f& position) const override {
    return densest_.mean_extinction(position) * std::max(least_share, density_at(position));
  }
  float typical_extinction() const override { return typical_extinction_; }

  Spectrum transmittance(const MediumSegment& segment, const Wavelengths& wavelengths,
                         const Sampler& sampler) const override;
  Spectrum rough_transmittance(const MediumSegment& segment, const Wavelengths& wavelengths,
                               const Sampler& sampler) const override;
  void measure(const MediumSegment& segment, std::vector<LineKnot>& knots) const override;
  Spectrum measured_transmittance(const MediumSegment& segment, const std::vector<LineKnot>& knots,
                                  const Wavelengths& wavelengths,
                                  const Sampler& sampler) const override;
  Flight sample_flight(const MediumSegment& segment, const Spectrum& shares,
                       const Wavelengths& wavelengths, Sampler& sampler) const override;
  Flight sample_collision(const MediumSegment& segment, const Spectrum& shares,
                          const Wavelengths& wavelengths, Sampler& sampler) const override;

 private:
  static constexpr float least_share = 0.01f;

  float density_at(const Vec3f& position) const {
    return density_ ? density_->inside(position) * per_largest_ : 1.0f;
  }
  Spectrum albedo_at(const Vec3f& position, const Wavelengths& wavelengths) const {
    return albedo_ ? albedo_->factor(position, wavelengths) : Spectrum(1);
  }
  /// Of the part of the segment from there on, m; where it exceeds `enough`, something above that.
  float depth(const MediumSegment& segment, float from = 0, float enough = infinity) const;
  // Where there is a grid:
  GridCrossing crossing(const MediumSegment& segment) const;
  /// σ_t, 1/m, where the grid's value is 1.
  Spectrum extinction_of_value(const Wavelengths& wavelengths) const;
  /// How far light comes that flies so deep, with depths for integrals.
  GridVolume::Reach reach(const MediumSegment& segment, float flown) const;
  /// A flight to that distance as it is in the medium.
  Flight scattered_at(const MediumSegment& segment, float distance, const Spectrum& weight,
                      const Wavelengths& wavelengths) const;

  HomogeneousMedium densest_;
  std::shared_ptr<const GridVolume> density_;
  std::shared_ptr<const Volume> albedo_;
  float per_largest_ = 1;  ///< one over the grid's largest value
  float typical_extinction_;
};

/// Of the parameters `albedo`, `sigma_t` and `scale`, as values or volumes; null where it is
/// vacuum. Throws Error(input) where the extinction is no density times a value, or a grid holds
/// what it cannot be.
std::shared_ptr<const Medium> make_heterogeneous(const MediumInputs& inputs);

}  // namespace kaustik
