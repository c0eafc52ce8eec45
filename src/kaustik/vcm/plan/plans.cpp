#include "kaustik/vcm/plan/plans.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/base/parallel.h"
#include "kaustik/photon/photon_map.h"
#include "kaustik/vcm/lessons/radius_learning.h"
#include "kaustik/vcm/light_pass.h"
#include "kaustik/vcm/plan/path_pilot.h"
#include "kaustik/vcm/plan/plan_selection.h"

namespace kaustik {
namespace {

/// Light paths of a pilot pass: half of a pass's, within these bounds.
constexpr uint32_t fewest_pilot_paths = 1 << 13, most_pilot_paths = 1 << 18;
/// Pilot passes, each guided by those before, that there are at most; another one is traced where
/// what was learned takes off so much of the second moment.
constexpr uint32_t most_pilots = 4;
/// Of the pilot pass that tells the first radii; more than there are others.
constexpr uint32_t radius_round = 16;
constexpr double worth_a_pilot = 0.7;
/// Or where no more paths than that were of use.
constexpr size_t few_paths = 1024;
/// Trials whether to guide scattering have so small a part of the pilot passes' paths.
constexpr uint32_t trial_part = 4;
/// Light paths are guided where they are scattered if no more than this is left of noise times
/// rays.
constexpr double worth_guiding = 0.8;
/// Light paths of a pass at most, of which each takes about a kilobyte: passes of many samples have
/// no more of them, unless a pass of so few samples as is usual has.
constexpr double most_light_paths = 1 << 21, most_usual_light_paths = 1 << 24;
constexpr double usual_samples = 4;
/// Light paths of a crop window at most, relative to those of a picture of its size, which so takes
/// a few times as long; and how many any window may have.
constexpr double most_times_own = 16, paths_of_any_crop = 1 << 16;
/// Probes by which plans are compared, where there are so many.
constexpr size_t compared_probes = 1 << 13;
/// Radius of the first disks that the pilot's light tells, at most, in shorter sides of the
/// picture.
constexpr float most_first_radius = 1.0f / 24;
constexpr float near_per_distance = 0.01746f;  // tan 1°

/// Whether there is a vertex that light of a point, or of something else that is never met, has
/// come to after a delta event: nothing but light paths will find such light.
bool has_hidden_light(const LightVertices& light) {
  const auto all = light.tree.tree().data();
  const auto& at_gauges = light.at_gauges.all();
  const auto is_hidden = [&](const auto& data) {
    const PathVertex& first = light.vertices[size_t(data.path) + 1];
    return data.before >= 2 && first.to_previous == 0 && first.delta;
  };
  return std::any_of(all.begin(), all.end(), is_hidden) ||
         std::any_of(light.in_media.data.begin(), light.in_media.data.end(), is_hidden) ||
         std::any_of(at_gauges.begin(), at_gauges.end(),
                     [&](const GaugeVertex& vertex) { return is_hidden(vertex.data); });
}

/// As many vertices as on surfaces, were those in media spread over the picture, in discs that blur
/// by no more than theirs.
MediumDisks medium_disks(const Scene& scene, const VcmSettings& settings,
                         const LightVertices& pilot, uint32_t of_pass, float mean_length) {
  const Vec2i size = scene.film().size;
  const double per_pixel = double(pilot.in_media.size()) / double(pilot.path_count) *
                           double(of_pass) / (double(size.x) * double(size.y));
  const double wanted = std::sqrt(double(settings.merge_neighbors) * double(inv_pi) / per_pixel);
  const float widths = wanted < double(most_disk_widths) ? float(wanted) : most_disk_widths;
  return {scene, std::max(least_disk_widths, widths), settings.radius, mean_length};
}

/// Whether light of these components may merge.
bool is_merging_wanted(ComponentSet components) {
  return components.has(Component::caustic) || components.has(Component::indirect) ||
         components.has(Component::specular) || components.has(Component::volume);
}

/// Of so many probes, row by row, those by which plans are compared: evenly over all rows and
/// columns, by multiples of the golden ratio.
std::vector<size_t> compared_of(size_t probes) {
  std::vector<size_t> result(std::min(probes, compared_probes));
  constexpr double golden = 0.6180339887498949;
  for (size_t i = 0; i < result.size(); ++i)
    result[i] =
        probes <= compared_probes ? i : size_t(std::fmod(double(i) * golden, 1.0) * double(probes));
  return result;
}

std::string described(const LightGuides& guides) {
  return fmt::format(
      "light paths are guided where matt surfaces scatter them: {:.2g} times less to do for what "
      "they bring, by a pilot's estimate",
      1 / guides.noise_of_guided);
}

/// noise_in_common() of what merges in a disk of that area around a probe, m².
double merging_in_common(const PixelPlans& pixels, size_t probe, float area) {
  const std::vector<PixelProbe>& probes = pixels.seen().probes();
  const float width = probe < probes.size() ? probes[probe].pixel_width : 0.0f;
  if (!(width > 0)) return 1;
  return double(noise_in_common(spread_of_disk(std::sqrt(area * inv_pi) / width)));
}

/// What choose_plans() expects by compared_of() the probes, which probe(i) tells.
template <typename Probe>
Efficiency expected_of_compared(const Probe& probe, const PassCosts& costs,
                                const std::vector<MergeScale>& scales, const PlanChoices& choices) {
  std::vector<ProbeStatistics> compared;
  std::vector<MergeScale> their_scales;
  for (const size_t i : compared_of(scales.size())) {
    compared.push_back(probe(i));
    their_scales.push_back(scales[i]);
  }
  std::vector<PixelPlan> chosen(compared.size());
  return choose_plans(compared, costs, their_scales, choices, chosen);
}

}  // namespace

ProbeStatistics VcmPilot::probe_with(const CachePlan& cache, size_t probe) const {
  if (cache.rounds == 0) return probes[probe];
  const CacheTrial& trial = cache_trials[size_t(cache.rounds) - 1];
  if (!trial.served[probe]) return probes[probe];
  return probes[probe].with_cache(double(trial.ray_variance[probe]) / cache.gather_rays,
                                  double(trial.light_variance[probe]) * light_share);
}

std::vector<ProbeStatistics> VcmPilot::probes_with(const CachePlan& cache) const {
  std::vector<ProbeStatistics> result;
  result.reserve(probes.size());
  for (size_t i = 0; i < probes.size(); ++i) result.push_back(probe_with(cache, i));
  return result;
}

Efficiency VcmPilot::expected(const CachePlan& cache, const std::vector<MergeScale>& scales,
                              const PlanChoices& choices) const {
  return expected_of_compared([&](size_t i) { return probe_with(cache, i); }, costs_with(cache),
                              scales, choices);
}

Efficiency VcmPilot::expected_with_ideal_cache(const std::vector<MergeScale>& scales,
                                               const PlanChoices& choices) const {
  return expected_of_compared([&](size_t i) { return probes[i].with_cache(0, 0); }, costs, scales,
                              choices);
}

PassCosts VcmPilot::costs_with(const CachePlan& cache) const {
  PassCosts result = costs;
  if (cache.rounds > 0)
    result.cache_rays = cache_trials[size_t(cache.rounds) - 1].rays_per_ray * cache.gather_rays /
                        (costs.camera_samples * costs.pixels);
  return result;
}

LightGuides LightGuides::guided_by(const LightPathUse& learned, const std::stop_token& stop) const {
  LightGuides result = *this;
  const EmissionLearning& learning = learned.emission();
  if (const auto found = learning.learned())
    if (learning.second_moment(*found) < learning.second_moment(*emission)) result.emission = found;
  if (!scattering) return result;
  const LightPathUse::Noise& noise = learned.noise();
  const bool pays = noise.guided < noise.unguided;
  result.scattering = pays ? learned.scattering().learned(stop) : nullptr;
  return result;
}

std::vector<MergeScale> VcmPlans::merge_scales(const std::vector<PixelPlan>& disks,
                                               float shrinkage) const {
  std::vector<MergeScale> scales(disks.size());
  for (size_t i = 0; i < disks.size(); ++i) {
    scales[i].light_paths =
        techniques.merging ? double(light_paths) / double(pilot->light_paths) : 0.0;
    const double area = double(disks[i].merge_area * shrinkage);
    if (pilot->areas[i] > 0) scales[i].area = area / double(pilot->areas[i]);
    scales[i].in_common = merging_in_common(pixels, i, float(area));
  }
  return scales;
}

Efficiency VcmPlans::settle(std::vector<PixelPlan> disks, float shrinkage) {
  const std::vector<MergeScale> scales = merge_scales(disks, shrinkage);
  const Efficiency result =
      choose_plans(pilot->probes_with(cache), pilot->costs_with(cache), scales, choices, disks);
  pixels = pixels.with(std::move(disks));
  return result;
}

VcmPlans VcmPlans::begun_anew(uint32_t passes) const {
  VcmPlans result = *this;
  if (pilot) {
    std::vector<PixelPlan> disks = pixels.plans();
    for (PixelPlan& disk : disks) disk.merge_area *= sqr(pass_radius(1, passes));
    result.settle(std::move(disks), 1);
  }
  if (const auto& spread = pixels.spread()) {
    SampleSpread from_begin;
    from_begin.counts = spread->counts;
    from_begin.first_indices.assign(spread->counts.size(), 0);
    from_begin.next_indices = spread->counts;
    result.pixels.set_spread(std::make_shared<const SampleSpread>(std::move(from_begin)));
  }
  return result;
}

uint32_t light_path_count(const Vec2i& size, uint32_t samples_per_pixel, float light_paths) {
  const double of_sample = double(light_paths) * double(size.x) * double(size.y);
  const double most =
      std::clamp(of_sample * usual_samples, most_light_paths, most_usual_light_paths);
  return uint32_t(std::clamp(of_sample * double(samples_per_pixel), 1.0, most));
}

uint32_t light_path_count(const FilmSettings& film, uint32_t samples_per_pixel, float light_paths) {
  const uint32_t own = light_path_count(film.crop_size, samples_per_pixel, light_paths);
  const uint32_t whole = light_path_count(film.size, samples_per_pixel, light_paths);
  const double most =
      std::min(most_light_paths, std::max(most_times_own * double(own), paths_of_any_crop));
  return std::max(own, uint32_t(std::min(double(whole), most)));
}

float accepted_area(const PixelPlans& pixels) {
  return pi * sqr(near_per_distance * pixels.seen().mean_distance());
}

float VcmPlanner::light_paths_asked_for(uint32_t samples_per_pixel) const {
  const Vec2i& pixels = scene_.film().size;
  const double samples = double(samples_per_pixel) * double(pixels.x) * double(pixels.y);
  return std::max(settings_.light_paths, float(double(settings_.least_light_paths) / samples));
}

FirstPlans VcmPlanner::make(uint32_t samples_per_pixel, const std::stop_token& stop) const {
  VcmPlans plans;
  plans.samples_per_pixel = samples_per_pixel;
  plans.guides.emission = plain_;
  plans.techniques = settings_.techniques;
  plans.light_paths = light_paths_asked_for(samples_per_pixel);
  plans.choices = settings_.choices;
  if (!settings_.techniques.merging && !settings_.techniques.connections)
    return {.plans = std::make_shared<const VcmPlans>(std::move(plans))};
  if (settings_.techniques.merging) plans.pixels = PixelPlans(scene_);
  const uint32_t of_pass = light_path_count(scene_.film(), samples_per_pixel, plans.light_paths);
  const uint32_t count =
      std::min({of_pass, most_pilot_paths, std::max(fewest_pilot_paths, of_pass / 2)});
  const FoundLight found = search_light(count, stop);
  const LightVertices& vertices = found.light.vertices;
  plans.guides = found.light.guides;
  if (!vertices.connectible.empty())
    plans.connectible_per_path =
        float(vertices.connectible.size()) / float(vertices.connectible_paths());
  FirstPlans result{.plans = nullptr, .use = found.use, .rays = found.rays};
  if (settings_.techniques.merging && !stop.stop_requested()) {
    FirstPlans merging = with_merging(std::move(plans), found.light, of_pass, stop);
    plans = *merging.plans;
    result.radii = merging.radii;
    result.rays += merging.rays;
  }
  if (std::string text = described_light_samples(plans.pixels); !text.empty())
    plans.decisions.push_back(std::move(text));
  if (plans.cache.rounds > 0)
    plans.decisions.emplace_back(
        "diffuse indirect light is gathered at some places, and interpolated between them where it "
        "is smooth");
  if (plans.guides.scattering && plans.techniques.needs_light_paths())
    plans.decisions.push_back(described(plans.guides));
  plans.decisions.insert(plans.decisions.end(), settings_.decisions.begin(),
                         settings_.decisions.end());
  result.plans = std::make_shared<const VcmPlans>(std::move(plans));
  return result;
}

VcmPlanner::FoundLight VcmPlanner::search_light(uint32_t count, const std::stop_token& stop) const {
  FoundLight found;
  const auto trace = [&](const std::shared_ptr<const LightPathEmission>& emission, uint32_t round) {
    found.light = trace_pilot({.emission = emission}, round, count, stop);
    found.rays += found.light.rays;
  };
  if (!settings_.guiding) {
    trace(plain_, 0);
    return found;
  }
  found.use = std::make_shared<LightPathUse>(scene_, *plain_, settings_.components);
  const auto searching = std::make_shared<const LightPathEmission>(*plain_, found.use->targets());
  std::shared_ptr<const LightPathEmission> emission = searching;
  LightGuides guides{.emission = plain_};
  for (uint32_t pilots = 1;; ++pilots) {
    trace(emission, pilots - 1);
    if (stop.stop_requested()) return found;
    found.use->learn(found.light.vertices, stop);
    if (stop.stop_requested()) return found;
    const EmissionLearning& learning = found.use->emission();
    const double before = learning.second_moment(*guides.emission);
    guides = guides.guided_by(*found.use, stop);
    if (stop.stop_requested()) return found;
    const double after = learning.second_moment(*guides.emission);
    const bool searches = guides.emission == plain_ && learning.size() < few_paths;
    if (pilots == most_pilots || !(searches || after < worth_a_pilot * before)) {
      // All else is to be told by light as passes will have it.
      if (emission != guides.emission) {
        trace(guides.emission, pilots);
        found.use->learn(found.light.vertices, stop);
      }
      return guide_scattering(std::move(found), pilots + 1, count, stop);
    }
    emission = searches ? searching : guides.emission;
  }
}

VcmPlanner::FoundLight VcmPlanner::guide_scattering(FoundLight found, uint32_t round,
                                                    uint32_t count,
                                                    const std::stop_token& stop) const {
  if (!settings_.guided_scattering) return found;
  LightPathUse& use = *found.use;
  LightGuides guides = found.light.guides;
  const uint32_t of_trial = std::max(1u, count / trial_part);
  const double unguided_rays = double(found.light.rays) / double(count) * double(of_trial);
  for (const uint32_t end = round + most_pilots; round < end; ++round) {
    const auto learned = use.scattering().learned(stop);
    if (!learned) break;
    const PilotLight trial =
        trace_pilot({.emission = guides.emission, .scattering = learned}, round, of_trial, stop);
    found.rays += trial.rays;
    if (stop.stop_requested()) return found;
    use.learn_scattering(trial.vertices, stop);
    if (stop.stop_requested()) return found;
    const LightPathUse::Noise& noise = use.noise();
    const double guided = noise.guided * double(trial.rays);
    const double least = guides.scattering ? guides.noise_of_guided : worth_guiding;
    if (!(guided < least * noise.unguided * unguided_rays)) break;
    guides.noise_of_guided = guided / (noise.unguided * unguided_rays);
    guides.scattering = learned;
  }
  if (!guides.scattering) return found;
  found.light = trace_pilot(guides, round + 1, count, stop);
  found.rays += found.light.rays;
  use.forget_emission();
  use.learn(found.light.vertices, stop);
  return found;
}

VcmPlanner::PilotLight VcmPlanner::trace_pilot(const LightGuides& guides, uint32_t round,
                                               uint32_t count, const std::stop_token& stop) const {
  PathWeights::Settings pilot;
  pilot.techniques.merging = settings_.techniques.merging;
  pilot.techniques.connections = settings_.techniques.connections;
  const PathWeights weights(pilot);
  SplatBuffer nowhere = SplatBuffer::nowhere();
  Pass pass;
  pass.index = round;
  PassReport report;
  PilotLight light{.guides = guides, .gauges = {}, .vertices = {}};
  if (pilot.techniques.merging && !scene_.gauges().empty()) {
    std::vector<float> radii;
    for (const PlacedGauge& gauge : scene_.gauges())
      radii.push_back(settings_.radius > 0 ? settings_.radius
                                           : GaugeDisks::largest_radius(gauge.distance_around));
    light.gauges = std::make_shared<const GaugeDisks>(scene_, std::move(radii), 0.0f, report.rays);
  }
  light.vertices = trace_light_vertices(
      {.scene = scene_,
       .emission = *guides.emission,
       .weights = weights,
       .components = settings_.components,
       .maximum_events = settings_.maximum_events,
       .light_paths = count,
       .camera_samples = 1,
       .plans = PixelPlans(),
       .shrinkage = 1,
       .remembered_paths = settings_.guiding ? LightPathUse::most_pilot_paths : 0,
       .scattering = guides.scattering.get(),
       .remembers_scattering = settings_.guided_scattering,
       .gauges = light.gauges.get()},
      pass, Stream::pilot_light, nowhere, stop, {}, report);
  light.rays = report.rays;
  return light;
}

FirstPlans VcmPlanner::with_merging(VcmPlans plans, const PilotLight& light, uint32_t of_pass,
                                    const std::stop_token& stop) const {
  FirstPlans result;
  const auto stopped = [&] {
    result.plans = std::make_shared<const VcmPlans>(std::move(plans));
    return result;
  };
  plans.pixels.choose_disks(light.vertices, of_pass, settings_.merge_neighbors, settings_.radius,
                            stop);
  plans.media =
      medium_disks(scene_, settings_, light.vertices, of_pass, plans.pixels.seen().mean_distance());
  if (settings_.edges)
    plans.pixels.find_edges(scene_, RadiusLearning::widest_widths(), settings_.radius, result.rays,
                            stop);
  if (stop.stop_requested()) return stopped();
  if (settings_.learns_radii()) {
    // By other light than that by which the pilot judges them: where that happens to agree, or to
    // be nowhere near, it would find less noise than there is.
    const PilotLight other =
        trace_pilot(light.guides, radius_round, light.vertices.path_count, stop);
    result.rays += other.rays;
    const auto radii =
        std::make_shared<const RadiusLearning>(scene_, plans.pixels, result.rays, stop);
    const std::vector<RadiusLearning::Sums> sums = RadiusLearning::sums_of(
        plans.pixels, other.vertices, settings_.components,
        std::vector<RadiusLearning::Sums>(plans.pixels.plans().size()), stop);
    if (stop.stop_requested()) return stopped();
    const double passes = double(light.vertices.path_count) / double(of_pass);
    const Vec2i& picture = scene_.film().size;
    const float most =
        std::max(most_disk_widths, most_first_radius * float(std::min(picture.x, picture.y)));
    plans.pixels = plans.pixels.with(radii->plans(plans.pixels, sums, passes, 1, most));
    result.radii = radii;
  }
  plans.pilot =
      std::make_shared<const VcmPilot>(make_pilot(plans, light, of_pass, stop, result.rays));
  if (stop.stop_requested()) return stopped();
  if (settings_.chooses_light_paths)
    plans = with_light_paths_that_pay(plans, stop);
  else
    settle_with_cache(plans);
  if (!plans.techniques.merging) result.radii = nullptr;
  result.plans = std::make_shared<const VcmPlans>(std::move(plans));
  return result;
}

VcmPilot VcmPlanner::make_pilot(const VcmPlans& plans, const PilotLight& light,
                                uint32_t light_paths, const std::stop_token& stop,
                                uint64_t& rays) const {
  VcmPilot pilot;
  PathWeights::Settings settings;
  settings.techniques = settings_.techniques;
  settings.techniques.splats = settings.techniques.connections = false;
  settings.light_paths = float(light_paths);
  settings.merge_area = plans.pixels.other_area();
  settings.accepted_area = accepted_area(plans.pixels);
  const PathWeights weights(settings);
  const auto samples = double(plans.samples_per_pixel);
  const MattMerging no_matt;
  const CameraPathInputs inputs{.scene = scene_,
                                .emission = *light.guides.emission,
                                .weights = weights,
                                .light = light.vertices,
                                .matt = no_matt,
                                .seen = plans.pixels.seen(),
                                .camera_samples = float(samples),
                                .merge_radius_sq = settings.merge_area * inv_pi,
                                .media = plans.media,
                                .maximum_events = settings_.maximum_events,
                                .roulette_depth = settings_.roulette_depth,
                                .scattering = light.guides.scattering.get()};
  const double light_share = double(light.vertices.path_count) / double(light_paths);
  pilot.probes = probe_statistics(inputs, plans.pixels,
                                  {.light_share = light_share, .components = settings_.components},
                                  rays, stop);
  for (const PixelPlan& plan : plans.pixels.plans()) pilot.areas.push_back(plan.merge_area);
  pilot.light_paths = plans.light_paths;
  pilot.light_share = light_share;
  pilot.needs_merging = scene_.has_scattering() || (is_merging_wanted(settings_.components) &&
                                                    has_hidden_light(light.vertices));
  const Vec2i size = scene_.film().crop_size;
  // Chances of going on are to be those of the whole picture, so what light paths a crop window has
  // beyond its own size's are taken for its neighbours'.
  const double shared_by =
      double(light_paths) /
      double(light_path_count(size, plans.samples_per_pixel, plans.light_paths));
  const double pixels = double(size.x) * double(size.y);
  pilot.costs = {.camera_samples = samples,
                 .light_rays = double(light.rays) / light_share / (samples * pixels * shared_by),
                 .pixels = pixels};
  if (stop.stop_requested()) return pilot;
  std::vector<MergeScale> scales(pilot.probes.size());
  for (size_t i = 0; i < scales.size(); ++i)
    scales[i].in_common = merging_in_common(plans.pixels, i, pilot.areas[i]);
  if (is_cache_worth_a_trial(pilot, scales)) {
    const SidedTree<LightVertexData> focused = focused_vertices(light.vertices, stop);
    TrialCaches caches({.scene = scene_,
                        .light = light.vertices,
                        .focused = focused,
                        .merge_radius_sq = settings.merge_area * inv_pi,
                        .maximum_events = settings_.maximum_events},
                       plans.pixels, stop);
    try_caches(caches, scales, pilot, stop);
    rays += caches.rays();
  }
  return pilot;
}

bool VcmPlanner::is_cache_worth_a_trial(const VcmPilot& pilot,
                                        const std::vector<MergeScale>& scales) const {
  if (settings_.choices.cache != CacheUse::choose)
    return settings_.choices.cache == CacheUse::always;
  if (std::none_of(pilot.probes.begin(), pilot.probes.end(),
                   [](const ProbeStatistics& probe) { return probe.has_diffuse_indirect(); }))
    return false;
  const double ideal = pilot.expected_with_ideal_cache(scales, settings_.choices).typical_time();
  return worth_caching * ideal < expected_time(pilot, scales, 0);
}

void VcmPlanner::try_caches(TrialCaches& caches, const std::vector<MergeScale>& scales,
                            VcmPilot& pilot, const std::stop_token& stop) const {
  const bool is_asked_for = settings_.choices.cache == CacheUse::always;
  for (int rounds = 1; rounds <= IndirectCache::most_rounds; ++rounds) {
    pilot.cache_trials[size_t(rounds) - 1] = caches.next_round(stop);
    if (stop.stop_requested()) return;
    // Finer rounds cost more, and serve less.
    if (!is_asked_for &&
        !(expected_time(pilot, scales, rounds) < expected_time(pilot, scales, rounds - 1)))
      break;
  }
}

double VcmPlanner::expected_time(const VcmPilot& pilot, const std::vector<MergeScale>& scales,
                                 int cache_rounds) const {
  return pilot.expected({.rounds = cache_rounds}, scales, settings_.choices).typical_time();
}

}  // namespace kaustik
