#pragma once
// The kinds of lights, one per file, and what several of them share.

#include <memory>
#include <string_view>

#include "kaustik/base/spectral_value.h"
#include "kaustik/light/light.h"

namespace kaustik {

LightType area_light_type();
LightType directional_area_light_type();
LightType point_light_type();
LightType spot_light_type();
LightType projector_light_type();
LightType goniometric_light_type();
LightType directional_light_type();
LightType constant_light_type();
LightType envmap_light_type();
LightType sunsky_light_type();
LightType sky_light_type();
LightType sun_light_type();
LightType background_light_type();
LightType distributed_light_type();
LightType distributed_spot_light_type();

/// Whether the map keeps angles, up to rounding of its numbers.
bool keeps_angles(const Transform& t);
/// The axes of a map that keeps angles, unit vectors of the world; it may mirror.
Frame axes_of(const Transform& world_from_light);
/// A color argument of something that emits.
SpectralValue emission_argument(const LightInputs& inputs, std::string_view name);
/// The emitter's own `to_world` if the arguments give it, else that of the inputs.
const Transform& emitter_transform(const LightInputs& inputs);
/// The finished light; throws where its power overflows.
std::unique_ptr<Light> with_finite_power(std::unique_ptr<Light> light, const LightInputs& inputs);
/// What Light::shadow_samples is read from.
Parameter shadow_samples_parameter();
/// Whether the camera sees the light itself; see Scene::is_hidden().
Parameter visible_parameter();
/// What Mitsuba's emitters accept and Kaustik has no use for.
Parameter ignored_sampling_weight();

/// A point off every surface: all but the position is zero.
SurfacePoint free_point(const Vec3f& position);
/// A point light at `point` seen from `reference`: where it is, without its light (radiance and
/// density zero); nothing where both coincide.
LightSample toward_point(const SurfacePoint& point, const Vec3f& reference);

/// Cosine of light along `direction` on the queried surface, zero from behind; without a surface it
/// faces the light. Otherwise never quite zero: a shading normal may face what the geometric one
/// hardly does.
float receiver_cosine(const LightQuery& query, const Vec3f& direction);

/// The disk that rays of infinite lights start from: across their direction, just outside of the
/// scene, as large as the scene's bounding sphere.
class EmissionDisk {
 public:
  /// Empty or flat bounds give a tiny disk.
  explicit EmissionDisk(const Bounds3f& scene_bounds);
  float area() const { return pi * radius_ * radius_; }
  /// Uniform on the disk for rays that travel along unit `direction`.
  Vec3f origin(const Vec3f& direction, const Vec2f& u) const;

 private:
  Vec3f center_{0, 0, 0};
  float radius_;
};

}  // namespace kaustik
