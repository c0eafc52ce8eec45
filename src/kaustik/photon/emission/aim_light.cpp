#include "kaustik/photon/emission/aim_light.h"

#include <algorithm>

#include "kaustik/base/warp.h"
#include "kaustik/photon/emission/facing_origins.h"

namespace kaustik {
namespace {

/// A point that is on no surface.
SurfacePoint free_point(const Vec3f& position) {
  SurfacePoint point;
  point.position = position;
  point.ng = point.ns = Vec3f(0, 0, 0);
  point.uv = Vec2f(0, 0);
  return point;
}

}  // namespace

EmittedRay no_ray() {
  EmittedRay result;
  result.origin = free_point({0, 0, 0});
  return result;
}

EmittedRay sample_own(const Light& light, const Vec2f& u_position, const Vec2f& u_direction,
                      const Wavelengths& wavelengths) {
  const EmissionSample s = light.sample_emission(u_position, u_direction, wavelengths);
  EmittedRay result;
  result.origin = s.on_surface ? s.point : free_point(s.point.position);
  result.on_surface = s.on_surface;
  result.ray = s.on_surface ? spawn_ray(s.point, s.direction) : Ray{s.point.position, s.direction};
  result.flux = s.flux;
  result.pdf_position = s.pdf_position;
  result.pdf_direction = s.pdf_direction;
  return result;
}

float own_pdf(const Light& light, const SurfacePoint& origin, const Vec3f& direction) {
  return light.emission_pdf_position(origin) * light.emission_pdf_direction(origin, direction);
}

EmittedRay AimedLight::sample(const Vec2f& u_position, const Vec2f& u_direction, float u_target,
                              const Wavelengths& wavelengths) const {
  switch (kind_) {
    case Kind::dark:
      return no_ray();
    case Kind::own:
      return sample_own(*light_, u_position, u_direction, wavelengths);
    case Kind::infinite:
      return sample_disks(u_position, u_direction, u_target, wavelengths);
    default:
      return sample_cones(u_position, u_direction, u_target, wavelengths);
  }
}

float AimedLight::pdf(const SurfacePoint& origin, const Vec3f& direction) const {
  switch (kind_) {
    case Kind::dark:
      return 0;
    case Kind::own:
      return own_pdf(*light_, origin, direction);
    case Kind::infinite:
      return light_->emission_pdf_direction(origin, direction) *
             sum_disks(table_, origin.position, direction);
    default: {
      const Density density = cone_density(origin, direction);
      return density.position * density.direction;
    }
  }
}

size_t AimedLight::pick(float u_target) const {
  const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), u_target);
  return std::min(size_t(found - cumulative_.begin()), cumulative_.size() - 1);
}

AimedLight::Density AimedLight::cone_density(const SurfacePoint& origin,
                                             const Vec3f& direction) const {
  Density density;
  AimSums sums;
  if (kind_ == Kind::ball) {
    sums =
        sum_cones_of_ball(table_, origin.position, direction, own_limit_, ball_.center, origin.ng);
    density.position = sums.position;
  } else {
    sums = sum_cones(table_, origin.position, direction, own_limit_);
    density.position = light_->emission_pdf_position(origin);
  }
  density.direction = sums.cones;
  if (sums.own > 0) density.direction += sums.own * own_direction_pdf(origin, direction);
  // A ball's weights are per area of the caps: their sum is the joint density.
  if (kind_ == Kind::ball && density.position > 0) density.direction /= density.position;
  return density;
}

Vec3f AimedLight::own_direction(const SurfacePoint& origin, const Vec2f& u_position,
                                const Vec2f& u_direction) const {
  if (on_surface_) return Frame(origin.ng).to_world(square_to_cosine_hemisphere(u_direction));
  return light_->sample_emission(u_position, u_direction, {}).direction;
}

float AimedLight::own_direction_pdf(const SurfacePoint& origin, const Vec3f& direction) const {
  if (on_surface_) return cosine_hemisphere_pdf(dot(origin.ng, direction));
  return light_->emission_pdf_direction(origin, direction);
}

