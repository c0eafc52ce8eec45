#pragma once
#include <memory>
#include <string>
#include <vector>

#include "kaustik/scene/scene.h"

namespace kaustik {

/// What emission may be aimed at: a box that contains part of an object, and how much it matters
/// (its albedo). Everything that counts must lie inside some target's box.
struct AimTarget {
  Bounds3f box;
  float weight = 1;
};

/// A ray that leaves a light.
struct EmittedRay {
  Ray ray;              ///< already off the light's surface
  SurfacePoint origin;  ///< on the light; ng zero for lights without a surface
  bool on_surface = false;
  Spectrum flux;           ///< W carried if this were the light's only photon: emitted radiance ×
                           ///< cosine / (pdf_position × pdf_direction); zero: nothing was emitted
  float pdf_position = 0;  ///< measures as in EmissionSample
  float pdf_direction = 0;
};

/// The only source of emission densities. Per light: by the light's own distribution, or aimed, so
/// that only rays which may meet a target's box are emitted, with exact densities: a place light
/// samples the cones that the targets' bounding spheres subtend at the origin (density: the sum
/// over all cones that hold the direction), an infinite light samples the disks of the targets'
/// bounding spheres projected along the direction (likewise). Where a target surrounds the origin,
/// the light's own distribution takes its share of the mixture. Immutable.
class EmissionSampler {
 public:
  /// By power: every light by its own distribution. `scene` must outlive this.
  explicit EmissionSampler(const Scene& scene);
  /// Aimed at `targets`. With no targets nothing is emitted.
  EmissionSampler(const Scene& scene, std::vector<AimTarget> targets);
  ~EmissionSampler();

  /// A ray of light `light`. Dimensions: `u_target` picks the target.
  EmittedRay sample(int light, const Vec2f& u_position, const Vec2f& u_direction,
                    float u_target) const;
  /// Joint density (pdf_position × pdf_direction) with which sample() finds this ray: from `origin`
  /// on light `light` (on the plane across the direction, for infinite lights: any point of the
  /// ray's line) along `direction`.
  float pdf(int light, const SurfacePoint& origin, const Vec3f& direction) const;
  bool aimed() const;

 private:
  struct Aim;
  std::unique_ptr<Aim> aim_;  ///< null: by power
  const Scene* scene_;
};

/// Boxes of every shape (and instance) whose bsdf has any of `lobes`, at most about `budget` of
/// them, weighted by albedo. For caustics: Lobes::specular or Lobes::delta.
std::vector<AimTarget> find_targets(const Scene& scene, Lobes lobes, int budget);

/// How many photons each light emits: shares of `total` in proportion to `arriving` (flux that
/// arrived in a training pass, per light; any unit), with a floor so that every light that emits
/// gets some; counts sum to `total` unless that is below the number of lights.
std::vector<uint32_t> share_photons(uint32_t total, const std::vector<double>& arriving,
                                    const std::vector<double>& power);

}  // namespace kaustik
