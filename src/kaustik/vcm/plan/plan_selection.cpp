#include "kaustik/vcm/plan/plan_selection.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace kaustik {
namespace {

/// Light paths that are tried beside those that are asked for, relative to them.
constexpr std::array<float, 3> light_path_factors{1, 4, 0.25f};
/// Fewer have wider disks, whose bias is not counted: they must be so much better.
constexpr double worth_fewer = 1.25;

template <typename Value>
double mean_of(const std::vector<PixelPlan>& plans, const Value& value) {
  double sum = 0;
  for (const PixelPlan& plan : plans) sum += double(value(plan));
  return sum / double(std::max<size_t>(1, plans.size()));
}

std::string described(const VcmPlans& plans, double gain) {
  if (!plans.techniques.merging)
    return "auto: paths from the camera alone, light paths would not pay";
  const double going_on =
      mean_of(plans.pixels.plans(), [](const PixelPlan& plan) { return plan.survival; });
  const std::string why =
      std::isfinite(gain)
          ? fmt::format(
                "{:.2g} times less to do than for paths from the camera alone, by a pilot's "
                "estimate",
                gain)
          : std::string("they alone might not find all light");
  return fmt::format(
      "auto: {:.3g} light paths per camera sample, matt surfaces let camera paths go on in {:.0f} "
      "% of cases: {}",
      plans.light_paths, 100 * going_on, why);
}

/// In which the cache may be filled: numbers of rounds that were tried.
std::vector<int> rounds_to_choose_from(const VcmPlans& plans) {
  if (plans.choices.cache == CacheUse::always) return {IndirectCache::most_rounds};
  std::vector<int> result;
  for (int rounds = 0; rounds <= IndirectCache::most_rounds; ++rounds)
    if (plans.pilot->has_tried(rounds)) result.push_back(rounds);
  return result;
}

/// As many gather rays of a record as pay.
void choose_gather_rays(VcmPlans& plans) {
  if (plans.cache.rounds == 0) return;
  VcmPlans other = plans;
  double least = std::numeric_limits<double>::infinity();
  for (int rays = IndirectCache::least_gather_rays; rays <= IndirectCache::most_gather_rays;
       rays *= 2) {
    other.cache.gather_rays = rays;
    const double time = other.expected(plans.pixels.plans(), 1).typical_time();
    if (!(time < least)) continue;
    least = time;
    plans.cache.gather_rays = rays;
  }
}

/// Fills the cache in as many rounds as pay, by what is typical, and returns what is expected.
Efficiency choose_cache(VcmPlans& plans) {
  const std::vector<PixelPlan> disks = plans.pixels.plans();
  std::optional<Efficiency> best;
  double least = 0;
  for (const int rounds : rounds_to_choose_from(plans)) {
    VcmPlans other = plans;
    other.cache.rounds = rounds;
    const Efficiency expected = other.expected(disks, 1);
    const double time = expected.typical_time() * (rounds > 0 ? worth_caching : 1);
    if (best && !(time < least)) continue;
    least = time;
    best = expected;
    plans.cache.rounds = rounds;
  }
  return *best;
}

}  // namespace

void settle_with_cache(VcmPlans& plans) {
  choose_cache(plans);
  choose_gather_rays(plans);
  plans.settle(plans.pixels.plans(), 1);
}

VcmPlans with_light_paths_that_pay(const VcmPlans& plans, const std::stop_token& stop) {
  const std::vector<PixelPlan> disks = plans.pixels.plans();
  struct Choice {
    VcmPlans plans;
    Efficiency expected;
  };
  const bool needs_merging = plans.pilot->needs_merging;
  Choice of_paths_alone{plans, {}};
  of_paths_alone.plans.light_paths = 0;
  of_paths_alone.plans.cache.rounds = 0;
  of_paths_alone.plans.techniques = plans.techniques.of_camera_paths();
  of_paths_alone.expected = of_paths_alone.plans.expected(disks, 1);
  Choice best = of_paths_alone;
  if (needs_merging || plans.choices.cache == CacheUse::always)
    best.expected.squared_error = std::numeric_limits<double>::infinity();
  for (const float factor : light_path_factors) {
    if (stop.stop_requested()) return plans;
    Choice other{plans, {}};
    other.plans.light_paths = plans.pilot->light_paths * factor;
    other.expected = choose_cache(other.plans);
    const double handicap = factor < 1 && best.plans.techniques.merging ? worth_fewer : 1;
    if (other.expected.time() * handicap < best.expected.time()) best = std::move(other);
  }
  const double gain = needs_merging ? std::numeric_limits<double>::infinity()
                                    : of_paths_alone.expected.time() / best.expected.time();
  VcmPlans result = std::move(best.plans);
  choose_gather_rays(result);
  result.settle(disks, 1);
  result.decisions.push_back(described(result, gain));
  return result;
}

std::string described_light_samples(const PixelPlans& pixels) {
  const double mean =
      mean_of(pixels.plans(), [](const PixelPlan& plan) { return plan.light_samples; });
  constexpr double worth_telling = 1.05;
  if (!(mean >= worth_telling)) return {};
  return fmt::format(
      "camera paths sample {:.2g} lights at their first vertex, on average, by a pilot's estimate",
      mean);
}

}  // namespace kaustik
