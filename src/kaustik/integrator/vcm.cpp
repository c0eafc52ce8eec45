#include "kaustik/integrator/vcm.h"

#include <bit>
#include <cmath>
#include <map>
#include <optional>

#include "kaustik/base/parallel.h"
#include "kaustik/integrator/radius_learning.h"
#include "kaustik/integrator/vcm_camera_path.h"
#include "kaustik/integrator/vcm_light_pass.h"
#include "kaustik/photon/photon_map.h"

namespace kaustik {
namespace {

/// Light paths that the pilot pass has at most.
constexpr uint32_t most_pilot_paths = 1 << 18;
/// Light paths of a pass at most: their vertices take some gigabytes.
constexpr double most_light_paths = 1 << 24;
/// Passes that are learned from at most.
constexpr uint32_t most_learned_passes = 256;
/// Of camera distances: the radius of what counts as near in the weights of merging.
constexpr float near_per_distance = 0.01746f;  // tan 1°

/// Progress of part `i` of `count` alike.
ProgressFunction part_of(const ProgressFunction& whole, uint32_t i, uint32_t count) {
  if (!whole) return {};
  return [&whole, i, count](double share) { whole((i + share) / count); };
}

/// First pass of the epoch that a pass belongs to: 0, 1, 2, 4, 8 …
uint32_t epoch_begin(uint32_t pass) { return std::min(most_learned_passes, std::bit_floor(pass)); }

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
    : scene_(scene), settings_(arguments), emission_(scene, settings_.aim) {
  if (scene.has_scattering())
    throw Error(ErrorKind::input, "this integrator does not scatter light in media yet",
                "use integrator path or photonmap", arguments.place());
}

std::shared_ptr<const VcmIntegrator::Plans> VcmIntegrator::make_plans(
    uint32_t samples_per_pixel) const {
  auto plans = std::make_shared<Plans>();
  plans->samples_per_pixel = samples_per_pixel;
  if (!settings_.techniques.merging && !settings_.techniques.connections) return plans;
  const uint32_t of_pass = light_path_count(samples_per_pixel);
  const uint32_t count = std::min(of_pass, most_pilot_paths);
  PathWeights::Settings pilot;
  pilot.techniques.merging = settings_.techniques.merging;
  pilot.techniques.connections = settings_.techniques.connections;
  const PathWeights weights(pilot);
  SplatBuffer nowhere({{1, 1}, {0, 0}, {1, 1}, {}, 0}, ComponentSet());
  PassReport report;
  const LightVertices vertices =
      trace_light_vertices({scene_, emission_, weights, settings_.components,
                            settings_.maximum_events, count, 1, plans->pixels, 1},
                           Pass{}, Stream::training, nowhere, {}, {}, report);
  if (!vertices.connectible.empty())
    plans->connectible_per_path = float(vertices.connectible.size()) / float(count);
  if (settings_.techniques.merging)
    plans->pixels =
        PixelPlans(scene_, vertices, of_pass, settings_.merge_neighbors, settings_.radius);
  return plans;
}

std::shared_ptr<const VcmIntegrator::Plans> VcmIntegrator::plans(uint32_t samples_per_pixel) const {
  const std::lock_guard lock(plans_mutex_);
  if (!plans_ || plans_->samples_per_pixel != samples_per_pixel)
    plans_ = isolated([&] { return make_plans(samples_per_pixel); });
  return plans_;
}

uint32_t VcmIntegrator::light_path_count(uint32_t samples_per_pixel) const {
  const Vec2i size = scene_.film().crop_size;
  const double wanted =
      double(settings_.light_paths) * double(size.x) * double(size.y) * double(samples_per_pixel);
  return uint32_t(std::clamp(wanted, 1.0, most_light_paths));
}

struct VcmIntegrator::Learning {
  explicit Learning(std::shared_ptr<const Plans> of_first) : first(std::move(of_first)) {}

