#include "kaustik/light/light_kinds.h"

#include <fmt/format.h>

#include "kaustik/base/warp.h"

namespace kaustik {

bool keeps_angles(const Transform& t) {
  const Vec3f x = t.vector({1, 0, 0}), y = t.vector({0, 1, 0}), z = t.vector({0, 0, 1});
  const float size = length_sq(z), tolerance = 1e-3f * size;
  return std::fabs(length_sq(x) - size) < tolerance && std::fabs(length_sq(y) - size) < tolerance &&
         abs_dot(x, y) < tolerance && abs_dot(y, z) < tolerance && abs_dot(x, z) < tolerance;
}

Frame axes_of(const Transform& world_from_light) {
  Frame frame;
  frame.x = normalize(world_from_light.vector({1, 0, 0}));
  frame.y = normalize(world_from_light.vector({0, 1, 0}));
  frame.z = normalize(world_from_light.vector({0, 0, 1}));
  return frame;
}

SpectralValue emission_argument(const LightInputs& inputs, std::string_view name) {
  return SpectralValue::emission(inputs.arguments.color(name));
}

const Transform& emitter_transform(const LightInputs& inputs) {
  return inputs.arguments.given("to_world") ? inputs.arguments.transform("to_world")
                                            : inputs.to_world;
}

std::unique_ptr<Light> with_finite_power(std::unique_ptr<Light> light, const LightInputs& inputs) {
  if (!light->traits().power.is_finite())
    throw Error(ErrorKind::input,
                fmt::format("the power of emitter '{}' overflows", inputs.arguments.info().name),
                "make it or the scene smaller", inputs.arguments.place());
  return light;
}

Parameter shadow_samples_parameter() {
  return integer_parameter("shadow_samples", 1,
                           "Maximum of shadow rays for a sample of this light. A quarter (4 to 16) "
                           "is traced first, the rest only if these disagree (penumbra). Each "
                           "deeper recursion level halves the number.")
      .range(1, 4096);
}

Parameter visible_parameter() {
  return boolean_parameter("visible", true,
                           "The camera sees the light itself. If false, the camera looks past it; "
                           "reflected, refracted and scattered rays still hit it.");
}

Parameter ignored_sampling_weight() {
  return ignored_parameter("sampling_weight", ParameterKind::number);
}

LightSample toward_point(const SurfacePoint& point, const Vec3f& reference) {
  LightSample result;
  const Vec3f to_light = point.position - reference;
  const float distance_sq = length_sq(to_light);
  if (!(distance_sq > 0)) return result;
  result.distance = std::sqrt(distance_sq);
  result.direction = to_light * (1.0f / result.distance);
  result.point = point;
  result.delta = result.only_sampled = true;
  return result;
}

SurfacePoint free_point(const Vec3f& position) {
  SurfacePoint point;
  point.position = position;
  point.ng = point.ns = Vec3f(0, 0, 0);
  point.uv = Vec2f(0, 0);
  return point;
}

float receiver_cosine(const LightQuery& query, const Vec3f& direction) {
  if (query.normal == Vec3f(0, 0, 0)) return 1;
  const float cosine = dot(query.normal, direction);
  return cosine < -1e-4f ? 0.0f : std::clamp(cosine, minimum_receiver_cosine, 1.0f);
}

EmissionDisk::EmissionDisk(const Bounds3f& scene_bounds) {
  const bool empty = scene_bounds.isEmpty();
  if (!empty) center_ = center(scene_bounds);
  const float radius = empty ? 0.0f : bounding_radius(scene_bounds);
  // Some units in the last place of the coordinates, so that rounding leaves no corner outside.
  const float slack = 4e-6f * (radius + max_abs(center_));
  radius_ = std::max(radius + slack, 1e-10f);
}

Vec3f EmissionDisk::origin(const Vec3f& direction, const Vec2f& u) const {
  const Vec2f p = square_to_disk(u);
  return center_ + Frame(direction).to_world({p.x, p.y, -1.0f}) * radius_;
}

}  // namespace kaustik
