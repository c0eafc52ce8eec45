#include "kaustik/integrator/vcm_plans.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kaustik/integrator/path_pilot.h"
#include "kaustik/integrator/vcm_camera_path.h"
#include "kaustik/integrator/vcm_light_pass.h"

namespace kaustik {
namespace {

/// Light paths that the pilot pass has at most.
constexpr uint32_t most_pilot_paths = 1 << 18;
/// Pilot passes, each guided by those before, that there are at most; another one is traced where
/// what was learned takes off so much of the second moment.
constexpr uint32_t most_pilots = 4;
constexpr double worth_a_pilot = 0.7;
/// Or where no more paths than that were of use.
constexpr size_t few_paths = 1024;
/// Light paths of a pass at most: their vertices take some gigabytes.
constexpr double most_light_paths = 1 << 24;
/// Light paths that are tried beside those that are asked for, relative to them.
constexpr std::array<float, 3> light_path_factors{0.25f, 1, 4};
constexpr float near_per_distance = 0.01746f;  // tan 1°

std::string described(const VcmPlans& plans, double gain) {
  if (!plans.techniques.merging)
    return "auto: paths from the camera alone, light paths would not pay";
  const std::vector<PixelPlan>& pixels = plans.pixels.plans();
  double going_on = 0;
  for (const PixelPlan& plan : pixels) going_on += double(plan.survival);
  going_on /= double(std::max<size_t>(1, pixels.size()));
  const std::string why =
      std::isfinite(gain)
          ? fmt::format(
                "{:.2g} times less to do than for paths from the camera alone, by a pilot's "
                "estimate",
                gain)
          : std::string("they alone would not find all light");
  return fmt::format(
      "auto: {:.3g} light paths per camera sample, camera paths go on in {:.0f} % of cases: {}",
      plans.light_paths, 100 * going_on, why);
}

/// Settles how many light paths there are, if any, and says so.
void choose_light_paths(VcmPlans& plans) {
  const std::vector<PixelPlan> disks = plans.pixels.plans();
  const auto with = [&](float light_paths) {
    VcmPlans result = plans;
    result.light_paths = light_paths;
    result.techniques.merging = light_paths > 0;
    const Efficiency expected = result.settle(disks);
    return std::pair(std::move(result), expected);
  };
  auto [best, least] = with(0);
  const double of_paths_alone = least.time();
  for (const float factor : light_path_factors) {
    auto [other, expected] = with(plans.pilot->light_paths * factor);
    if (!(expected.time() < least.time())) continue;
    best = std::move(other);
    least = expected;
  }
  best.decision = described(best, of_paths_alone / least.time());
  plans = std::move(best);
}

}  // namespace

Efficiency VcmPlans::settle(std::vector<PixelPlan> disks) {
  std::vector<MergeScale> scales(disks.size());
  for (size_t i = 0; i < disks.size(); ++i) {
    scales[i].light_paths =
        techniques.merging ? double(light_paths) / double(pilot->light_paths) : 0.0;
    if (pilot->areas[i] > 0) scales[i].area = double(disks[i].merge_area) / double(pilot->areas[i]);
  }
  const Efficiency result = choose_survival(pilot->probes, pilot->costs, scales, disks);
  pixels = pixels.with(std::move(disks));
  return result;
}

uint32_t light_path_count(const Vec2i& size, uint32_t samples_per_pixel, float light_paths) {
  const double wanted =
      double(light_paths) * double(size.x) * double(size.y) * double(samples_per_pixel);
  return uint32_t(std::clamp(wanted, 1.0, most_light_paths));
}

float accepted_area(const PixelPlans& pixels) {
  return pi * sqr(near_per_distance * pixels.mean_distance());
}

VcmPlans VcmPlanner::make(uint32_t samples_per_pixel) const {
  VcmPlans plans;
  plans.samples_per_pixel = samples_per_pixel;
  plans.emission = plain_;
  plans.techniques = settings_.techniques;
  plans.light_paths = settings_.light_paths;
  if (!settings_.techniques.merging && !settings_.techniques.connections) return plans;
  const uint32_t of_pass =
      light_path_count(scene_.film().crop_size, samples_per_pixel, settings_.light_paths);
  const uint32_t count = std::min(of_pass, most_pilot_paths);
  const PilotLight light = search_light(plans, count);
  if (!light.vertices.connectible.empty())
    plans.connectible_per_path = float(light.vertices.connectible.size()) / float(count);
  if (!settings_.techniques.merging) return plans;
  plans.pixels =
      PixelPlans(scene_, light.vertices, of_pass, settings_.merge_neighbors, settings_.radius);
  plans.pilot = std::make_shared<const VcmPilot>(make_pilot(plans, light, of_pass));
  if (settings_.chooses_light_paths)
    choose_light_paths(plans);
  else
    plans.settle(plans.pixels.plans());
  return plans;
}

VcmPlanner::PilotLight VcmPlanner::search_light(VcmPlans& plans, uint32_t count) const {
  PilotLight light{plain_, {}, 0};
  std::shared_ptr<LightPathUse> use;
  std::shared_ptr<const LightPathEmission> searching = plain_;
  if (settings_.guiding) {
    use = std::make_shared<LightPathUse>(scene_, *plain_, settings_.components);
    plans.use = use;
    searching = std::make_shared<const LightPathEmission>(*plain_, use->targets());
    light.emission = searching;
  }
  for (uint32_t pilots = 1;; ++pilots) {
    PassReport report;
    light.vertices = trace_pilot(*light.emission, pilots - 1, count, report);
    light.rays = report.rays;
    plans.pilot_rays += report.rays;
    if (!use) return light;
    use->learn(light.vertices);
    const EmissionLearning& learning = use->emission();
    const double before = learning.second_moment(*plans.emission);
    if (const auto learned = learning.learned()) plans.emission = learned;
    const double after = learning.second_moment(*plans.emission);
    const bool searches = plans.emission == plain_ && learning.size() < few_paths;
    if (pilots == most_pilots || !(searches || after < worth_a_pilot * before)) return light;
    light.emission = searches ? searching : plans.emission;
  }
}

LightVertices VcmPlanner::trace_pilot(const LightPathEmission& emission, uint32_t round,
                                      uint32_t count, PassReport& report) const {
  PathWeights::Settings pilot;
  pilot.techniques.merging = settings_.techniques.merging;
  pilot.techniques.connections = settings_.techniques.connections;
  const PathWeights weights(pilot);
  SplatBuffer nowhere({{1, 1}, {0, 0}, {1, 1}, {}, 0}, ComponentSet());
  Pass pass;
  pass.index = round;
  return trace_light_vertices(
      {scene_, emission, weights, settings_.components, settings_.maximum_events, count, 1,
       PixelPlans(), 1, settings_.guiding ? LightPathUse::most_pilot_paths : 0},
      pass, Stream::training, nowhere, {}, {}, report);
}

VcmPilot VcmPlanner::make_pilot(VcmPlans& plans, const PilotLight& light,
                                uint32_t light_paths) const {
  VcmPilot pilot;
  PathWeights::Settings settings;
  settings.techniques = settings_.techniques;
  settings.techniques.splats = settings.techniques.connections = false;
  settings.light_paths = float(light_paths);
  settings.merge_area = plans.pixels.other_area();
  settings.accepted_area = accepted_area(plans.pixels);
  const PathWeights weights(settings);
  const auto samples = double(plans.samples_per_pixel);
  const VcmCameraInputs inputs{
      scene_,        *light.emission, weights, light.vertices,
      MattMerging(), float(samples),  0,       settings.merge_area * inv_pi};
  const double light_share = double(light.vertices.path_count) / double(light_paths);
  pilot.probes = probe_statistics(
      inputs, plans.pixels,
      {light_share, settings_.maximum_events, settings_.roulette_depth, settings_.components},
      plans.pilot_rays);
  for (const PixelPlan& plan : plans.pixels.plans()) pilot.areas.push_back(plan.merge_area);
  pilot.light_paths = plans.light_paths;
  const Vec2i size = scene_.film().crop_size;
  pilot.costs = {samples,
                 double(light.rays) / light_share / (samples * double(size.x) * double(size.y))};
  return pilot;
}

}  // namespace kaustik
