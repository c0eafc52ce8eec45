#include "kaustik/photon/coverage/pixel_probes.h"

#include <algorithm>
#include <cstddef>

#include "kaustik/base/parallel.h"
#include "kaustik/transport/camera_walk.h"

namespace kaustik {
namespace {

constexpr int most_delta_events = 16;

/// By ray `index` of several.
PixelProbe look(const Scene& scene, const Vec2f& raster, uint64_t block, uint32_t index) {
  Sampler sampler = Sampler::at(0, 0, Stream::pixel_probe, block, index);
  SampleSink nowhere{ComponentSet()};
  CameraWalk walk(scene, raster, sampler, nowhere);
  const Vec3f origin = walk.ray().origin;
  const float cut_off = walk.distance();
  PixelProbe probe;
  probe.raster = raster;
  while (walk.events() < most_delta_events && walk.advance()) {
    const SurfaceVertex& vertex = walk.vertex();
    if (walk.events() == 0) {
      const float parallel = scene.camera().traits().parallel_distance;
      probe.distance = parallel > 0 ? parallel : cut_off + length(vertex.position() - origin);
    }
    if (any(vertex.lobes() & (Lobes::diffuse | Lobes::glossy))) {
      probe.found = true;
      probe.vertex = vertex;
      probe.pixel_width = 2 * walk.footprint().width;
      probe.path = walk.path_class();
      probe.gauge = walk.gauge();
      if (probe.gauge >= 0) probe.distance = scene.gauges()[size_t(probe.gauge)].distance_around;
      break;
    }
    const Vec2f u = sampler.next_2d();
    if (!walk.scatter(Lobes::delta, 1, sampler.next_1d(), u)) break;
  }
  return probe;
}

/// Every pixel of a meter sees all that it sees: what stands for that is what is in the middle of
/// several by the width of a pixel there.
PixelProbe look_around(const Scene& scene, const Vec2f& raster, uint64_t block) {
  constexpr uint32_t rays = 31;
  std::vector<PixelProbe> found;
  PixelProbe last;
  for (uint32_t i = 0; i < rays; ++i) {
    last = look(scene, raster, block, i);
    if (last.found) found.push_back(last);
  }
  if (found.empty()) return last;
  const auto middle = found.begin() + std::ptrdiff_t(found.size() / 2);
  std::nth_element(
      found.begin(), middle, found.end(),
      [](const PixelProbe& a, const PixelProbe& b) { return a.pixel_width < b.pixel_width; });
  return *middle;
}

}  // namespace

std::vector<PixelProbe> make_pixel_probes(const Scene& scene, const BlockGrid& grid) {
  const CameraTraits& camera = scene.camera().traits();
  const bool is_meter = !camera.can_connect && !camera.are_pixels_apart();
  std::vector<PixelProbe> probes(grid.size());
  parallel_blocks(probes.size(), 16, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i) {
      const Vec2f raster = grid.window().in_crop(grid.middle(i));
      probes[i] = is_meter ? look_around(scene, raster, i) : look(scene, raster, i, 0);
    }
  });
  return probes;
}

}  // namespace kaustik
