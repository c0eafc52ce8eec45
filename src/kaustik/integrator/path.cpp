#include "kaustik/integrator/path.h"

#include "kaustik/integrator/camera_path.h"
#include "kaustik/transport/direct_light.h"
#include "kaustik/transport/path_class.h"
#include "kaustik/transport/path_state.h"

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

std::unique_ptr<PassState> PathIntegrator::prepare(const Pass&, SplatBuffer&,
                                                   std::stop_token) const {
  return std::make_unique<PassState>();
}

/// One path from the camera.
class PathIntegrator::Walk {
 public:
  Walk(const PathIntegrator& integrator, Sampler& sampler, SampleSink& sink)
      : scene_(integrator.scene_), integrator_(integrator), sampler_(sampler), sink_(sink) {}

  void run(Ray ray) {
    for (int events = 0;; ++events) {
      Hit hit;
      ++rays_;
      if (!scene_.intersect(ray, hit)) {
        add_background(ray.direction);
        break;
      }
      const SurfaceVertex vertex(scene_, ray, hit, TransportMode::radiance);
      if (events == 0) sink_.set_first_hit(describe_first_hit(vertex, hit.t));
      if (vertex.light() >= 0) add_emission(vertex);
      if (events >= integrator_.maximum_events_) break;
      sampler_.start_vertex(uint32_t(events));
      if (any(vertex.lobes() & (Lobes::diffuse | Lobes::glossy))) add_direct_light(vertex);
      if (!scatter(vertex, events, ray)) break;
    }
    sink_.count_rays(rays_);
  }

 private:
  /// Weight of light found by the last event against sampling it (a point of an area light or a
  /// direction) from the previous vertex.
  template <typename Where>
  float emission_weight(int light, const Where& where) const {
    if (state_.pdf_forward == 0) return 1;
    return mis_weight(state_.pdf_forward, direct_light_pdf(scene_, previous_, light, where));
  }

  void add_emission(const SurfaceVertex& vertex) {
    const Light& light = *scene_.lights()[size_t(vertex.light())];
    const Spectrum emitted = light.emitted(vertex.point(), vertex.wo());
    if (emitted.is_zero()) return;
    const float weight = emission_weight(vertex.light(), vertex.point());
    sink_.add(class_.component(), state_.throughput * emitted * weight);
  }

  void add_background(const Vec3f& direction) {
    for (const int index : scene_.environment_lights()) {
      const Light& light = *scene_.lights()[size_t(index)];
      if (light.is_delta()) continue;
      const float weight = emission_weight(index, direction);
      sink_.add(class_.component(), state_.throughput * light.background(direction) * weight);
    }
  }

  void add_direct_light(const SurfaceVertex& vertex) {
    DirectLight light;
    if (!sample_direct_light(scene_, vertex, sampler_, light)) return;
    const float diffuse = diffuse_probability(vertex);
    const Spectrum by_diffuse = reflected(vertex, light, Lobes::diffuse, diffuse);
    const Spectrum by_glossy = reflected(vertex, light, Lobes::glossy, 1 - diffuse);
    if (by_diffuse.is_zero() && by_glossy.is_zero()) return;
    ++rays_;
    if (scene_.occluded(light.shadow_ray)) return;
    sink_.add(class_.component_after(Lobes::diffuse), state_.throughput * by_diffuse);
    sink_.add(class_.component_after(Lobes::glossy), state_.throughput * by_glossy);
  }

  /// Light sampled at `vertex` and reflected by `lobes`, weighted against sampling those lobes.
  static Spectrum reflected(const SurfaceVertex& vertex, const DirectLight& light, Lobes lobes,
                            float lobe_probability) {
    if (!any(vertex.lobes() & lobes)) return {};
    const Spectrum f = vertex.eval_cosine(light.wi, lobes);
    if (f.is_zero()) return {};
    const float weight =
        light.pdf_solid_angle == 0
            ? 1.0f
            : mis_weight(light.pdf_solid_angle, lobe_probability * vertex.pdf(light.wi, lobes));
    return f * light.radiance * weight;
  }

  bool scatter(const SurfaceVertex& vertex, int events, Ray& ray) {
    const Vec2f u = sampler_.next_2d();
    Vec2f u_choice = sampler_.next_2d();
    const LobeChoice choice = choose_lobes(vertex, u_choice.x);
    const BsdfSample sample = vertex.sample(u_choice.x, u, choice.lobes);
    if (sample.event == Lobes::none || sample.weight.is_zero()) return false;
    state_.throughput *= sample.weight * (1 / choice.probability);
    state_.eta_scale *= sqr(sample.eta);
    state_.pdf_forward =
        sample.event == Lobes::delta ? 0 : choice.probability * sample.pdf_solid_angle;
    class_.add_event(sample.event);
    if (events >= integrator_.roulette_depth_) {
      const float survival = std::min(0.95f, state_.throughput.max_lane() * state_.eta_scale);
      if (!(u_choice.y < survival)) return false;
      state_.throughput *= 1 / survival;
    }
    previous_ = vertex;
    ray = spawn_ray(vertex.point(), sample.wi);
    return true;
  }

  const Scene& scene_;
  const PathIntegrator& integrator_;
  Sampler& sampler_;
  SampleSink& sink_;
  PathState state_;
  CameraPathClass class_;
  SurfaceVertex previous_;
  uint64_t rays_ = 0;
};

void PathIntegrator::sample(const PassState&, const Vec2f& raster, Sampler& sampler,
                            SampleSink& sink) const {
  Walk(*this, sampler, sink).run(scene_.camera().sample_ray(raster));
}

}  // namespace kaustik
