#pragma once
#include "kaustik/light/light_kinds.h"

namespace kaustik {

/// What lights all around the scene share: each tells the radiance that comes from a direction, how
/// to sample directions, and how bright it is as a whole.
class EnvironmentLight : public Light {
 public:
  LightBounds bounds() const final;
  bool is_delta() const final { return false; }
  bool is_infinite() const final { return true; }
  Spectrum power() const final { return fluence() * disk_.area(); }

  LightSample sample_toward(const LightQuery& query, const Vec2f& u) const final;
  float pdf_toward_direction(const LightQuery& query, const Vec3f& direction) const final;

  EmissionSample sample_emission(const Vec2f& u_position, const Vec2f& u_direction) const final;
  float emission_pdf_position(const SurfacePoint& point) const final;
  float emission_pdf_direction(const SurfacePoint& point, const Vec3f& direction) const final;
  Spectrum emitted_from(const SurfacePoint& point, const Vec3f& direction) const final;
  Vec3f sample_travel_direction(const Vec2f& u, float& pdf) const final;

 protected:
  /// What directions are drawn for: the light that a point receives, or emission.
  struct Purpose {
    const LightQuery* receiver = nullptr;  ///< null: emission
  };

  explicit EnvironmentLight(const EmissionDisk& disk) : disk_(disk) {}
  /// Radiance integrated over all directions, W/m².
  virtual Spectrum fluence() const = 0;
  /// A unit direction in the world, away from the scene; zero if there is none.
  virtual Vec3f sample_direction(const Vec2f& u, Purpose purpose) const = 0;
  virtual float direction_pdf(const Vec3f& direction, Purpose purpose) const = 0;

 private:
  EmissionDisk disk_;
};

}  // namespace kaustik
