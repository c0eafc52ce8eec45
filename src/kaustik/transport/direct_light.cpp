#include "kaustik/transport/direct_light.h"

#include "kaustik/base/to_integer.h"

namespace kaustik {

bool sample_direct_light(const Scene& scene, const Receiver& receiver, Sampler& sampler,
                         DirectLight& result) {
  const LightSelector::Choice choice = choose_light(scene, receiver, sampler);
  const Vec2f u = sampler.next_2d();
  return choice.light >= 0 && sample_chosen_light(scene, receiver, choice, u, result);
}

bool sample_chosen_light(const Scene& scene, const Receiver& receiver,
                         const LightSelector::Choice& choice, const Vec2f& u, DirectLight& result) {
  const Vec3f& position = receiver.point.position;
  const LightSample sample =
      scene.lights()[size_t(choice.light)]->sample_toward(receiver.query(), u);
  if (!(sample.pdf_solid_angle > 0) || sample.radiance.is_zero()) return false;
  result.light = choice.light;
  result.wi = sample.direction;
  result.radiance = sample.radiance * (1 / sample.pdf_solid_angle) * (1 / choice.probability);
  result.pdf_solid_angle = sample.only_sampled ? 0 : sample.pdf_solid_angle * choice.probability;
  result.pdf_sampled = sample.pdf_solid_angle * choice.probability;
  result.on_light = sample.point;
  result.distance = sample.distance;
  if (sample.on_surface)
    result.shadow_ray = spawn_ray_to(receiver.point, sample.point);
  else if (std::isfinite(sample.distance))
    result.shadow_ray = spawn_ray_to(receiver.point, position + sample.direction * sample.distance);
  else
    result.shadow_ray = spawn_ray(receiver.point, sample.direction);
  return true;
}

LightShares::LightShares(const Scene& scene, const Receiver& receiver, int samples)
    : scene_(scene), query_(receiver.query()), samples_(samples) {
  for (size_t i = 0; i < scene.lights().size(); ++i) {
    const float value = scene.lights()[i]->expected_irradiance(query_);
    if (i < first_irradiances_.size()) first_irradiances_[i] = value;
    total_ += double(value);
  }
}

float LightShares::irradiance(size_t light) const {
  return light < first_irradiances_.size() ? first_irradiances_[light]
                                           : scene_.lights()[light]->expected_irradiance(query_);
}

int LightShares::samples_of(size_t light) const {
  const float of_light = irradiance(light);
  if (!(of_light > 0)) return 0;
  return to_integer(std::round(double(of_light) / total_ * samples_), 1, samples_);
}

namespace {

/// The light's chance with LightChoice::one; else whether it is sampled at all. How many samples it
/// gets is left out of the weights, here as there: they only have to agree.
float choice_factor(const Scene& scene, const LightQuery& query, LightChoice choice, int light) {
  if (choice == LightChoice::one)
    return scene.light_selector().probability(query.reference, query.normal, light);
  return scene.lights()[size_t(light)]->expected_irradiance(query) > 0 ? 1.0f : 0.0f;
}

}  // namespace

float direct_light_pdf(const Scene& scene, const LightQuery& query, LightChoice choice, int light,
                       const LightTarget& target) {
  return choice_factor(scene, query, choice, light) *
         scene.lights()[size_t(light)]->pdf_toward(query, target);
}

float diffuse_probability(const SurfaceVertex& vertex) {
  const Lobes lobes = vertex.lobes();
  if (!any(lobes & Lobes::specular)) return 1;
  if (!any(lobes & Lobes::diffuse)) return 0;
  const float diffuse = vertex.albedo(Lobes::diffuse).max_lane();
  const float specular = vertex.albedo(Lobes::specular).max_lane();
  const float total = diffuse + specular;
  return total > 0 ? diffuse / total : 1;
}

LobeChoice choose_lobes(const SurfaceVertex& vertex, float& u) {
  const float diffuse = diffuse_probability(vertex);
  if (u < diffuse) {
    u = std::min(u / diffuse, one_minus_epsilon);
    return {Lobes::diffuse, diffuse};
  }
  u = std::min((u - diffuse) / (1 - diffuse), one_minus_epsilon);
  return {Lobes::specular, 1 - diffuse};
}

}  // namespace kaustik
