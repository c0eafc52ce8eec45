#include "kaustik/vcm/lessons/guide_map.h"

#include <algorithm>

#include "kaustik/base/warp.h"

namespace kaustik {
namespace {

/// Two disks side by side, the upper and the lower half of the sphere by Lambert's projection.
Vec2f sphere_to_square(const Vec3f& direction) {
  const float scale = 1 / std::sqrt(1 + std::fabs(direction.z));
  const Vec2f on_disk = disk_to_square(Vec2f(direction.x, direction.y) * scale);
  const auto within = [](float x) { return std::clamp(x, 0.0f, one_minus_epsilon); };
  return {0.5f * (within(on_disk.x) + (direction.z < 0 ? 1.0f : 0.0f)), within(on_disk.y)};
}

Vec3f square_to_halves(const Vec2f& u) {
  const bool below = u.x >= 0.5f;
  const Vec2f disk = square_to_disk({2 * u.x - (below ? 1.0f : 0.0f), u.y});
  const float radius_sq = std::min(disk.x * disk.x + disk.y * disk.y, 1.0f);
  const float scale = std::sqrt(2 - radius_sq);
  return normalize(Vec3f(disk.x * scale, disk.y * scale, below ? radius_sq - 1 : 1 - radius_sq));
}

}  // namespace

GuideMap::GuideMap(const Light& light, const Shape* shape, const Bounds3f& scene_bounds)
    : light_(&light), origins_(light, shape) {
  if (!light.is_infinite()) {
    kind_ = Kind::direction;
    frame_ = Frame(light.traits().bounds.axis);
  } else if (light.traits().is_delta && !light.traits().is_beam() && !scene_bounds.isEmpty()) {
    kind_ = Kind::plane;
    frame_ = Frame(light.distant().sample_travel_direction({0.5f, 0.5f}).direction);
    middle_ = frame_.to_local(center(scene_bounds));
    radius_ = 1.001f * bounding_radius(scene_bounds);
  }
}

GuideMap::Place GuideMap::place_of(const SurfacePoint& origin, const Vec3f& direction) const {
  switch (kind_) {
    case Kind::direction:
      return {sphere_to_square(frame_.to_local(direction)),
              origins_.pdf(origin, direction) * sphere_pdf};
    case Kind::plane: {
      const Vec3f from_middle = frame_.to_local(origin.position) - middle_;
      const float scale = 0.5f / radius_;
      return {{0.5f + scale * from_middle.x, 0.5f + scale * from_middle.y},
              light_->emission_pdf_direction(origin, direction) * sqr(scale)};
    }
    default:
      return {};
  }
}

EmittedRay GuideMap::ray_from_plane(const Vec2f& u, const Wavelengths& wavelengths) const {
  EmittedRay result = no_ray();
  const Vec3f local = middle_ + Vec3f(2 * u.x - 1, 2 * u.y - 1, -1) * radius_;
  result.origin.position = frame_.to_world(local);
  result.ray = {result.origin.position, frame_.z};
  result.pdf_position = sqr(0.5f / radius_);
  result.pdf_direction = 1;
  result.flux = light_->emitted(result.origin, frame_.z, wavelengths);
  return result;
}

EmittedRay GuideMap::ray_at(const Vec2f& u, float pdf, const Vec2f& u_rest,
                            const Wavelengths& wavelengths) const {
  if (kind_ == Kind::plane) {
    EmittedRay result = ray_from_plane(u, wavelengths);
    result.pdf_position *= pdf;
    result.flux *= pdf > 0 ? 1 / result.pdf_position : 0.0f;
    return result;
  }
  return origins_.ray(frame_.to_world(square_to_halves(u)), pdf * sphere_pdf, u_rest, wavelengths);
}

EmittedRay GuidedLight::sample(const Vec2f& u_position, const Vec2f& u_direction, float,
                               const Wavelengths& wavelengths) const {
  const Vec2f u = square_.sample(u_direction);
  return map_->ray_at(u, square_.pdf(u), u_position, wavelengths);
}

}  // namespace kaustik
