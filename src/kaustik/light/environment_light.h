#pragma once
#include "kaustik/light/light_kinds.h"

namespace kaustik {

/// What lights all around the scene share: each tells the radiance that comes from a direction, how
/// to sample directions, and how bright it is as a whole.
class EnvironmentLight : public DistantLight {
 public:
  LightSample sample_toward(const LightQuery& query, const Vec2f& u) const final;
  float pdf_toward(const LightQuery& query, const LightTarget& target) const final;

  Spectrum emitted(const SurfacePoint& point, const Vec3f& direction,
                   const Wavelengths& wavelengths) const final;
  EmissionSample sample_emission(const Vec2f& u_position, const Vec2f& u_direction,
                                 const Wavelengths& wavelengths) const final;
  float emission_pdf_position(const SurfacePoint& point) const final;
  float emission_pdf_direction(const SurfacePoint& point, const Vec3f& direction) const final;
  TravelDirection sample_travel_direction(const Vec2f& u) const final;

 protected:
  /// What directions are drawn for: the light that a point receives, or emission.
  struct Purpose {
    const LightQuery* receiver = nullptr;  ///< null: emission
  };

  explicit EnvironmentLight(const EmissionDisk& disk) : disk_(disk) {
    traits_.bounds.infinite = true;
  }
  /// `fluence`: radiance integrated over all directions in RGB mode, W/m². To be called by
  /// constructors.
  void set_fluence(const Spectrum& fluence) { traits_.power = fluence * disk_.area(); }
  /// A unit direction in the world, away from the scene; zero if there is none.
  virtual Vec3f sample_direction(const Vec2f& u, Purpose purpose) const = 0;
  virtual float direction_pdf(const Vec3f& direction, Purpose purpose) const = 0;

 private:
  EmissionDisk disk_;
};

}  // namespace kaustik
