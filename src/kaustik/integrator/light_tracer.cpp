#include "kaustik/integrator/light_tracer.h"

#include <atomic>

#include "kaustik/base/parallel.h"
#include "kaustik/transport/camera_splats.h"
#include "kaustik/transport/integrator_parameters.h"

namespace kaustik {

struct LightTracer::Counts {
  uint64_t rays = 0, splats = 0;
};

const TypeInfo& LightTracer::info() {
  static const TypeInfo info{
      "integrator",
      "lighttracer",
      "Unbiased light paths, splatted to the camera. It finds caustics of small lamps, but nothing "
      "in mirrors, behind glass or beyond the scene.",
      {components_parameter(), max_depth_parameter(),
       ignored_parameter("rr_depth", ParameterKind::integer), aim_parameter(),
       hide_emitters_parameter()}};
  return info;
}

LightTracer::LightTracer(const Arguments& arguments, const Scene& scene)
    : scene_(scene), maximum_events_(read_maximum_events(arguments)), emission_(scene) {
  if (!scene.camera().traits().can_connect)
    throw Error(ErrorKind::input,
                "the lighttracer connects light paths to the camera, and none can be to a meter",
                "use another integrator, such as auto or path", arguments.place());
  traits_ = {.splats = true, .samples_camera = false, .components = read_components(arguments)};
  for (const auto& light : scene.lights()) powers_.push_back(light->traits().power.sum());
  const Aim aim = read_aim(arguments.text("aim"));
  if (aim == Aim::none || !traits_.components.has(Component::caustic)) return;
  aimed_emission_.emplace(scene, Lobes::specular, default_target_budget, aim);
  if (aimed_emission_->target_count() == 0) aimed_emission_.reset();
}

std::vector<LightTracer::Job> LightTracer::jobs(uint32_t total) const {
  ComponentSet caustics, others;
  for (int i = 0; i < component_count; ++i) {
    const auto component = Component(i);
    if (!traits_.components.has(component)) continue;
    (component == Component::caustic && aimed_emission_ ? caustics : others).add(component);
  }
  // Half and half: neither kind is noisier than it would be with twice the time.
  uint32_t aimed = 0;
  if (!caustics.empty() && maximum_events_ > 1)
    aimed = others.empty() ? total : std::max(1u, total / 2);
  std::vector<Job> list;
  const auto add = [&](uint32_t count, const ComponentSet& wanted, bool is_aimed) {
    if (wanted.empty()) return;
    const std::vector<uint32_t> shares = share_photons(std::max(1u, count), powers_, powers_);
    for (size_t light = 0; light < shares.size(); ++light)
      if (shares[light] > 0) list.push_back({int(light), is_aimed, shares[light], wanted});
  };
  if (aimed > 0) add(aimed, caustics, true);
  add(total - aimed, others, false);
  return list;
}

std::unique_ptr<PassState> LightTracer::prepare(const Pass& pass, SplatBuffer& splats,
                                                std::stop_token stop,
                                                const ProgressFunction& progress) const {
  auto state = std::make_unique<PassState>();
  const Vec2i size = scene_.film().crop_size;
  const uint64_t wanted = uint64_t(size.x) * uint64_t(size.y) * pass.samples_per_pixel;
  const auto total = uint32_t(std::min<uint64_t>(wanted, 0x7fffffffu));
  std::atomic<uint64_t> rays{0}, hits{0};
  WorkCounter counter(total, progress);
  for (const Job& job : jobs(total))
    parallel_blocks(job.count, 1024, [&](size_t begin, size_t end, size_t) {
      if (stop.stop_requested()) return;
      const Counts counts = trace_block(pass, job, uint32_t(begin), uint32_t(end), splats);
      rays += counts.rays;
      hits += counts.splats;
      counter.add(end - begin);
    });
  state->report.rays = rays;
  state->report.photons = hits;
  return state;
}

LightTracer::Counts LightTracer::trace_block(const Pass& pass, const Job& job, uint32_t begin,
                                             uint32_t end, SplatBuffer& splats) const {
  const LightPathLimits limits{std::max(0, maximum_events_ - 1), Lobes::specular,
                               job.aimed ? MediumEvents::stop : MediumEvents::follow};
  const EmissionSampler& emission = job.aimed ? *aimed_emission_ : emission_;
  CameraSplats camera(scene_, job.wanted, job.count, splats);
  const auto emit = [&](uint32_t i) -> std::optional<LightPath> {
    const uint64_t element = uint64_t(job.light) * 2 + (job.aimed ? 1 : 0);
    // Sets follow one another from one by chance on: of few paths each is as likely to have any.
    const auto first_set = uint32_t(hash_mix(hash_mix(pass.seed, pass.index), element) >> 32);
    const Wavelengths& wavelengths = pass.wavelengths[pass.wavelengths.of_sample(first_set, i)];
    Sampler sampler = Sampler::at(pass.seed, pass.index, Stream::light_path, element, i);
    const Vec2f u_position = sampler.next_2d(), u_direction = sampler.next_2d();
    const EmittedRay emitted =
        emission.sample(job.light, u_position, u_direction, sampler.next_1d(), wavelengths);
    if (emitted.on_surface)
      camera.show_lamp(job.light, emitted.origin, emitted.pdf_position, {wavelengths, sampler});
    if (emitted.flux.is_zero() || maximum_events_ < 1) return std::nullopt;
    return LightPath(emitted.ray, emitted.flux, scene_.light_medium(job.light), Lobes::specular,
                     sampler, wavelengths);
  };
  const auto in_full = [](const auto&...) { return 1.0f; };
  const auto see = [&](const LightVertex& at) {
    camera.show(at, in_full);
    // Only specular events lead from the lamp to a caustic.
    return job.aimed ? at.vertex.lobes() & Lobes::specular : Lobes::all;
  };
  const auto see_in_medium = [&](const LightMediumVertex& at) { camera.show(at, in_full); };
  const LightPathCounts paths =
      trace_light_paths(scene_, begin, end, limits, emit, Handlers{see, see_in_medium});
  return {paths.rays + camera.rays(), camera.shown()};
}

}  // namespace kaustik
