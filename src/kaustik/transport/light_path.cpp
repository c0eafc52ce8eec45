#include "kaustik/transport/light_path.h"

#include <algorithm>

namespace kaustik {

bool scatter_light_path(const SurfaceVertex& vertex, Lobes follow, LightPath& path) {
  path.sampler.start_vertex(uint32_t(path.path_class.events()));
  const Vec2f u = path.sampler.next_2d();
  const Vec2f u_choice = path.sampler.next_2d();
  const BsdfSample sample = vertex.sample(u_choice.x, u, follow);
  // Light that total reflection or perfect mirrors trap would never end.
  const float limit = path.path_class.events() < certain_events ? 1.0f : 0.95f;
  const float survival = std::min(limit, sample.weight.max_lane());
  if (sample.event == Lobes::none || !(u_choice.y < survival)) return false;
  path.state.throughput *= sample.weight * (1 / survival);
  path.state.pdf_forward = sample.event == Lobes::delta ? 0 : sample.pdf_solid_angle;
  path.state.depth += 1;
  path.path_class.add_event(sample.event);
  path.ray = spawn_ray(vertex.point(), sample.wi);
  return true;
}

}  // namespace kaustik
