#pragma once
#include <functional>

#include "kaustik/photon/emission/aim_density.h"
#include "kaustik/photon/emission/aim_spheres.h"

namespace kaustik {

/// A ray that carries nothing.
EmittedRay no_ray();

/// Emission of one light, by its own distribution. `aim_light.h` is where emission gets its
/// densities; EmissionSampler is what the rest sees.
EmittedRay sample_own(const Light& light, const Vec2f& u_position, const Vec2f& u_direction,
                      const Wavelengths& wavelengths);
/// Joint density of sample_own.
float own_pdf(const Light& light, const SurfacePoint& origin, const Vec3f& direction);

/// Emission of one light toward targets. Immutable.
class LightEmission {
 public:
  virtual ~LightEmission() = default;
  virtual EmittedRay sample(const Vec2f& u_position, const Vec2f& u_direction, float u_target,
                            const Wavelengths& wavelengths) const = 0;
  /// Joint density of sample().
  virtual float pdf(const SurfacePoint& origin, const Vec3f& direction) const = 0;
};

/// Whether rays of the light's own distribution that `aimed_pdf` does not leave out carry flux
/// about as even as aimed rays would (rays that are left out counted as without flux): then aiming
/// is not worth its time.
bool own_serves_as_well(const Light& light,
                        const std::function<float(const SurfacePoint&, const Vec3f&)>& aimed_pdf,
                        int probes);

/// What the aims of all lights are made from.
struct AimInputs {
  const std::vector<AimSphere>& spheres;
  Bounds3f scene_bounds;
  int probes = 16;  ///< origins that estimate what a light sends to each sphere
};

/// Emission of one light toward bounding spheres.
class AimedLight final : public LightEmission {
 public:
  /// `shape`: of area lights, else null. All must outlive this.
  AimedLight(const Light& light, const Shape* shape, const AimInputs& inputs);

  EmittedRay sample(const Vec2f& u_position, const Vec2f& u_direction, float u_target,
                    const Wavelengths& wavelengths) const override;
  float pdf(const SurfacePoint& origin, const Vec3f& direction) const override;

 private:
  enum class Kind {
    dark,      ///< no target can be reached
    own,       ///< the light's own distribution
    place,     ///< cones, from origins uniform over the light
    ball,      ///< cones, from origins on the side that faces the target
    infinite,  ///< disks
  };
  struct Density {
    float position = 0, direction = 0;
  };

  void add_spheres(const AimInputs& inputs);
  void set_own_limit();
  double flux_toward(const AimSphere& sphere, int probes) const;
  double flux_into_cone(const SurfacePoint& origin, const AimCone& cone, uint32_t probe) const;
  float cap_threshold(const AimSphere& sphere) const;
  float cap_height(const Vec3f& sphere_center, float threshold) const;
  Vec3f cap_direction(const Vec3f& sphere_center, float threshold, const Vec2f& u) const;
  void set_chances(std::vector<double> chances);

  size_t pick(float u_target) const;
  Density cone_density(const SurfacePoint& origin, const Vec3f& direction) const;
  Vec3f own_direction(const SurfacePoint& origin, const Vec2f& u_position,
                      const Vec2f& u_direction) const;
  float own_direction_pdf(const SurfacePoint& origin, const Vec3f& direction) const;
  bool ball_origin(size_t i, const Vec2f& u, SurfacePoint& origin) const;
  EmittedRay sample_cones(const Vec2f& u_position, const Vec2f& u_direction, float u_target,
                          const Wavelengths& wavelengths) const;
  EmittedRay sample_disks(const Vec2f& u_position, const Vec2f& u_direction, float u_target,
                          const Wavelengths& wavelengths) const;

  const Light* light_;
  const Shape* shape_;
  Kind kind_ = Kind::dark;
  bool on_surface_ = false;
  AimTable table_;
  std::vector<float> cumulative_;  ///< chances of the spheres, summed
  /// Squared sine of the half angle from which on a cone gives way to the light's own distribution,
  /// and the solid angle that this distribution is spread over.
  float own_limit_ = 1, own_solid_angle_ = 4.0f * pi;
  float peak_ = 0;  ///< largest radiance or intensity that was seen, for floors
  Ball ball_;
  Vec3f scene_center_{0, 0, 0};
  float scene_radius_ = 0;
};

}  // namespace kaustik
