#include "kaustik/scene/gauges.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kaustik/base/parallel.h"
#include "kaustik/base/warp.h"
#include "kaustik/scene/media.h"

namespace kaustik {
namespace {

/// Of the scene's size: a gauge that is so near to a surface lies on it, and is lifted so high.
constexpr float nearness = 1e-5f, lift = 2e-6f;
constexpr size_t looks = 64;

SurfacePoint point_of(const Scene& scene, const Gauge& gauge, float size) {
  SurfacePoint point;
  point.position = gauge.position;
  point.error = 8 * float_rounding * max_abs(gauge.position);
  if (const float near = nearness * size; near > 0) {
    const Ray ray{gauge.position + gauge.normal * near, -gauge.normal, 2 * near};
    Hit hit;
    if (scene.tracer().intersect(ray, hit))
      point.position =
          scene.tracer().surface_point(ray, hit).position + gauge.normal * (lift * size);
  }
  point.ng = point.ns = gauge.normal;
  return point;
}

/// Median of the distances to what lies around on that side, by the cosine; where nothing does it
/// counts as `size` away.
float distance_around(const Scene& scene, const SurfacePoint& point, float size) {
  const Frame frame(point.ng);
  std::array<float, looks> distances;
  for (size_t i = 0; i < looks; ++i) {
    const Vec3f way = frame.to_world(square_to_cosine_hemisphere(
        {(float(i) + 0.5f) / looks, std::fmod(float(i) * 0.61803399f + 0.1f, 1.0f)}));
    Hit hit;
    distances[i] = scene.tracer().intersect(spawn_ray(point, way), hit) ? hit.t : size;
  }
  std::nth_element(distances.begin(), distances.begin() + looks / 2, distances.end());
  return distances[looks / 2];
}

}  // namespace

std::vector<PlacedGauge> place_gauges(const Scene& scene) {
  const std::vector<Gauge>& gauges = scene.camera().gauges();
  const Bounds3f box = scene.tracer().bounds();
  const float size = box.isEmpty() ? 0.0f : length(box.size());
  std::vector<PlacedGauge> placed(gauges.size());
  parallel_blocks(gauges.size(), 16, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i) {
      PlacedGauge& one = placed[i];
      one.point = point_of(scene, gauges[i], size);
      one.distance_around = distance_around(scene, one.point, size > 0 ? size : 1.0f);
      if (scene.has_media()) one.medium = find_medium(scene, one.point, scene.camera_medium());
    }
  });
  return placed;
}

}  // namespace kaustik
