#pragma once
#include <algorithm>
#include <array>
#include <utility>

#include "kaustik/base/sampler.h"
#include "kaustik/transport/vertex.h"
#include "kaustik/transport/visibility.h"
#include "kaustik/transport/visibility_estimator.h"

namespace kaustik {

/// What lights are asked with at a vertex: only light on the viewer's side counts there, unless the
/// surface transmits.
inline LightQuery light_query(const SurfaceVertex& vertex, int recursion_level = 0) {
  LightQuery query(vertex.position(), {0, 0, 0}, recursion_level, vertex.wavelengths());
  if (!vertex.transmits())
    query.normal = vertex.on_front() ? vertex.point().ng : -vertex.point().ng;
  return query;
}

/// Where light arrives: on a surface or in a medium.
struct Receiver {
  Receiver() = default;
  Receiver(const SurfaceVertex& vertex, int recursion_level = 0)  // NOLINT: a vertex is one
      : point(vertex.point()),
        normal(light_query(vertex).normal),
        level(recursion_level),
        wavelengths(vertex.wavelengths()) {}
  /// In a medium.
  Receiver(const Vec3f& position, int recursion_level, const Wavelengths& at_wavelengths)
      : level(recursion_level), wavelengths(at_wavelengths) {
    point.position = position;
  }

  /// What lights are asked with, by sampling and by densities alike.
  LightQuery query() const { return {point.position, normal, level, wavelengths}; }

  SurfacePoint point;     ///< without a normal in a medium
  Vec3f normal{0, 0, 0};  ///< light arrives from its half space; zero: from anywhere
  int level = 0;          ///< see LightQuery::level; 0: what the camera itself sees
  Wavelengths wavelengths;
};

/// Light that arrives at a vertex straight from a light, found by sampling one light.
struct DirectLight {
  int light = -1;     ///< index in the scene
  Vec3f wi;           ///< unit, toward the light
  Spectrum radiance;  ///< arriving radiance over its density, W/m² per projected sr: multiply
                      ///< by f·cosine (in a medium: by the phase function); without visibility
  float pdf_solid_angle =
      0;                  ///< choice of the light included; 0 where no ray meets the light (no MIS)
  float pdf_sampled = 0;  ///< the same of any light; of a single point or direction the chance
  Ray shadow_ray;         ///< occluded: no light
  SurfacePoint on_light;  ///< where it leaves the light; its normal is zero, or it has none, at
                          ///< lights that are a point or infinitely far away
  float distance = 0;     ///< to it, m; infinite for infinite lights
};

/// Which lights a vertex samples.
enum class LightChoice {
  one,  ///< one for each sample, chosen in proportion to what it may send there
  all   ///< every one that may reach the vertex
};

/// How many samples of direct light a vertex takes.
struct LightSampling {
  LightChoice choice = LightChoice::one;
  /// With LightChoice::all shared among the lights, see LightShares. At least 1.
  int samples = 1;
};

/// What became of a sample.
enum class ShadowAnswer {
  none,  ///< no shadow ray was traced
  dark,  ///< something is in its way
  lit    ///< light arrives, or a part of it
};

/// One light for a sample, by LightSelector. One dimension pair of `sampler`.
inline LightSelector::Choice choose_light(const Scene& scene, const Receiver& receiver,
                                          Sampler& sampler) {
  if (const LightSelector::Choice* only = scene.light_selector().only_choice()) {
    sampler.skip_pair();
    return *only;
  }
  float u = sampler.next_1d();
  return scene.light_selector().choose(receiver.point.position, receiver.normal, u);
}
/// Samples a light that was chosen; false if nothing can arrive.
bool sample_chosen_light(const Scene& scene, const Receiver& receiver,
                         const LightSelector::Choice& choice, const Vec2f& u, DirectLight& result);
/// Both. Two dimension pairs of `sampler`.
bool sample_direct_light(const Scene& scene, const Receiver& receiver, Sampler& sampler,
                         DirectLight& result);
/// How many of `samples` each light gets with LightChoice::all: in proportion to the irradiance
/// that it may bring, at least one, and none where no light can arrive.
class LightShares {
 public:
  /// All must outlive this.
  LightShares(const Scene& scene, const Receiver& receiver, int samples);
  int samples_of(size_t light) const;

