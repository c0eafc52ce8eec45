#include "kaustik/integrator/path.h"

#include "kaustik/integrator/camera_walk.h"
#include "kaustik/integrator/path_parameters.h"

namespace kaustik {

const TypeInfo& PathIntegrator::info() {
  static const TypeInfo info{
      "integrator",
      "path",
      "Unbiased path tracing with light sampling and multiple importance sampling.",
      {components_parameter(), max_depth_parameter(), rr_depth_parameter(),
       ignored_parameter("hide_emitters", ParameterKind::boolean)}};
  return info;
}

PathIntegrator::PathIntegrator(const Arguments& arguments, const Scene& scene)
    : scene_(scene),
      components_(read_components(arguments)),
      maximum_events_(read_maximum_events(arguments)),
      roulette_depth_(int(arguments.integer("rr_depth"))) {}

std::unique_ptr<PassState> PathIntegrator::prepare(const Pass&, SplatBuffer&, std::stop_token,
                                                   const ProgressFunction&) const {
  return std::make_unique<PassState>();
}

void PathIntegrator::sample(const PassState&, const Vec2f& raster, Sampler& sampler,
                            SampleSink& sink) const {
  CameraWalk walk(scene_, raster, sampler, sink);
  while (walk.advance() && walk.events() < maximum_events_) {
    const float diffuse = diffuse_probability(walk.vertex());
    walk.add_direct_light(diffuse, 1 - diffuse);
    const Vec2f u = sampler.next_2d();
    Vec2f u_choice = sampler.next_2d();
    const LobeChoice choice = choose_lobes(walk.vertex(), u_choice.x);
    if (!walk.scatter(choice.lobes, choice.probability, u_choice.x, u)) return;
    if (!walk.may_find_more()) return;
    if (walk.events() > roulette_depth_ && !walk.survive(u_choice.y)) return;
  }
}

}  // namespace kaustik
