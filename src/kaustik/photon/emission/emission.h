#pragma once
#include <memory>
#include <string>
#include <vector>

#include "kaustik/base/parameters.h"
#include "kaustik/scene/scene.h"

namespace kaustik {

class LightEmission;

/// What emission may be aimed at: a box that contains part of an object, and how much it matters
/// (its albedo). Everything that counts must lie inside some target's box.
struct AimTarget {
  Bounds3f box;
  float weight = 1;
  /// If above zero: everything also lies within this distance of the box's centre.
  float radius = 0;
};

/// A ray that leaves a light.
struct EmittedRay {
  Ray ray{{0, 0, 0}, {0, 0, 1}};  ///< already off the light's surface
  SurfacePoint origin;            ///< on the light; ng zero for lights without a surface
  bool on_surface = false;
  Spectrum flux;           ///< W carried if this were the light's only photon: emitted radiance ×
                           ///< cosine / (pdf_position × pdf_direction); zero: nothing was emitted
  float pdf_position = 0;  ///< measures as in EmissionSample; the product is the joint density
  float pdf_direction = 0;
};

/// How emission is aimed at targets.
enum class Aim {
  none,           ///< by the light's own distribution
  boxes,          ///< at the boxes' bounding spheres
  projection_map  ///< through the cells of a projection map
};
/// The parameter `aim` of integrators, and its reading.
Parameter aim_parameter();
Aim read_aim(const std::string& name);
inline constexpr Aim default_aim = Aim::boxes;

/// The source of all emission densities but learned ones. Per light: by the light's own
/// distribution, or aimed, so that few rays miss the targets' boxes, with exact densities.
/// By `Aim::boxes` a light with a place chooses a target by the flux that goes there and samples
/// the cone that the target's bounding sphere subtends at the origin (density: the sum over all
/// cones that hold the direction); an infinite light samples the disks of the bounding spheres
/// projected along the direction (likewise). Spherical lights only use the side that faces the
/// target. Where a target surrounds the origin, or takes more than the light emits into, the
/// light's own distribution stands in for its cone. By `Aim::projection_map` see ProjectionMap;
/// environment lights are aimed as by `boxes`. Beams, and lights whose own distribution serves the
/// targets as well, use that. A target has no chance only where bounds prove that the light cannot
/// reach it. Immutable.
class EmissionSampler {
 public:
  /// By power: every light by its own distribution. `scene` must outlive this.
  explicit EmissionSampler(const Scene& scene);
  /// Aimed by Aim::boxes at `targets`. With no targets nothing is emitted.
  EmissionSampler(const Scene& scene, std::vector<AimTarget> targets);
  /// Aimed at what has any of `lobes`, see find_targets; by power for Aim::none.
  EmissionSampler(const Scene& scene, Lobes lobes, int budget, Aim aim);
  ~EmissionSampler();

  /// A ray of light `light`. Dimensions: `u_target` picks the target.
  EmittedRay sample(int light, const Vec2f& u_position, const Vec2f& u_direction, float u_target,
                    const Wavelengths& wavelengths) const;
  /// Joint density (pdf_position × pdf_direction) with which sample() finds this ray: from `origin`
  /// on light `light` (on the plane across the direction, for infinite lights: any point of the
  /// ray's line) along `direction`.
  float pdf(int light, const SurfacePoint& origin, const Vec3f& direction) const;
  /// Takes off what infinitely far light has lost on an infinite length of what surrounds the
  /// scene; sample() has done it.
  void dim(int light, EmittedRay& emitted, const Wavelengths& wavelengths) const;
  bool aimed() const { return aimed_; }
  /// Boxes that there are to aim at (by power: found, not aimed at).
  size_t target_count() const { return target_count_; }

 private:
  void aim_at(std::vector<AimTarget> targets, const std::vector<AimTarget>& seen_by_cells);

  /// One per light; empty: by power.
  std::vector<std::unique_ptr<LightEmission>> lights_;
  bool aimed_ = false;
  size_t target_count_ = 0;
  const Scene* scene_;
};

/// Of area lights; else null.
const Shape* shape_of(const Scene& scene, const Light& light);

inline constexpr int default_target_budget = 128;

/// Boxes of every shape (and instance) whose bsdf has any of `lobes`, at most `budget` of them,
/// weighted by the albedo of those lobes. For Aim::boxes as many as serve best, since each costs
/// time: long and hollow shapes get more boxes than compact ones. For Aim::projection_map, where
/// they cost none, as many as there may be. For caustics: Lobes::specular or Lobes::delta.
std::vector<AimTarget> find_targets(const Scene& scene, Lobes lobes, int budget,
                                    Aim aim = default_aim);

/// How many photons each light emits: nine tenths of `total` in proportion to `arriving` (flux that
/// arrived in a training pass, per light; any unit), the rest mostly by `power`. Lights without
/// power get none, all others at least one, even where that makes more than `total`; otherwise the
/// counts sum to `total`.
std::vector<uint32_t> share_photons(uint32_t total, const std::vector<double>& arriving,
                                    const std::vector<double>& power);

}  // namespace kaustik