 private:
  float irradiance(size_t light) const;

  const Scene& scene_;
  const LightQuery query_;
  int samples_;
  /// Of the first lights; the few scenes that have more ask them twice.
  std::array<float, 32> first_irradiances_;
  double total_ = 0;
};

/// What is left of light on the way from a light: shadow_ray_transmittance(), and its answer.
inline Spectrum trace_shadow_ray(const Scene& scene, const DirectLight& light, const Medium* medium,
                                 const LightOnItsWay& of, uint64_t& rays, ShadowAnswer& answer) {
  const Spectrum left = shadow_ray_transmittance(scene, light.shadow_ray, medium, of, rays);
  answer = left.is_zero() ? ShadowAnswer::dark : ShadowAnswer::lit;
  return left;
}

/// What arrives of light on the way from a light, as far as `sight` knows; of the rest a shadow ray
/// tells. Null: it tells of all.
inline Spectrum arriving_share(const Scene& scene, const DirectLight& light,
                               VisibilityEstimator* sight, const Medium* medium,
                               const LightOnItsWay& of, uint64_t& rays, ShadowAnswer& answer) {
  const VisibilityEstimate seen = sight ? sight->of(light.light) : VisibilityEstimate();
  Spectrum share(seen.known);
  if (seen.by_ray > 0)
    share += trace_shadow_ray(scene, light, medium, of, rays, answer) * seen.by_ray;
  return share;
}

/// The estimate of what the lights bring: the mean over the samples of what
/// `reflect(const DirectLight&, ShadowAnswer&)` makes of each that may bring light, summed over the
/// lights. It returns a Value: something that is zero at first, can be added (+=) and multiplied by
/// a float (*=). At most two dimension pairs of `sampler`.
///
/// A sample of a light with several LightTraits::shadow_samples is a few of them with a shadow ray
/// each, and all of them where these disagree, see sample_with_shadow_rays().
template <typename Value, typename Reflect>
Value sample_direct_lights(const Scene& scene, const Receiver& receiver,
                           const LightSampling& sampling, Sampler& sampler, const Reflect& reflect);

/// Density per solid angle with which a sample of what asks with `query` finds `target` of a light.
float direct_light_pdf(const Scene& scene, const LightQuery& query, LightChoice choice, int light,
                       const LightTarget& target);

/// Power heuristic with exponent 2 for one sample each (Veach 1997).
inline float mis_weight(float pdf, float other_pdf) {
  if (!(pdf > 0)) return 0;
  const float ratio = other_pdf / pdf;  // squares of densities may overflow, those of ratios vanish
  return 1 / (1 + ratio * ratio);
}

/// One of the two classes of lobes (diffuse, specular) of a vertex, chosen by their albedos, so
/// that every path knows the class of each of its events. `u` becomes a fresh uniform number.
struct LobeChoice {
  Lobes lobes = Lobes::none;
  float probability = 1;
};
LobeChoice choose_lobes(const SurfaceVertex& vertex, float& u);
/// The probability with which choose_lobes picks the diffuse class.
float diffuse_probability(const SurfaceVertex& vertex);

/// Most shadow rays for a sample of a light: Light::shadow_samples, half as many at each deeper
/// recursion level.
inline int most_shadow_rays(const Scene& scene, const Receiver& receiver, int light) {
  return std::max(
      1, scene.lights()[size_t(light)]->traits().shadow_samples >> std::min(receiver.level, 30));
}

/// One sample of a light, with as many shadow rays as its shadow asks for; see
/// sample_direct_lights().
///
/// Some groups begin with a ray each. A group is traced in full if the first rays of the
/// *others* disagree, and its mean is then that of all its rays. So no ray has a say in how many
/// there are in its own group: the mean of each group is unbiased, and so is that of all groups.
/// (Were the groups' own rays asked too, those that happen to disagree would weigh less.) Groups
/// draw independent numbers; within a group they stratify one another. One dimension pair of
/// `sampler`.
template <typename Value, typename Reflect>
Value sample_with_shadow_rays(const Scene& scene, const Receiver& receiver,
                              const LightSelector::Choice& choice, Sampler& sampler,
                              const Reflect& reflect) {
  const auto sample = [&](Sampler& numbers, ShadowAnswer& answer) {
    DirectLight light;
    return sample_chosen_light(scene, receiver, choice, numbers.next_2d(), light)
               ? reflect(std::as_const(light), answer)
               : Value();
  };
  const auto most = size_t(most_shadow_rays(scene, receiver, choice.light));
  if (most == 1) {
    ShadowAnswer not_asked{};
    return sample(sampler, not_asked);
  }
  constexpr size_t most_groups = row_of(Fork::light_group).count;
  static_assert(row_of(Split::shadow_ray).count == most_groups);
  std::array<ShadowAnswer, most_groups> first{};
  std::array<Value, most_groups> values{};
  const size_t groups = std::min(most, std::clamp<size_t>(most / 4, 4, most_groups));
  const Sampler parent = sampler;
  int lit = 0, dark = 0;
  for (size_t g = 0; g < groups; ++g) {
    Sampler fork = parent.fork(Fork::light_group, uint32_t(g));
    values[g] = sample(g == 0 ? sampler : fork, first[g]);
    lit += first[g] == ShadowAnswer::lit ? 1 : 0;
    dark += first[g] == ShadowAnswer::dark ? 1 : 0;
  }
  Value sum{};
  for (size_t g = 0; g < groups; ++g) {
    const bool others_disagree = lit > (first[g] == ShadowAnswer::lit ? 1 : 0) &&
                                 dark > (first[g] == ShadowAnswer::dark ? 1 : 0);
    // The groups share all rays as evenly as may be.
    const size_t rays = others_disagree ? (most + groups - 1 - g) / groups : 1;
    for (size_t i = 1; i < rays; ++i) {
      Sampler branch = parent.split(Split::shadow_ray, uint32_t(i), uint32_t(g));
      ShadowAnswer not_asked{};
      values[g] += sample(branch, not_asked);
    }
    values[g] *= 1.0f / float(rays * groups);
    sum += values[g];
  }
  return sum;
}

template <typename Value, typename Reflect>
Value sample_direct_lights(const Scene& scene, const Receiver& receiver,
                           const LightSampling& sampling, Sampler& sampler,
                           const Reflect& reflect) {
  Value sum{};
  const auto add = [&](const LightSelector::Choice& choice, Sampler& numbers, int count) {
    if (choice.light < 0) return;
    Value value = sample_with_shadow_rays<Value>(scene, receiver, choice, numbers, reflect);
    value *= 1.0f / float(count);
    sum += value;
  };
  if (sampling.choice == LightChoice::one) {
    if (sampling.samples == 1) {
      const LightSelector::Choice choice = choose_light(scene, receiver, sampler);
      add(choice, sampler, 1);
      return sum;
    }
    constexpr int most_at_once = 16;
    for (int begin = 0; begin < sampling.samples; begin += most_at_once) {
      const int count = std::min(most_at_once, sampling.samples - begin);
      std::array<float, most_at_once> u;
      std::array<LightSelector::Choice, most_at_once> choices;
      const auto branch = [&](int i) {
        return sampler.one_of(Series::light_sample, uint32_t(sampling.samples),
                              uint32_t(begin + i));
      };
      for (int i = 0; i < count; ++i) u[size_t(i)] = branch(i).next_1d();
      scene.light_selector().choose(receiver.point.position, receiver.normal,
                                    {u.data(), size_t(count)}, choices.data());
      for (int i = 0; i < count; ++i) {
        Sampler numbers = branch(i);
        numbers.next_1d();  // the choice's
        add(choices[size_t(i)], numbers, sampling.samples);
      }
    }
    return sum;
  }
  const LightShares shares(scene, receiver, sampling.samples);
  for (size_t i = 0; i < scene.lights().size(); ++i) {
    const int count = shares.samples_of(i);
    const Sampler of_light = sampler.fork(Fork::light, uint32_t(i));
    for (int k = 0; k < count; ++k) {
      Sampler branch = count == 1 ? of_light : of_light.split(Split::light_sample, uint32_t(k));
      add({int(i), 1.0f}, branch, count);
    }
  }
  return sum;
}

}  // namespace kaustik
