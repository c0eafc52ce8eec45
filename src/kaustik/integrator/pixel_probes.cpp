#include "kaustik/integrator/pixel_probes.h"

#include "kaustik/base/parallel.h"
#include "kaustik/integrator/camera_walk.h"

namespace kaustik {
namespace {

constexpr int most_delta_events = 16;
/// Of the random numbers' addresses.
constexpr uint64_t probe_element = uint64_t(1) << 40;

PixelProbe look(const Scene& scene, const Vec2f& raster, uint64_t block) {
  Sampler sampler = Sampler::at(0, 0, Stream::training, probe_element + block, 0);
  SampleSink nowhere{ComponentSet()};
  CameraWalk walk(scene, raster, sampler, nowhere);
  PixelProbe probe;
  probe.raster = raster;
  while (walk.events() < most_delta_events && walk.advance()) {
    const SurfaceVertex& vertex = walk.vertex();
    if (walk.events() == 0) probe.distance = length(vertex.position() - scene.camera().position());
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

Spectrum PixelProbe::sent(const LightVertexData& photon, ComponentSet wanted) const {
  const Vec3f direction = photon.direction.unpack();
  Spectrum reflected;
  for (const Lobes lobe : {Lobes::diffuse, Lobes::glossy}) {
    if (!any(vertex.lobes() & lobe)) continue;
    CameraPathClass whole = path;
    whole.add_event(lobe);
    whole.add_event(photon.specular ? Lobes::glossy : Lobes::diffuse);
    if (wanted.has(whole.component())) reflected += vertex.eval(direction, lobe);
  }
  return reflected * photon.flux_spectrum();
}

std::vector<PixelProbe> make_pixel_probes(const Scene& scene, const PlanWindow& window,
                                          int block_size) {
  const Vec2i blocks = window.blocks(block_size);
  std::vector<PixelProbe> probes(size_t(blocks.x) * size_t(blocks.y));
  const Vec2f size(float(window.size.x), float(window.size.y));
  parallel_blocks(probes.size(), 16, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i) {
      const float x = (float(i % size_t(blocks.x)) + 0.5f) * float(block_size);
      const float y = (float(i / size_t(blocks.x)) + 0.5f) * float(block_size);
      const Vec2f raster(std::min(x, size.x - 0.5f), std::min(y, size.y - 0.5f));
      probes[i] = look(scene, window.in_crop(raster), i);
    }
  });
  return probes;
}

}  // namespace kaustik
