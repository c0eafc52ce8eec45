#include "kaustik/integrator/vcm.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <map>
#include <optional>

#include "kaustik/base/parallel.h"
#include "kaustik/integrator/light_path_use.h"
#include "kaustik/integrator/path_pilot.h"
#include "kaustik/integrator/radius_learning.h"
#include "kaustik/integrator/vcm_camera_path.h"
#include "kaustik/integrator/vcm_light_pass.h"
#include "kaustik/photon/photon_map.h"

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
/// Passes that are learned from at most.
constexpr uint32_t most_learned_passes = 256;
/// The same for emission; of each epoch the last pass.
constexpr uint32_t most_guided_passes = 16;
bool teaches_emission(uint32_t pass) {
  return pass < most_guided_passes && std::has_single_bit(pass + 1);
}
/// Of camera distances: the radius of what counts as near in the weights of merging.
constexpr float near_per_distance = 0.01746f;  // tan 1°

/// Light paths that are tried beside those that are asked for, relative to them.
constexpr std::array<float, 3> light_path_factors{0.25f, 1, 4};

/// Progress of part `i` of `count` alike.
ProgressFunction part_of(const ProgressFunction& whole, uint32_t i, uint32_t count) {
  if (!whole) return {};
  return [&whole, i, count](double share) { whole((i + share) / count); };
}

}  // namespace

struct VcmIntegrator::State final : PassState {
  std::shared_ptr<const Plans> plans;
  PathWeights weights;
  LightVertices light;
  MattMerging matt;
  float shrinkage = 1;  ///< of the disks of merging
  float connection_scale = 0;
  float camera_samples = 1;
};

VcmIntegrator::VcmIntegrator(const Arguments& arguments, const Scene& scene)
    : scene_(scene),
      settings_(arguments),
      plain_(std::make_shared<const LightPathEmission>(scene, settings_.aim)) {
  if (scene.has_scattering())
    throw Error(ErrorKind::input, "this integrator does not scatter light in media yet",
                "use integrator path or photonmap", arguments.place());
}

std::shared_ptr<const VcmIntegrator::Plans> VcmIntegrator::make_plans(
    uint32_t samples_per_pixel) const {
  auto plans = std::make_shared<Plans>();
  plans->samples_per_pixel = samples_per_pixel;
  plans->emission = plain_;
  plans->techniques = settings_.techniques;
  plans->light_paths = settings_.light_paths;
  if (!settings_.techniques.merging && !settings_.techniques.connections) return plans;
  const uint32_t of_pass = light_path_count(samples_per_pixel, settings_.light_paths);
  const uint32_t count = std::min(of_pass, most_pilot_paths);
  const PilotLight light = search_light(*plans, count);
  if (!light.vertices.connectible.empty())
    plans->connectible_per_path = float(light.vertices.connectible.size()) / float(count);
  if (settings_.techniques.merging) {
    plans->pixels =
        PixelPlans(scene_, light.vertices, of_pass, settings_.merge_neighbors, settings_.radius);
    plans->pilot = make_pilot(*plans, light, of_pass);
    if (settings_.chooses_light_paths)
      choose_light_paths(*plans);
    else
      settle(*plans, plans->pixels.plans());
  }
  return plans;
}

