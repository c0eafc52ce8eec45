#include "kaustik/transport/light_path.h"

#include <algorithm>

namespace kaustik {
namespace {

/// Russian roulette by the share that is left of what was emitted, not by the event's weight alone:
/// that would make flux grow without end where weights alternate about one, as those of bent
/// normals do (Veach 1997, eq. 5.19) when water reflects light totally time and again. And by the
/// path's length. False if the path ends; attenuates it otherwise.
bool survive(LightPath& path, const Spectrum& event_weight, float u) {
  const float by_weight = std::min(1.0f, (path.weight * event_weight).max_lane());
  const float by_length = length_survival(path.path_class.events());
  if (!(u < by_weight * by_length)) return false;
  path.attenuate(event_weight * (1 / by_weight));
  path.state.throughput *= 1 / by_length;
  return true;
}

/// With the weight and the density of those that are not guided.
BsdfSample sample_direction(const SurfaceVertex& vertex, Lobes follow,
                            const ScatterGuide::Place& place, const Vec2f& u, float u_choice) {
  const float guided = place.guided();
  if (!(u_choice < guided))
    return vertex.sample(std::min((u_choice - guided) / (1 - guided), one_minus_epsilon), u,
                         follow);
  BsdfSample sample;
  sample.wi = place.sample(u_choice, u);
  sample.pdf_solid_angle = vertex.pdf(sample.wi, follow);
  if (!(sample.pdf_solid_angle > 0)) return {};
  sample.weight = vertex.eval_cosine(sample.wi, follow) * (1 / sample.pdf_solid_angle);
  sample.event = Lobes::diffuse;
  return sample;
}

}  // namespace

bool scatter_light_path(const SurfaceVertex& vertex, Lobes follow, const LightPathLimits& limits,
                        LightPath& path) {
  const Vec2f u = path.sampler.next_2d();
  const Vec2f u_choice = path.sampler.next_2d();
  const bool may_be_guided = limits.guide && follow == Lobes::all;
  const ScatterGuide::Place place =
      may_be_guided ? limits.guide->place(vertex, vertex.wo()) : ScatterGuide::Place();
  const BsdfSample sample = sample_direction(vertex, follow, place, u, u_choice.x);
  if (sample.event == Lobes::none || !survive(path, sample.weight, u_choice.y)) return false;
  path.state.pdf_unguided = sample.event == Lobes::delta ? 0 : sample.pdf_solid_angle;
  path.state.pdf_forward = place.pdf(path.state.pdf_unguided, sample.wi);
  if (place.guided() > 0) path.state.throughput *= path.state.pdf_unguided / path.state.pdf_forward;
  if (const float weight = path.weight.max_lane(); weight > limits.largest_weight)
    path.attenuate(Spectrum(limits.largest_weight / weight));
  if (limits.needs_reverse_pdf)
    path.state.pdf_reverse =
        sample.event == Lobes::delta ? 0 : vertex.pdf_reverse(sample.wi, follow);
  path.path_class.add_event(sample.event);
  leave(vertex, sample, path.state.pdf_forward, path.state, path.ray);
  path.distance = 0;
  return true;
}

LightMediumVertex medium_vertex(const LightPath& path, const Medium::Flight& flight) {
  LightMediumVertex vertex{.position = {0, 0, 0},
                           .wo = -path.ray.direction,
                           .medium = *path.state.medium,
                           .flux = {},
                           .path_class = path.path_class,
                           .distance = 0,
                           .state = path.state,
                           .path = path.index,
                           .sampler = path.sampler};
  if (!flight.scattered) return vertex;
  vertex.position = path.ray.origin + path.ray.direction * flight.distance;
  vertex.flux = path.state.throughput * flight.weight;
  vertex.distance = path.distance + flight.distance;
  return vertex;
}

LightMediumVertex sample_medium_vertex(LightPath& path, float limit) {
  return medium_vertex(path, path.state.medium->sample_collision(
                                 {path.ray.origin, path.ray.direction, limit},
                                 path.state.throughput, path.state.wavelengths, path.sampler));
}

MediumFate scatter_in_medium(LightPath& path, const Medium::Flight& flight,
                             const LightPathLimits& limits) {
  const Medium& medium = *path.state.medium;
  const bool follow =
      limits.in_media == MediumEvents::follow ||
      (limits.in_media == MediumEvents::after_events && path.path_class.events() > 0);
  if (!follow) return MediumFate::stopped;
  if (path.path_class.events() >= limits.maximum_events) return MediumFate::too_long;
  const Vec2f u = path.sampler.next_2d();
  if (!survive(path, flight.weight, path.sampler.next_1d())) return MediumFate::absorbed;
  const Vec3f wo = -path.ray.direction;
  const Vec3f wi = medium.phase().sample(wo, u);
  path.state.pdf_forward = path.state.pdf_reverse = medium.phase().eval(wo, wi);
  path.state.pdf_unguided = path.state.pdf_forward;
  path.state.footprint.travel(flight.distance);
  path.state.footprint.scatter(Lobes::diffuse, path.state.pdf_forward);
  path.state.depth += 1;
  path.path_class.add_medium_event();
  path.ray = {path.ray.origin + path.ray.direction * flight.distance, wi, infinity};
  path.distance = 0;
  return MediumFate::scattered;
}

}  // namespace kaustik