/// 1 − cos of the cap's half angle.
float AimedLight::cap_height(const Vec3f& sphere_center, float threshold) const {
  const float distance = length(sphere_center - ball_.center);
  return distance > 0 ? std::clamp(1.0f - threshold / distance, 0.0f, 2.0f) : 2.0f;
}

Vec3f AimedLight::cap_direction(const Vec3f& sphere_center, float threshold, const Vec2f& u) const {
  const Vec3f to = sphere_center - ball_.center;
  const float distance = length(to);
  const Vec3f axis = distance > 0 ? to * (1.0f / distance) : Vec3f(0, 0, 1);
  return Frame(axis).to_world(square_to_cone(u, cap_height(sphere_center, threshold)));
}

/// A point of the ball, uniform in the cap that faces sphere `i`.
bool AimedLight::ball_origin(size_t i, const Vec2f& u, SurfacePoint& origin) const {
  const Vec3f outward = cap_direction(table_.center(i), table_.cap_threshold[i], u);
  if (!point_of_ball(*shape_, ball_, outward, origin)) return false;
  origin.shape = uint32_t(light_->traits().shape);
  return true;
}

EmittedRay AimedLight::sample_cones(const Vec2f& u_position, const Vec2f& u_direction,
                                    float u_target, const Wavelengths& wavelengths) const {
  EmittedRay result = no_ray();
  result.on_surface = on_surface_;
  const size_t i = pick(u_target);
  if (kind_ == Kind::ball) {
    if (!ball_origin(i, u_position, result.origin)) return result;
  } else {
    const EmissionSample s = light_->placed().sample_origin(u_position);
    if (!(s.pdf_position > 0)) return result;
    result.origin = on_surface_ ? s.point : free_point(s.point.position);
  }
  const AimCone cone =
      cone_toward(table_.center(i), table_.radius_sq[i], result.origin.position, own_limit_);
  const Vec3f direction =
      cone.own ? own_direction(result.origin, u_position, u_direction)
               : Frame(cone.axis).to_world(square_to_cone(u_direction, cone.one_minus_cos));
  const float cosine = on_surface_ ? dot(result.origin.ng, direction) : 1.0f;
  result.ray =
      on_surface_ ? spawn_ray(result.origin, direction) : Ray{result.origin.position, direction};
  if (!(cosine > 0)) return result;
  const Density density = cone_density(result.origin, direction);
  result.pdf_position = density.position;
  result.pdf_direction = density.direction;
  const float pdf = density.position * density.direction;
  if (pdf > 0)
    result.flux = light_->emitted(result.origin, direction, wavelengths) * (cosine / pdf);
  return result;
}

EmittedRay AimedLight::sample_disks(const Vec2f& u_position, const Vec2f& u_direction,
                                    float u_target, const Wavelengths& wavelengths) const {
  EmittedRay result = no_ray();
  const TravelDirection travel = light_->distant().sample_travel_direction(u_direction);
  const Vec3f& direction = travel.direction;
  result.pdf_direction = travel.pdf;
  const size_t i = pick(u_target);
  const Vec2f disk = square_to_disk(u_position) * std::sqrt(table_.radius_sq[i]);
  const Vec3f on_disk = table_.center(i) + Frame(direction).to_world(Vec3f(disk.x, disk.y, 0.0f));
  // Back to where the whole scene lies ahead.
  const float back = dot(on_disk - scene_center_, direction) + scene_radius_;
  result.origin.position = on_disk - direction * std::max(back, 0.0f);
  result.ray = {result.origin.position, direction};
  result.pdf_position = sum_disks(table_, result.origin.position, direction);
  const float pdf = result.pdf_position * result.pdf_direction;
  if (pdf > 0) result.flux = light_->emitted(result.origin, direction, wavelengths) * (1.0f / pdf);
  return result;
}

}  // namespace kaustik
