#include "kaustik/photon/light_path_emission.h"

#include <algorithm>

namespace kaustik {
namespace {

/// Share of the rays that is aimed at specular objects where there are any.
constexpr float share_for_caustics = 0.5f;

/// Share of the light paths that all lights have alike, whatever their power: the brightest need
/// not be the one that is seen.
constexpr double even_share = 0.1;

}  // namespace

LightPathEmission::LightPathEmission(const Scene& scene, Aim aim)
    : scene_(scene),
      own_(scene),
      aimed_(scene, Lobes::specular, default_target_budget, aim),
      aimed_share_(aimed_.aimed() && aimed_.target_count() > 0 ? share_for_caustics : 0.0f) {
  double total = 0, emitting = 0;
  for (const auto& light : scene.lights()) {
    total += double(light->power().sum());
    emitting += light->power().sum() > 0 ? 1 : 0;
  }
  double sum = 0;
  for (const auto& light : scene.lights()) {
    const double power = double(light->power().sum());
    if (power > 0) sum += (1 - even_share) * power / total + even_share / emitting;
    const float before = cumulative_.empty() ? 0.0f : cumulative_.back();
    cumulative_.push_back(float(sum));
    // The chance that rounded sums give it.
    chance_.push_back(cumulative_.back() - before);
  }
}

LightPathStart LightPathEmission::sample(Sampler& sampler) const {
  LightPathStart start;
  const Vec2f u_position = sampler.next_2d(), u_direction = sampler.next_2d();
  Vec2f u = sampler.next_2d();
  const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), u.x);
  const auto light = size_t(found - cumulative_.begin());
  if (light >= chance_.size() || !(chance_[light] > 0)) return start;
  const bool aims = u.y < aimed_share_;
  if (aims) u.y = std::min(u.y / aimed_share_, one_minus_epsilon);
  const EmissionSampler& emission = aims ? aimed_ : own_;
  start.emitted = emission.sample(int(light), u_position, u_direction, u.y);
  EmittedRay& emitted = start.emitted;
  if (emitted.flux.is_zero()) return start;
  start.light = int(light);
  start.density = density(start.light, emitted.origin, emitted.ray.direction);
  const float joint = start.density.endpoint * start.density.rest;
  emitted.flux *= joint > 0 ? emitted.pdf_position * emitted.pdf_direction / joint : 0.0f;
  return start;
}

EmissionDensity LightPathEmission::pdf(int light, const SurfacePoint& origin,
                                       const Vec3f& direction) const {
  if (!(chance_[size_t(light)] > 0)) return {};
  return density(light, origin, direction);
}

EmissionDensity LightPathEmission::density(int light, const SurfacePoint& origin,
                                           const Vec3f& direction) const {
  const Light& of = *scene_.lights()[size_t(light)];
  float joint = (1 - aimed_share_) * own_.pdf(light, origin, direction);
  if (aimed_share_ > 0) joint += aimed_share_ * aimed_.pdf(light, origin, direction);
  EmissionDensity result;
  if (of.is_delta())
    result.endpoint = 1;
  else if (of.is_infinite())
    result.endpoint = of.emission_pdf_direction(origin, direction);
  else
    result.endpoint = of.emission_pdf_position(origin);
  if (result.endpoint > 0) result.rest = chance_[size_t(light)] * joint / result.endpoint;
  return result;
}

}  // namespace kaustik
