#pragma once
#include <memory>
#include <vector>

#include "kaustik/base/sampler.h"
#include "kaustik/photon/emission/emission.h"
#include "kaustik/vcm/lessons/guide_map.h"

namespace kaustik {

/// Density of an emitted ray in two factors.
struct EmissionDensity {
  /// Of the light's point, per area; of lights that are infinitely far away the direction, per
  /// solid angle; 1 for lights that are a single point or direction.
  float endpoint = 0;
  /// Of the rest, given that: the direction, per solid angle; of infinite lights the position, per
  /// area across the direction. The choice of the light is in it.
  float rest = 0;
};

/// A ray that a light path begins with.
struct LightPathStart {
  int light = -1;      ///< −1: nothing was emitted
  EmittedRay emitted;  ///< flux: over the density of all ways of emitting it together
  EmissionDensity density;
};

/// Emission of light paths that serve everything at once: first a light is chosen, then the light's
/// own distribution or, for a share of the rays, one that is aimed at specular objects, or one that
/// was learned; the density is that of the mixture. Immutable.
class LightPathEmission {
 public:
  /// As nothing has been learned. `scene` must outlive this.
  explicit LightPathEmission(const Scene& scene, Aim aim = default_aim);

  /// What was learned of a light.
  struct Guide {
    float chance = 0;  ///< of the light; they sum to 1
    float share = 0;   ///< of its rays that are drawn by `rays`
    float aimed = 0;   ///< of the others, aimed at specular objects
    std::shared_ptr<const GuidedLight> rays;
  };
  /// `plain` with the chances, and learned rays for a share, of `guides`, one for each light.
  LightPathEmission(const LightPathEmission& plain, const std::vector<Guide>& guides);
  /// `plain` with half of the rays of every light aimed at `targets`: for finding out what to
  /// learn.
  LightPathEmission(const LightPathEmission& plain, std::vector<AimTarget> targets);

  /// What was learned, for read().
  void write(ByteWriter& writer) const;
  /// `plain` with what write() wrote. Throws as ByteReader does.
  static LightPathEmission read(ByteReader& reader, const LightPathEmission& plain);

  /// Three dimension pairs.
  LightPathStart sample(Sampler& sampler, const Wavelengths& wavelengths) const;
  /// Density with which sample() finds the ray: from `origin` on the light, or for infinite lights
  /// any point of its line.
  EmissionDensity pdf(int light, const SurfacePoint& origin, const Vec3f& direction) const;

  const Scene& scene() const { return *scene_; }
  /// Whether anything has been learned, and of how many lights the rays have.
  bool is_guided() const { return !guides_.empty(); }
  size_t guided_lights() const;
  float chance(int light) const { return chance_[size_t(light)]; }
  /// Share of a light's rays, but for those that were learned, that is aimed at specular objects.
  float aimed_share(int light) const { return aimed_shares_[size_t(light)]; }
  /// Joint density of the rays of a light that was chosen, by its own distribution alone.
  float own_pdf(int light, const SurfacePoint& origin, const Vec3f& direction) const;
  /// The same of own, aimed and searching rays together.
  float plain_pdf(int light, const SurfacePoint& origin, const Vec3f& direction) const;
  /// The same with what was learned, for a ray whose plain density is known.
  float pdf_of_chosen(int light, float plain, const GuideMap::Place& place) const;

 private:
  EmissionDensity density(int light, const SurfacePoint& origin, const Vec3f& direction) const;
  EmittedRay sample_plain(int light, const Vec2f& u_position, const Vec2f& u_direction,
                          float u_choice, const Wavelengths& wavelengths) const;
  bool has_aimed_rays(int light) const;
  void set_chances(const std::vector<double>& chances);

  const Scene* scene_;
  std::shared_ptr<const EmissionSampler> own_;
  std::vector<float> cumulative_;  ///< chances of the lights, summed up
  std::vector<float> chance_;
  std::shared_ptr<const EmissionSampler> aimed_;
  std::vector<float> aimed_shares_;                   ///< of each light's rays
  std::shared_ptr<const EmissionSampler> searching_;  ///< null: none
  /// Empty while nothing has been learned.
  std::vector<Guide> guides_;
};

}  // namespace kaustik