VcmIntegrator::PilotLight VcmIntegrator::search_light(Plans& plans, uint32_t count) const {
  PilotLight light{plain_, {}, 0};
  std::shared_ptr<LightPathUse> use;
  std::shared_ptr<const LightPathEmission> searching = plain_;
  if (settings_.guiding) {
    use = std::make_shared<LightPathUse>(scene_, *plain_);
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

LightVertices VcmIntegrator::trace_pilot(const LightPathEmission& emission, uint32_t round,
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

std::shared_ptr<const VcmIntegrator::Pilot> VcmIntegrator::make_pilot(Plans& plans,
                                                                      const PilotLight& light,
                                                                      uint32_t light_paths) const {
  auto pilot = std::make_shared<Pilot>();
  PathWeights::Settings settings;
  settings.techniques = settings_.techniques;
  settings.techniques.splats = settings.techniques.connections = false;
  settings.light_paths = float(light_paths);
  settings.merge_area = plans.pixels.other_area();
  settings.accepted_area = pi * sqr(near_per_distance * plans.pixels.mean_distance());
  const PathWeights weights(settings);
  const auto samples = double(plans.samples_per_pixel);
  const VcmCameraInputs inputs{
      scene_,        *light.emission, weights, light.vertices,
      MattMerging(), float(samples),  0,       settings.merge_area * inv_pi};
  const double light_share = double(light.vertices.path_count) / double(light_paths);
  pilot->probes = probe_statistics(
      inputs, plans.pixels, {light_share, settings_.maximum_events, settings_.roulette_depth},
      plans.pilot_rays);
  for (const PixelPlan& plan : plans.pixels.plans()) pilot->areas.push_back(plan.merge_area);
  pilot->light_paths = plans.light_paths;
  const Vec2i size = scene_.film().crop_size;
  pilot->costs = {samples,
                  double(light.rays) / light_share / (samples * double(size.x) * double(size.y))};
  return pilot;
}

Efficiency VcmIntegrator::settle(Plans& plans, std::vector<PixelPlan> pixels) {
  const Pilot& pilot = *plans.pilot;
  std::vector<MergeScale> scales(pixels.size());
  for (size_t i = 0; i < pixels.size(); ++i) {
    scales[i].light_paths =
        plans.techniques.merging ? double(plans.light_paths) / double(pilot.light_paths) : 0.0;
    if (pilot.areas[i] > 0) scales[i].area = double(pixels[i].merge_area) / double(pilot.areas[i]);
  }
  const Efficiency result = choose_survival(pilot.probes, pilot.costs, scales, pixels);
  plans.pixels = plans.pixels.with(std::move(pixels));
  return result;
}

void VcmIntegrator::choose_light_paths(Plans& plans) {
  const std::vector<PixelPlan> pixels = plans.pixels.plans();
  const auto with = [&](float light_paths) {
    Plans result = plans;
    result.light_paths = light_paths;
    result.techniques.merging = light_paths > 0;
    const Efficiency expected = settle(result, pixels);
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
  double going_on = 0;
  for (const PixelPlan& plan : best.pixels.plans()) going_on += double(plan.survival);
  going_on /= double(std::max<size_t>(1, pixels.size()));
  const double gain = of_paths_alone / least.time();
  if (!best.techniques.merging)
    best.decision = "auto: paths from the camera alone, light paths would not pay";
  else if (std::isfinite(gain))
    best.decision = fmt::format(
        "auto: {:.3g} light paths per camera sample, camera paths go on in {:.0f} % of cases: "
        "{:.2g} "
        "times less to do than for paths from the camera alone, by a pilot's estimate",
        best.light_paths, 100 * going_on, gain);
  else
    best.decision = fmt::format(
        "auto: {:.3g} light paths per camera sample, camera paths go on in {:.0f} % of cases: they "
        "alone would not find all light",
        best.light_paths, 100 * going_on);
  plans = std::move(best);
}

std::shared_ptr<const VcmIntegrator::Plans> VcmIntegrator::plans(uint32_t samples_per_pixel,
                                                                 PassReport& report) const {
  const std::lock_guard lock(plans_mutex_);
  if (!plans_ || plans_->samples_per_pixel != samples_per_pixel) {
    plans_ = isolated([&] { return make_plans(samples_per_pixel); });
    report.rays += plans_->pilot_rays;
  }
  return plans_;
}

uint32_t VcmIntegrator::light_path_count(uint32_t samples_per_pixel, float light_paths) const {
  const Vec2i size = scene_.film().crop_size;
  const double wanted =
      double(light_paths) * double(size.x) * double(size.y) * double(samples_per_pixel);
  return uint32_t(std::clamp(wanted, 1.0, most_light_paths));
}

struct VcmIntegrator::Learning {
  Learning(std::shared_ptr<const Plans> of_first, bool of_radii)
      : first(std::move(of_first)), learns_radii(of_radii) {}

  /// Forgets all but what every seed has in common.
  void begin(uint64_t of_seed) {
    seed = of_seed;
    sums.assign(learns_radii ? first->pixels.probes().size() : 0, {});
    use = first->use ? std::make_unique<LightPathUse>(*first->use) : nullptr;
    passes = 0;
    epochs = {{0, first}};
  }
  /// The next pass.
  void learn(const LightVertices& light) {
    if (learns_radii) {
      const auto added = RadiusLearning::sums_of(first->pixels, light);
      for (size_t i = 0; i < added.size(); ++i) sums[i].add(added[i]);
    }
    if (use && teaches_emission(passes)) use->learn(light);
    ++passes;
  }
  /// The plans of the epoch that begins with this pass, made before that is learned from; those of
  /// the first pass if it was stopped.
  std::shared_ptr<const Plans> plans_of(uint32_t epoch, const Scene& scene,
                                        const std::stop_token& stop, uint64_t& rays) {
    const auto found = epochs.find(epoch);
    if (found != epochs.end()) return found->second;
    if (learns_radii && !radii) {
      RadiusLearning made(scene, first->pixels, rays, stop);
      if (stop.stop_requested()) return first;
      radii = std::move(made);
    }
    auto plans = std::make_shared<Plans>(*epochs.rbegin()->second);
    if (learns_radii)
      settle(*plans, radii->plans(first->pixels, sums, passes, sqr(pass_radius(1, passes))));
    if (use)
      if (const auto learned = use->emission().learned()) plans->emission = learned;
    if (passes >= most_guided_passes) use.reset();
    return epochs[epoch] = std::move(plans);
  }

  std::shared_ptr<const Plans> first;
  bool learns_radii;
  std::unique_ptr<LightPathUse> use;    ///< null: emission is not guided, or not any more
  std::optional<RadiusLearning> radii;  ///< made when it is first asked for
  uint64_t seed = 0;
  std::vector<RadiusLearning::Sums> sums;
  uint32_t passes = 0;                                      ///< that the sums are of
  std::map<uint32_t, std::shared_ptr<const Plans>> epochs;  ///< by their first pass
};

VcmIntegrator::~VcmIntegrator() = default;

uint32_t VcmIntegrator::learned_passes(const Plans& plans) const {
  if (!plans.techniques.needs_light_paths()) return 0;
  if (learns_radii(plans)) return most_learned_passes;
  return plans.use ? most_guided_passes : 0;
}

uint32_t VcmIntegrator::epoch_begin(uint32_t pass, const Plans& plans) const {
  return std::min(learned_passes(plans), std::bit_floor(pass));
}

std::shared_ptr<const VcmIntegrator::Plans> VcmIntegrator::plans_for(
    const Pass& pass, std::stop_token stop, const ProgressFunction& progress, uint32_t& made_up,
    PassReport& report) const {
  const auto first = plans(pass.samples_per_pixel, report);
  if (learned_passes(*first) == 0) return first;
  const std::lock_guard lock(learning_mutex_);
  return isolated([&] {
    const bool is_new = !learning_ || learning_->first != first;
    if (is_new) learning_ = std::make_unique<Learning>(first, learns_radii(*first));
    if (is_new || learning_->seed != pass.seed) learning_->begin(pass.seed);
    const auto plans_of = [&](uint32_t index) {
      return learning_->plans_of(epoch_begin(index, *first), scene_, stop, report.rays);
    };
    // Passes that were not rendered here are made up for, as far as learning goes.
    const uint32_t begin = epoch_begin(pass.index, *first);
    const uint32_t missing_count = begin - std::min(begin, learning_->passes);
    for (made_up = 0; made_up < missing_count; ++made_up) {
      Pass missing = pass;
      missing.index = learning_->passes;
      const auto plans = plans_of(missing.index);
      SplatBuffer nowhere({{1, 1}, {0, 0}, {1, 1}, {}, 0}, ComponentSet());
      PathWeights::Settings merging_alone = weights_for(*plans, missing).settings();
      merging_alone.techniques.splats = merging_alone.techniques.connections = false;
      const LightVertices light = trace(*plans, PathWeights(merging_alone), missing, nowhere, stop,
                                        part_of(progress, made_up, missing_count + 1), report);
      if (stop.stop_requested()) return first;
      learning_->learn(light);
    }
    return plans_of(pass.index);
  });
}

void VcmIntegrator::learn_from(const LightVertices& light, const Pass& pass) const {
  const std::lock_guard lock(learning_mutex_);
  isolated([&] {
    // Passes out of order are traced anew where they are needed; sums of an epoch whose plans are
    // still to be made stay as they are.
    if (learning_->seed == pass.seed && learning_->passes == pass.index &&
        learning_->first->samples_per_pixel == pass.samples_per_pixel &&
        pass.index < learned_passes(*learning_->first) &&
        learning_->epochs.contains(epoch_begin(pass.index, *learning_->first)))
      learning_->learn(light);
  });
}

uint32_t VcmIntegrator::remembered_paths(const Pass& pass) const {
  return settings_.guiding && teaches_emission(pass.index) ? LightPathUse::most_paths : 0;
}

PathWeights VcmIntegrator::weights_for(const Plans& plans, const Pass& pass) const {
  PathWeights::Settings weights;
  weights.techniques = plans.techniques;
  weights.light_paths = float(light_path_count(pass.samples_per_pixel, plans.light_paths));
  weights.connections = float(settings_.connections) / plans.connectible_per_path;
  weights.merge_area = plans.pixels.other_area() * sqr(pass_radius(1, pass.index));
  weights.accepted_area = pi * sqr(near_per_distance * plans.pixels.mean_distance());
  weights.correlation = settings_.correlation;
  return PathWeights(weights);
}

LightVertices VcmIntegrator::trace(const Plans& plans, const PathWeights& weights, const Pass& pass,
                                   SplatBuffer& splats, std::stop_token stop,
                                   const ProgressFunction& progress, PassReport& report) const {
  return trace_light_vertices(
      {scene_, *plans.emission, weights, settings_.components, settings_.maximum_events,
       light_path_count(pass.samples_per_pixel, plans.light_paths), float(pass.samples_per_pixel),
       plans.pixels, sqr(pass_radius(1, pass.index)), remembered_paths(pass)},
      pass, Stream::light_path, splats, stop, progress, report);
}

std::unique_ptr<PassState> VcmIntegrator::prepare(const Pass& pass, SplatBuffer& splats,
                                                  std::stop_token stop,
                                                  const ProgressFunction& progress) const {
  auto state = std::make_unique<State>();
  state->shrinkage = sqr(pass_radius(1, pass.index));
  state->camera_samples = float(pass.samples_per_pixel);
  uint32_t made_up = 0;
  state->plans = plans_for(pass, stop, progress, made_up, state->report);
  state->weights = weights_for(*state->plans, pass);
  if (!state->plans->decision.empty()) state->report.decisions.push_back(state->plans->decision);
  const Techniques& techniques = state->plans->techniques;
  if (!techniques.any())
    state->report.warnings.emplace_back(
        "all techniques are switched off: only lights that the camera sees straight are there; "
        "switch on unidirectional, next_event, splats, connections or merging");
  if (!techniques.needs_light_paths()) return state;
  state->light = trace(*state->plans, state->weights, pass, splats, stop,
                       part_of(progress, made_up, made_up + 1), state->report);
  if (techniques.merging) state->matt = MattMerging(state->light, state->weights);
  if (learned_passes(*state->plans) > 0 && !stop.stop_requested()) learn_from(state->light, pass);
  state->connection_scale =
      float(double(state->light.connectible.size()) /
            (double(settings_.connections) * double(state->light.path_count)));
  return state;
}

void VcmIntegrator::sample(const PassState& pass_state, const Vec2f& raster, Sampler& sampler,
                           SampleSink& sink) const {
  const auto& state = static_cast<const State&>(pass_state);
  CameraWalk walk(scene_, raster, sampler, sink);
  const VcmCameraInputs inputs{scene_,
                               *state.plans->emission,
                               state.weights,
                               state.light,
                               state.matt,
                               state.camera_samples,
                               state.connection_scale,
                               state.weights.settings().merge_area * inv_pi};
  VcmCameraPath path(inputs, walk, state.plans->pixels.at(raster, state.shrinkage));
  const Techniques& techniques = state.plans->techniques;
  while (walk.advance()) {
    path.arrive();
    if (walk.events() >= settings_.maximum_events) return;
    if (techniques.next_event) walk.add_direct_light(1, 1);
    if (techniques.merging) path.merge(settings_.maximum_events);
    if (techniques.connections) path.connect(settings_.connections, settings_.maximum_events);
    const Vec2f u = sampler.next_2d(), u_choice = sampler.next_2d();
    if (!walk.scatter(Lobes::all, 1, u_choice.x, u)) return;
    path.leave();
    if (!walk.may_find_more()) return;
    if (!path.survives_first(sampler.next_1d())) return;
    if (walk.events() > settings_.roulette_depth && !walk.survive(u_choice.y)) return;
  }
}

}  // namespace kaustik
