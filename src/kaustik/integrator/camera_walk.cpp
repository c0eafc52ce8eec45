#include "kaustik/integrator/camera_walk.h"

namespace kaustik {
namespace {

FirstHit describe_first_hit(const SurfaceVertex& vertex, float distance) {
  FirstHit first;
  first.albedo = vertex.albedo(Lobes::all);
  first.normal = vertex.facing_normal();
  first.depth = distance;
  return first;
}

/// Light sampled at `vertex` and reflected by `lobes`, weighted against sampling those lobes.
Spectrum reflected(const SurfaceVertex& vertex, const DirectLight& light, Lobes lobes,
                   float lobe_probability) {
  if (!any(vertex.lobes() & lobes)) return {};
  const Spectrum f = vertex.eval_cosine(light.wi, lobes);
  if (f.is_zero()) return {};
  if (light.pdf_solid_angle == 0 || lobe_probability == 0) return f * light.radiance;
  return f * light.radiance *
         mis_weight(light.pdf_solid_angle, lobe_probability * vertex.pdf(light.wi, lobes));
}

}  // namespace

CameraWalk::CameraWalk(const Scene& scene, const Vec2f& raster, Sampler& sampler, SampleSink& sink,
                       Lobes traced)
    : scene_(scene),
      sampler_(sampler),
      sink_(sink),
      class_(traced),
      ray_(scene.camera().sample_ray(raster)) {
  state_.spread = scene.camera().pixel_spread();
}

CameraWalk::CameraWalk(const CameraWalk& other, Sampler& sampler)
    : scene_(other.scene_),
      sampler_(sampler),
      sink_(other.sink_),
      state_(other.state_),
      class_(other.class_),
      light_choice_(other.light_choice_),
      ray_(other.ray_),
      vertex_(other.vertex_),
      previous_(other.previous_),
      distance_(other.distance_) {}

bool CameraWalk::advance() {
  Hit hit;
  ++rays_;
  if (!scene_.intersect(ray_, hit)) {
    add_background();
    return false;
  }
  distance_ += hit.t;
  state_.footprint = distance_ * state_.spread;
  vertex_.meet(scene_, ray_, hit, TransportMode::radiance);
  if (state_.depth == 0) sink_.set_first_hit(describe_first_hit(vertex_, hit.t));
  if (vertex_.light() >= 0) add_emission();
  sampler_.start_vertex(uint32_t(state_.depth));
  return true;
}

/// Weight of light found by the last event against sampling it (a point of an area light or a
/// direction) from the previous vertex.
template <typename Where>
float CameraWalk::emission_weight(int light, const Where& where) const {
  if (state_.pdf_forward == 0) return 1;
  return mis_weight(state_.pdf_forward,
                    direct_light_pdf(scene_, previous_, light_choice_, light, where));
}

void CameraWalk::add_emission() {
  const Light& light = *scene_.lights()[size_t(vertex_.light())];
  const Spectrum emitted = light.emitted(vertex_.point(), vertex_.wo());
  if (emitted.is_zero()) return;
  sink_.add(class_.component(),
            state_.throughput * emitted * emission_weight(vertex_.light(), vertex_.point()));
}

void CameraWalk::add_background() {
  for (const int index : scene_.environment_lights()) {
    const Light& light = *scene_.lights()[size_t(index)];
    if (light.is_delta() || (light.is_only_seen() && state_.pdf_forward > 0)) continue;
    sink_.add(class_.component(), state_.throughput * light.background(ray_.direction) *
                                      emission_weight(index, ray_.direction));
  }
}

void CameraWalk::add_direct_light(float diffuse_probability, float glossy_probability,
                                  const LightSampling& sampling, const LightRules& rules) {
  light_choice_ = sampling.choice;
  if (!any(vertex_.lobes() & (Lobes::diffuse | Lobes::glossy))) return;
  // What nobody wants costs no shadow ray; its random numbers are drawn, so that the others stay.
  const auto wanted = [&](Lobes lobe) { return sink_.wants(class_.component_after(lobe)); };
  const auto take = [&](const DirectLight& light) {
    Spectrum by_diffuse, by_glossy;
    if (wanted(Lobes::diffuse))
      by_diffuse = reflected(vertex_, light, Lobes::diffuse, diffuse_probability);
    if (wanted(Lobes::glossy))
      by_glossy = reflected(vertex_, light, Lobes::glossy, glossy_probability);
    if (by_diffuse.is_zero() && by_glossy.is_zero()) return;
    LightSight seen;
    if (!rules.shadows)
      seen = {1, 0};
    else if (rules.sight)
      seen = rules.sight->of(light.light);
    float factor = seen.known;
    if (seen.by_ray > 0) {
      ++rays_;
      if (!scene_.occluded(light.shadow_ray)) factor += seen.by_ray;
    }
    if (!(factor > 0)) return;
    if (rules.classical_attenuation)
      factor *= scene_.lights()[size_t(light.light)]->classical_attenuation(vertex_.position());
    add_reflected(Lobes::diffuse, by_diffuse * factor);
    add_reflected(Lobes::glossy, by_glossy * factor);
  };
  sample_direct_lights(scene_, vertex_, sampling, sampler_, take);
}

bool CameraWalk::scatter(Lobes lobes, float probability, float u_lobe, const Vec2f& u) {
  const BsdfSample sample = vertex_.sample(u_lobe, u, lobes);
  if (sample.event == Lobes::none || sample.weight.is_zero()) return false;
  state_.throughput *= sample.weight * (1 / probability);
  // Roulette must not see that this is one of several branches.
  state_.roulette_scale *= sqr(sample.eta) * std::max(1.0f, probability);
  state_.pdf_forward = sample.event == Lobes::delta ? 0 : probability * sample.pdf_solid_angle;
  state_.depth += 1;
  class_.add_event(sample.event);
  previous_ = vertex_;
  ray_ = spawn_ray(vertex_.point(), sample.wi);
  return true;
}

bool CameraWalk::survive(float u) {
  // By the square root of the throughput: longer paths for less variance, by a tenth at equal time
  // in a room of bright walls.
  const float survival =
      std::min(0.95f, std::sqrt(state_.throughput.max_lane() * state_.roulette_scale));
  if (!(u < survival)) return false;
  state_.throughput *= 1 / survival;
  return true;
}

}  // namespace kaustik
