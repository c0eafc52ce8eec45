#include "kaustik/vcm/camera_path/weights.h"

#include "kaustik/transport/direct_light.h"

namespace kaustik {
namespace {

/// A point of `light` as emission sees it: its normal is on the side that shines to `direction`.
SurfacePoint shining(const Light& light, SurfacePoint point, const Vec3f& direction) {
  if (light.traits().is_two_sided && dot(point.ng, direction) < 0) {
    point.ng = -point.ng;
    point.ns = -point.ns;
  }
  return point;
}

}  // namespace

bool CameraPathWeights::path_tracing_alone() const {
  const Techniques& techniques = in_.techniques();
  if (!light_paths_ || !techniques.needs_light_paths()) return true;
  return vertices_.list().size() <= 1 && !(techniques.merging && vertices_.is_in_medium());
}

template <typename Where>
float CameraPathWeights::next_event_density(int light, const Where& where) const {
  if (vertices_.list().back().delta || !in_.techniques().next_event) return 0;
  return direct_light_pdf(in_.scene, vertices_.weighed_query(), LightChoice::one, light, where);
}

float CameraPathWeights::sampled(const Scatterer& vertex, const DirectLight& light) {
  const Techniques& techniques = in_.techniques();
  if (!techniques.next_event) return 0;
  if (path_tracing_alone()) {
    if (light.pdf_solid_angle == 0 || !techniques.unidirectional) return 1;
    return mis_weight(light.pdf_solid_angle * float(vertices_.light_samples()),
                      vertex.pdf(light.wi, Lobes::all));
  }
  const Light& of = *in_.scene.lights()[size_t(light.light)];
  const SurfacePoint origin = shining(of, light.on_light, -light.wi);
  const EmissionDensity emission =
      in_.emission.pdf(light.light, of.is_infinite() ? vertex.point() : origin, -light.wi);
  const float cosine = vertex.facing().factor(light.wi);
  const float distance_sq = of.is_infinite() ? 1.0f : sqr(light.distance);
  const float light_cosine = of.is_infinite() || of.traits().is_delta
                                 ? 1.0f
                                 : abs_dot(light.wi, of.placed().emitting_normal(origin));
  const float to_area = of.traits().is_delta ? 1.0f : light_cosine / distance_sq;
  PathVertex on_light;
  on_light.pdf_light = emission.endpoint > 0 ? emission.endpoint : 1.0f;
  PathHalves path = vertices_.halves();
  path.light = {&on_light, 1};
  path.pdf_light_last = emission.rest * cosine / distance_sq;
  path.pdf_light_before_last = vertices_.pdf_light_before(light.wi);
  path.pdf_camera_last =
      light.pdf_solid_angle == 0 ? 0.0f : vertex.pdf(light.wi, Lobes::all) * to_area;
  path.pdf_next_event = light.pdf_sampled * to_area;
  return in_.weights.next_event(path);
}

float CameraPathWeights::met(int light, const SurfaceVertex& vertex) {
  if (vertices_.empty()) return 1;
  if (!in_.techniques().unidirectional) return 0;
  const SurfacePoint& point = vertex.point();
  const float next_event = next_event_density(light, point);
  if (path_tracing_alone()) return met_weight_alone(next_event);
  const Vec3f direction = -vertex.wo();
  const float distance_sq = length_sq(point.position - vertices_.last_point().position);
  const SurfacePoint origin = shining(*in_.scene.lights()[size_t(light)], point, vertex.wo());
  const EmissionDensity emission = in_.emission.pdf(light, origin, vertex.wo());
  const PathVertex on_light = vertices_.next(point.position, {point.ng, 0});
  return met_weight(on_light, emission, vertices_.last_facing().factor(direction) / distance_sq,
                    next_event * abs_dot(direction, point.ng) / distance_sq);
}

float CameraPathWeights::met(int light, const Ray& ray) {
  if (vertices_.empty()) return 1;
  if (!in_.techniques().unidirectional) return 0;
  const float next_event = next_event_density(light, ray.direction);
  if (path_tracing_alone()) return met_weight_alone(next_event);
  const EmissionDensity emission = in_.emission.pdf(light, vertices_.last_point(), -ray.direction);
  return met_weight(vertices_.next_infinitely_far(), emission,
                    vertices_.last_facing().factor(ray.direction), next_event);
}

float CameraPathWeights::met_weight_alone(float next_event) const {
  if (!(next_event > 0)) return 1;
  return mis_weight(vertices_.pdf_of_way(), next_event * float(vertices_.light_samples_before()));
}

float CameraPathWeights::met_weight(const PathVertex& on_light, const EmissionDensity& emission,
                                    float to_last, float next_event) {
  return vertices_.with(on_light, [&](PathHalves path) {
    path.pdf_light_last = emission.endpoint > 0 ? emission.endpoint : 1.0f;
    path.pdf_light_before_last = emission.rest * to_last;
    path.pdf_next_event = next_event;
    return in_.weights.unidirectional(path);
  });
}

}  // namespace kaustik