  /// Forgets all but what every seed has in common.
  void begin(uint64_t of_seed) {
    seed = of_seed;
    sums.assign(first->pixels.probes().size(), {});
    passes = 0;
    epochs = {{0, first}};
  }
  /// The next pass.
  void learn(const LightVertices& light) {
    const auto added = RadiusLearning::sums_of(first->pixels, light);
    for (size_t i = 0; i < added.size(); ++i) sums[i].add(added[i]);
    ++passes;
  }
  /// The plans of the epoch that begins with this pass, made before that is learned from; those of
  /// the first pass if it was stopped.
  std::shared_ptr<const Plans> plans_of(uint32_t epoch, const Scene& scene,
                                        const std::stop_token& stop, uint64_t& rays) {
    const auto found = epochs.find(epoch);
    if (found != epochs.end()) return found->second;
    if (!radii) {
      RadiusLearning made(scene, first->pixels, rays, stop);
      if (stop.stop_requested()) return first;
      radii = std::move(made);
    }
    auto plans = std::make_shared<Plans>(*first);
    plans->pixels = radii->plans(first->pixels, sums, passes, sqr(pass_radius(1, passes)));
    return epochs[epoch] = std::move(plans);
  }

  std::shared_ptr<const Plans> first;
  std::optional<RadiusLearning> radii;  ///< made when it is first asked for
  uint64_t seed = 0;
  std::vector<RadiusLearning::Sums> sums;
  uint32_t passes = 0;                                      ///< that the sums are of
  std::map<uint32_t, std::shared_ptr<const Plans>> epochs;  ///< by their first pass
};

VcmIntegrator::~VcmIntegrator() = default;

std::shared_ptr<const VcmIntegrator::Plans> VcmIntegrator::plans_for(
    const Pass& pass, std::stop_token stop, const ProgressFunction& progress, uint32_t& made_up,
    PassReport& report) const {
  const auto first = plans(pass.samples_per_pixel);
  if (!learns()) return first;
  const std::lock_guard lock(learning_mutex_);
  return isolated([&] {
    const bool is_new = !learning_ || learning_->first != first;
    if (is_new) learning_ = std::make_unique<Learning>(first);
    if (is_new || learning_->seed != pass.seed) learning_->begin(pass.seed);
    const auto plans_of = [&](uint32_t index) {
      return learning_->plans_of(epoch_begin(index), scene_, stop, report.rays);
    };
    // Passes that were not rendered here are made up for, as far as learning goes.
    const uint32_t begin = epoch_begin(pass.index);
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
        pass.index < most_learned_passes && learning_->epochs.contains(epoch_begin(pass.index)))
      learning_->learn(light);
  });
}

PathWeights VcmIntegrator::weights_for(const Plans& plans, const Pass& pass) const {
  PathWeights::Settings weights;
  weights.techniques = settings_.techniques;
  weights.light_paths = float(light_path_count(pass.samples_per_pixel));
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
      {scene_, emission_, weights, settings_.components, settings_.maximum_events,
       light_path_count(pass.samples_per_pixel), float(pass.samples_per_pixel), plans.pixels,
       sqr(pass_radius(1, pass.index))},
      pass, Stream::light_path, splats, stop, progress, report);
}

std::unique_ptr<PassState> VcmIntegrator::prepare(const Pass& pass, SplatBuffer& splats,
                                                  std::stop_token stop,
                                                  const ProgressFunction& progress) const {
  auto state = std::make_unique<State>();
  const bool needs_light = settings_.techniques.needs_light_paths();
  state->shrinkage = sqr(pass_radius(1, pass.index));
  state->camera_samples = float(pass.samples_per_pixel);
  uint32_t made_up = 0;
  state->plans = needs_light ? plans_for(pass, stop, progress, made_up, state->report)
                             : std::make_shared<const Plans>();
  state->weights = weights_for(*state->plans, pass);
  if (!needs_light) return state;
  state->light = trace(*state->plans, state->weights, pass, splats, stop,
                       part_of(progress, made_up, made_up + 1), state->report);
  if (settings_.techniques.merging) state->matt = MattMerging(state->light, state->weights);
  if (learns() && !stop.stop_requested()) learn_from(state->light, pass);
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
                               emission_,
                               state.weights,
                               state.light,
                               state.matt,
                               state.camera_samples,
                               state.connection_scale,
                               state.weights.settings().merge_area * inv_pi};
  VcmCameraPath path(inputs, walk, state.plans->pixels.at(raster, state.shrinkage));
  const Techniques& techniques = settings_.techniques;
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
