#include "kaustik/integrator/ray_tracing.h"

#include "kaustik/transport/integrator_parameters.h"

namespace kaustik {
namespace {

std::vector<Parameter> ray_tracing_parameters() {
  std::vector<Parameter> rows = LocalLight::parameters();
  rows.insert(rows.begin(), {components_parameter(), max_depth_parameter()});
  rows.push_back(
      integer_parameter("rr_depth", 5,
                        "Number of successive mirrors and refractions at which both ways are "
                        "followed. After that, chance chooses one way, with Russian roulette.")
          .range(0, 16));
  return rows;
}

/// The ends of the numbers that choose a lobe: where a surface both reflects and transmits, they
/// choose one each.
constexpr float first_lobe = 0, last_lobe = one_minus_epsilon;

}  // namespace

const TypeInfo& RayTracing::info() {
  static const TypeInfo info{"integrator", "raytracing",
                             "Classical recursive ray tracing: direct light, perfect mirrors and "
                             "refraction, ambient light.",
                             ray_tracing_parameters()};
  return info;
}

RayTracing::RayTracing(const Arguments& arguments, const Scene& scene)
    : IlluminationModel(scene),
      light_(arguments),
      maximum_events_(read_maximum_events(arguments)),
      roulette_depth_(int(arguments.integer("rr_depth"))) {
  traits_.components = read_components(arguments);
  traits_.default_samples_per_pass = 16;
}

bool RayTracing::reflect(const PassState&, CameraWalk& walk, const RadianceTracer& tracer) const {
  if (walk.events() >= maximum_events_) return false;
  light_.add_to(walk, Lobes::diffuse | Lobes::glossy);
  if (!any(walk.vertex().lobes() & Lobes::delta)) return false;
  return walk.events() < roulette_depth_ ? follow_both_ways(walk, tracer) : follow_one_way(walk);
}

bool RayTracing::follow_both_ways(CameraWalk& walk, const RadianceTracer& tracer) const {
  const auto chance = [&](float u_lobe) {
    const BsdfSample sample = walk.vertex().sample(u_lobe, {0, 0}, Lobes::delta);
    return sample.event == Lobes::none ? 0 : sample.pdf_solid_angle;
  };
  const float first = chance(first_lobe), last = chance(last_lobe);
  if (first == 1 || last == 1)
    return walk.scatter(Lobes::delta, 1, first == 1 ? first_lobe : last_lobe, {0, 0});
  // There is a third way, or one that is absorbed.
  if (std::fabs(first + last - 1) > 1e-4f) return follow_one_way(walk);
  Sampler sampler = walk.sampler().split(Split::specular_ray, 0);
  CameraWalk branch(walk, sampler);
  if (branch.scatter(Lobes::delta, 1 / first, first_lobe, {0, 0})) tracer.follow(branch);
  return walk.scatter(Lobes::delta, 1 / last, last_lobe, {0, 0});
}

bool RayTracing::follow_one_way(CameraWalk& walk) const {
  const Vec2f u = walk.sampler().next_2d(), u_choice = walk.sampler().next_2d();
  if (!walk.scatter(Lobes::delta, 1, u_choice.x, u)) return false;
  return walk.events() <= roulette_depth_ || walk.survive(u_choice.y);
}

}  // namespace kaustik
