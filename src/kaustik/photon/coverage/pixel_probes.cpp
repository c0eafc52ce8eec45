#include "kaustik/photon/coverage/pixel_probes.h"

#include "kaustik/base/parallel.h"
#include "kaustik/transport/camera_walk.h"

namespace kaustik {
namespace {

constexpr int most_delta_events = 16;

PixelProbe look(const Scene& scene, const Vec2f& raster, uint64_t block) {
  Sampler sampler = Sampler::at(0, 0, Stream::pixel_probe, block, 0);
  SampleSink nowhere{ComponentSet()};
  CameraWalk walk(scene, raster, sampler, nowhere);
  PixelProbe probe;
  probe.raster = raster;
  while (walk.events() < most_delta_events && walk.advance()) {
    const SurfaceVertex& vertex = walk.vertex();
    if (walk.events() == 0)
      probe.distance = length(vertex.position() - scene.camera().traits().position);
    if (any(vertex.lobes() & (Lobes::diffuse | Lobes::glossy))) {
      probe.found = true;
      probe.vertex = vertex;
      probe.pixel_width = 2 * walk.footprint().width;
      probe.path = walk.path_class();
      break;
    }
    const Vec2f u = sampler.next_2d();
    if (!walk.scatter(Lobes::delta, 1, sampler.next_1d(), u)) break;
  }
  return probe;
}

}  // namespace

std::vector<PixelProbe> make_pixel_probes(const Scene& scene, const BlockGrid& grid) {
  std::vector<PixelProbe> probes(grid.size());
  parallel_blocks(probes.size(), 16, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i)
      probes[i] = look(scene, grid.window().in_crop(grid.middle(i)), i);
  });
  return probes;
}

}  // namespace kaustik
