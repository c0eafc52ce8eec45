#include "kaustik/vcm/plan/efficiency.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kaustik/base/parallel.h"
#include "kaustik/vcm/plan/cost_model.h"

namespace kaustik {
namespace {

/// Chances of going on, and numbers of lights that are sampled. Of two choices that are as good the
/// first is taken: where pilot paths have met nothing it costs nothing to go on.
constexpr std::array<double, 8> chances{1, 0.7, 0.5, 0.35, 0.2, 0.1, 0.05, double(least_survival)};
/// Glossy lobes choose among the first of these. Where merging finds what they would, it leaves
/// blotches, and single vertices that a pilot mostly does not happen upon: see
/// docs/theory/plans.md.
constexpr size_t glossy_chances = 3;
constexpr std::array<int, 5> light_counts{1, 2, 4, 8, PixelPlan::most_light_samples};
/// Times as much as samples whose variance is their mean square, even samples count at most.
constexpr double most_evenness = 30;
/// Errors count relative to a pixel's light, and this share of the picture's mean light.
constexpr double even_share_of_probes = 0.1;
constexpr int rounds = 6;
constexpr size_t probes_at_a_time = 256;

/// The largest errors of so large a share of the probes are not typical.
constexpr double share_of_largest = 0.01;

/// What a few paths have found nothing beyond is taken to have this share of the mean there: the
/// paths of a picture, which are many more, may find light.
constexpr double share_of_mean_unknown = 0.1;

bool has_found_nothing(const ProbeStatistics& probe) {
  const auto all_zero = [](const auto& squares) {
    return std::all_of(squares.begin(), squares.end(), [](double s) { return s == 0; });
  };
  return probe.cache_share == 0 && probe.rays_beyond + probe.glossy_rays_beyond > 0 &&
         probe.merged_alone == 0 && probe.glossy_merged_alone == 0 && all_zero(probe.squares) &&
         all_zero(probe.glossy_squares);
}

/// What may be chosen at a probe: a chance for each lobe, and a number of lights.
struct Candidates {
  // By chance: relative squared error of what the diffuse lobe scatters of all other light, and the
  // glossy one.
  std::array<double, chances.size()> squared_error{}, evenness{}, glossy_squared_error{};
  // Relative squared errors of direct light by one sample of a light and of what a cache has: all,
  // and what n samples divide by n.
  double constant = 0, light_sample = 0;
  double rays = 0, rays_beyond = 0, glossy_rays_beyond = 0, light_sample_rays = 0;
};

/// Some of them, by their places in `chances` and `light_counts`.
struct Chosen {
  uint8_t chance = 0, glossy_chance = 0, lights = 0;
};

double squared_error(const Candidates& of, const Chosen& chosen) {
  return of.squared_error[chosen.chance] + of.glossy_squared_error[chosen.glossy_chance] +
         of.constant - of.light_sample * (1 - 1.0 / light_counts[chosen.lights]);
}
double rays(const Candidates& of, const Chosen& chosen) {
  return of.rays + chances[chosen.chance] * of.rays_beyond +
         chances[chosen.glossy_chance] * of.glossy_rays_beyond +
         (light_counts[chosen.lights] - 1) * of.light_sample_rays;
}

double evenness_at(const ProbeStatistics& probe, double chance) {
  if (!(probe.path_mean_square > 0)) return 1;
  const double share = std::clamp(1 - probe.path_variance / probe.path_mean_square, 0.0, 1.0);
  return std::min(most_evenness, 1 / std::max(1e-9, 1 - chance * share));
}

double variance(const std::array<double, ProbeStatistics::bin_count>& squares, double merged_alone,
                double kappa, const MergeScale& scale) {
  const double nu = scale.area * scale.light_paths / scale.in_common;
  double sum = merged_alone > 0 ? merged_alone / nu : 0.0;
  double merging = nu * std::ldexp(1.0, -ProbeStatistics::bin_of_one);
  for (const double of_bin : squares) {
    sum += of_bin / (kappa + merging);
    merging *= 2;
  }
  return sum;
}

double rays_to_merge(const ProbeStatistics& probe, const MergeScale& scale) {
  if (!(scale.light_paths > 0)) return 0;
  return cost_model.merging +
         cost_model.merged_vertex * probe.merged * scale.area * scale.light_paths;
}

/// What a ray of a path that goes on takes, with what merges where it ends: every other one ends at
/// a lamp.
double rays_of_ray_beyond(const MergeScale& scale) {
  return scale.light_paths > 0 ? 1 + 0.5 * cost_model.merging : 1.0;
}

Candidates candidates(const ProbeStatistics& probe, const PassCosts& costs, const MergeScale& scale,
                      bool counts_evenness, double least_radiance) {
  const double relative = 1 / (probe.radiance * probe.radiance + least_radiance * least_radiance);
  Candidates result;
  for (size_t i = 0; i < chances.size(); ++i) {
    result.evenness[i] = counts_evenness ? evenness_at(probe, chances[i]) : 1.0;
    const double kappa = costs.camera_samples * chances[i] * result.evenness[i];
    result.squared_error[i] = variance(probe.squares, probe.merged_alone, kappa, scale) * relative;
    result.glossy_squared_error[i] = variance(probe.glossy_squares, probe.glossy_merged_alone,
                                              costs.camera_samples * chances[i], scale) *
                                     relative;
  }
  const double direct = probe.direct_variance / costs.camera_samples;
  // What stratification takes off, it is taken to take off all parts of it.
  const double stratified = probe.single_direct_variance > probe.direct_variance
                                ? probe.direct_variance / probe.single_direct_variance
                                : 1.0;
  const double light_sample = stratified * probe.light_sample_variance / costs.camera_samples;
  const double cached =
      probe.cache_variance +
      (scale.light_paths > 0 ? probe.cache_light_variance / scale.light_paths : 0.0);
  result.constant = (direct + cached) * relative;
  result.light_sample = std::min(direct, light_sample) * relative;
  result.rays = probe.rays + rays_to_merge(probe, scale);
  const double beyond = rays_of_ray_beyond(scale);
  result.rays_beyond = beyond * probe.rays_beyond;
  result.glossy_rays_beyond = beyond * probe.glossy_rays_beyond;
  result.light_sample_rays = cost_model.light_sample * probe.light_sample_rays;
  return result;
}

std::vector<Candidates> candidates_of(const std::vector<ProbeStatistics>& probes,
                                      const PassCosts& costs, const std::vector<MergeScale>& scales,
                                      const PlanChoices& choices) {
  double radiance = 0;
  for (const ProbeStatistics& probe : probes) radiance += probe.radiance;
  const double least = std::max(1e-30, even_share_of_probes * radiance / double(probes.size()));
  ProbeStatistics mean;
  for (const ProbeStatistics& probe : probes) mean.add(probe, 1 / double(probes.size()));
  std::vector<Candidates> all(probes.size());
  parallel_blocks(probes.size(), probes_at_a_time, [&](size_t begin, size_t end, size_t) {
    for (size_t p = begin; p < end; ++p) {
      ProbeStatistics probe = probes[p];
      if (has_found_nothing(probe)) {
        probe.squares = mean.squares;
        probe.glossy_squares = mean.glossy_squares;
        for (double& squares : probe.squares) squares *= share_of_mean_unknown;
        for (double& squares : probe.glossy_squares) squares *= share_of_mean_unknown;
      }
      all[p] = candidates(probe, costs, scales[p], choices.survival, least);
    }
  });
  return all;
}

double rays_of_light_paths(const PassCosts& costs, const std::vector<MergeScale>& scales) {
  double light_paths = 0;
  for (const MergeScale& scale : scales) light_paths = std::max(light_paths, scale.light_paths);
  return cost_model.light_ray * costs.light_rays * light_paths;
}

Efficiency expected(const std::vector<Candidates>& all, const std::vector<Chosen>& chosen,
                    const PassCosts& costs, const std::vector<MergeScale>& scales) {
  Efficiency total;
  for (size_t p = 0; p < all.size(); ++p) {
    total.squared_error += squared_error(all[p], chosen[p]);
    total.rays += rays(all[p], chosen[p]);
  }
  total.squared_error /= double(all.size());
  total.rays /= double(all.size());
  total.rays += rays_of_light_paths(costs, scales) + cost_model.gather_ray * costs.cache_rays;
  return total;
}

/// Efficiency::typical_squared_error. What is infinite stays so: such light would never be found.
double typical_error(const std::vector<Candidates>& all, const std::vector<Chosen>& chosen) {
  std::vector<double> errors(all.size());
  for (size_t p = 0; p < all.size(); ++p) errors[p] = squared_error(all[p], chosen[p]);
  const auto largest = size_t(share_of_largest * double(errors.size()));
  const auto bound = errors.end() - ptrdiff_t(largest) - 1;
  std::nth_element(errors.begin(), bound, errors.end());
  const double most = *bound;
  double sum = 0;
  for (const double error : errors) sum += std::isfinite(error) ? std::min(error, most) : error;
  return sum / double(errors.size());
}

/// What is chosen at each probe, and what is expected of all.
struct Choice {
  std::vector<Chosen> chosen;
  Efficiency expected;
};

/// The number below `count` whose time is least, the first of several.
template <typename Time>
uint8_t least_of(size_t count, const Time& time) {
  double least = std::numeric_limits<double>::infinity();
  size_t best = 0;
  for (size_t i = 0; i < count; ++i)
    if (const double of = time(i); of < least) {
      least = of;
      best = i;
    }
  return uint8_t(best);
}

/// What adds least to the time. Chances and lights add to it independently.
Chosen least_time(const Candidates& of, const Efficiency& total, const PlanChoices& choices) {
  const auto chance = [&](size_t count, const std::array<double, chances.size()>& errors,
                          double rays_beyond) {
    return least_of(choices.survival ? count : 1, [&](size_t i) {
      return errors[i] * total.rays + chances[i] * rays_beyond * total.squared_error;
    });
  };
  return {.chance = chance(chances.size(), of.squared_error, of.rays_beyond),
          .glossy_chance = chance(glossy_chances, of.glossy_squared_error, of.glossy_rays_beyond),
          .lights = least_of(choices.light_samples ? light_counts.size() : 1, [&](size_t i) {
            return of.light_sample / light_counts[i] * total.rays +
                   light_counts[i] * of.light_sample_rays * total.squared_error;
          })};
}

/// From `begin` at every probe on, by turns: the least product of two sums is the least weighted
/// sum, by weights that follow from the sums. That may end where no small change is better.
Choice improved(const std::vector<Candidates>& all, const Chosen& begin, const PassCosts& costs,
                const std::vector<MergeScale>& scales, const PlanChoices& choices) {
  std::vector<Chosen> chosen(all.size(), begin);
  for (int round = 0;; ++round) {
    const Efficiency total = expected(all, chosen, costs, scales);
    if (round == rounds) return {std::move(chosen), total};
    parallel_blocks(all.size(), probes_at_a_time, [&](size_t from, size_t end, size_t) {
      for (size_t p = from; p < end; ++p) chosen[p] = least_time(all[p], total, choices);
    });
  }
}

}  // namespace

void ProbeStatistics::add(const ProbeStatistics& other, double weight) {
  for (size_t i = 0; i < squares.size(); ++i) squares[i] += weight * other.squares[i];
  merged_alone += weight * other.merged_alone;
  for (size_t i = 0; i < squares.size(); ++i) glossy_squares[i] += weight * other.glossy_squares[i];
  glossy_merged_alone += weight * other.glossy_merged_alone;
  path_mean_square += weight * other.path_mean_square;
  path_variance += weight * other.path_variance;
  direct_variance += weight * other.direct_variance;
  single_direct_variance += weight * other.single_direct_variance;
  light_sample_variance += weight * other.light_sample_variance;
  radiance += weight * other.radiance;
  merged += weight * other.merged;
  rays += weight * other.rays;
  rays_beyond += weight * other.rays_beyond;
  glossy_rays_beyond += weight * other.glossy_rays_beyond;
  light_sample_rays += weight * other.light_sample_rays;
  for (size_t i = 0; i < squares.size(); ++i)
    ungathered.squares[i] += weight * other.ungathered.squares[i];
  for (size_t i = 0; i < squares.size(); ++i)
    ungathered.glossy_squares[i] += weight * other.ungathered.glossy_squares[i];
  ungathered.merged_alone += weight * other.ungathered.merged_alone;
  ungathered.glossy_merged_alone += weight * other.ungathered.glossy_merged_alone;
  ungathered.path_mean_square += weight * other.ungathered.path_mean_square;
  ungathered.path_variance += weight * other.ungathered.path_variance;
  ungathered.merged += weight * other.ungathered.merged;
  gathered += weight * other.gathered;
  cache_share += weight * other.cache_share;
  cache_variance += weight * other.cache_variance;
  cache_light_variance += weight * other.cache_light_variance;
}

ProbeStatistics ProbeStatistics::with_cache(double variance, double light_variance) const {
  ProbeStatistics rest = *this;
  rest.squares = ungathered.squares;
  rest.merged_alone = ungathered.merged_alone;
  rest.glossy_squares = ungathered.glossy_squares;
  rest.glossy_merged_alone = ungathered.glossy_merged_alone;
  rest.path_mean_square = ungathered.path_mean_square;
  rest.path_variance = ungathered.path_variance;
  rest.merged = ungathered.merged;
  rest.cache_share = 1;
  rest.cache_variance = variance;
  rest.cache_light_variance = light_variance;
  return rest;
}

double rays_beside_camera_paths(const std::vector<ProbeStatistics>& probes, const PassCosts& costs,
                                const std::vector<MergeScale>& scales) {
  double merging = 0;
  for (size_t p = 0; p < probes.size(); ++p) merging += rays_to_merge(probes[p], scales[p]);
  return merging / double(std::max<size_t>(1, probes.size())) + rays_of_light_paths(costs, scales) +
         cost_model.gather_ray * costs.cache_rays;
}

Efficiency choose_plans(const std::vector<ProbeStatistics>& probes, const PassCosts& costs,
                        const std::vector<MergeScale>& scales, const PlanChoices& choices,
                        std::vector<PixelPlan>& plans) {
  if (probes.empty()) return {};
  const std::vector<Candidates> all = candidates_of(probes, costs, scales, choices);
  const auto from = [&](size_t lights) {
    const size_t chance = choices.survival ? chances.size() / 2 : 0;
    return improved(all, {uint8_t(chance), 0, uint8_t(lights)}, costs, scales, choices);
  };
  Choice best = from(0);
  if (choices.light_samples)
    if (Choice other = from(light_counts.size() - 1); other.expected.time() < best.expected.time())
      best = std::move(other);
  for (size_t p = 0; p < all.size(); ++p) {
    const auto [chance, glossy_chance, lights] = best.chosen[p];
    plans[p].survival = float(chances[chance]);
    plans[p].glossy_survival = float(chances[glossy_chance]);
    plans[p].evenness = float(all[p].evenness[chance]);
    plans[p].light_samples = light_counts[lights];
    plans[p].merging_in_common = float(scales[p].in_common);
  }
  best.expected.typical_squared_error = typical_error(all, best.chosen);
  return best.expected;
}

}  // namespace kaustik
