#include "kaustik/integrator/path.h"

#include "kaustik/transport/integrator_parameters.h"

namespace kaustik {

const TypeInfo& PathIntegrator::info() {
  static const TypeInfo info{
      "integrator",
      "path",
      "Unbiased path tracing with light sampling and multiple importance sampling.",
      {components_parameter(), max_depth_parameter(), rr_depth_parameter(),
       hide_emitters_parameter(), ignored_parameter("strict_normals", ParameterKind::boolean),
       ignored_parameter("samples_per_pass", ParameterKind::integer)}};
  return info;
}

PathIntegrator::PathIntegrator(const Arguments& arguments, const Scene& scene)
    : IlluminationModel(scene),
      maximum_events_(read_maximum_events(arguments)),
      roulette_depth_(int(arguments.integer("rr_depth"))) {
  traits_.components = read_components(arguments);
  traits_.default_samples_per_pass = 16;
}

bool PathIntegrator::advance(const PassState&, CameraWalk& walk) const {
  for (;;) {
    const CameraWalk::Arrival arrival = walk.fly();
    if (arrival != CameraWalk::Arrival::medium) return arrival == CameraWalk::Arrival::surface;
    if (walk.events() >= maximum_events_) return false;
    walk.add_medium_light();
    walk.scatter_in_medium(walk.sampler().next_2d());
    if (!goes_on(walk, walk.sampler().next_1d())) return false;
  }
}

bool PathIntegrator::goes_on(CameraWalk& walk, float u) const {
  if (!walk.may_find_more()) return false;
  return walk.events() <= roulette_depth_ || walk.survive(u);
}

bool PathIntegrator::reflect(const PassState&, CameraWalk& walk, const RadianceTracer&) const {
  if (walk.events() >= maximum_events_) return false;
  const float diffuse = diffuse_probability(walk.vertex());
  walk.add_direct_light(diffuse, 1 - diffuse);
  const Vec2f u = walk.sampler().next_2d();
  Vec2f u_choice = walk.sampler().next_2d();
  const LobeChoice choice = choose_lobes(walk.vertex(), u_choice.x);
  if (!walk.scatter(choice.lobes, choice.probability, u_choice.x, u)) return false;
  return goes_on(walk, u_choice.y);
}

}  // namespace kaustik
