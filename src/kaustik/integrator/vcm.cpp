#include "kaustik/integrator/vcm.h"

#include <bit>
#include <cmath>
#include <map>

#include "kaustik/base/parallel.h"
#include "kaustik/integrator/light_path_use.h"
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

LightVertices VcmIntegrator::trace_pilot(const LightPathEmission& emission, uint32_t round,
                                         uint32_t count) const {
  PathWeights::Settings pilot;
  pilot.techniques.merging = true;
  pilot.techniques.connections = settings_.techniques.connections;
  const PathWeights weights(pilot);
  SplatBuffer nowhere({{1, 1}, {0, 0}, {1, 1}, {}, 0}, ComponentSet());
  Pass pass;
  pass.index = round;
  PassReport report;
  return trace_light_vertices(
      {scene_, emission, weights, settings_.components, settings_.maximum_events, count, 1,
       PixelPlans(), 1, settings_.guiding ? LightPathUse::most_pilot_paths : 0},
      pass, Stream::training, nowhere, {}, {}, report);
}

std::shared_ptr<const VcmIntegrator::Plans> VcmIntegrator::make_plans(
    uint32_t samples_per_pixel) const {
  auto plans = std::make_shared<Plans>();
  plans->samples_per_pixel = samples_per_pixel;
  const uint32_t of_pass = light_path_count(samples_per_pixel);
  const uint32_t count = std::min(of_pass, most_pilot_paths);
  plans->emission = plain_;
  LightVertices vertices;
  if (!settings_.guiding) {
    vertices = trace_pilot(*plain_, 0, count);
  } else {
    auto use = std::make_shared<LightPathUse>(scene_, *plain_);
    plans->use = use;
    const LightPathEmission searching(*plain_, use->targets());
    vertices = trace_pilot(searching, 0, count);
    for (uint32_t pilots = 1;; ++pilots) {
      use->learn(vertices);
      const EmissionLearning& learning = use->emission();
      const double before = learning.second_moment(*plans->emission);
      if (const auto learned = learning.learned()) plans->emission = learned;
      const double after = learning.second_moment(*plans->emission);
      const bool searches = plans->emission == plain_ && learning.size() < few_paths;
      if (pilots == most_pilots || !(searches || after < worth_a_pilot * before)) break;
      vertices = trace_pilot(searches ? searching : *plans->emission, pilots, count);
    }
  }
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
  Learning(const Scene& scene, std::shared_ptr<const Plans> of_first, uint64_t of_seed,
           bool learns_radii)
      : seed(of_seed), first(std::move(of_first)) {
    if (learns_radii) {
      radii = RadiusLearning(scene, first->pixels);
      sums.resize(first->pixels.probes().size());
    }
    if (first->use) use = std::make_unique<LightPathUse>(*first->use);
    epochs[0] = first;
  }

  /// The next pass.
  void learn(const Scene& scene, const LightVertices& light) {
    if (!sums.empty()) {
      const auto added = radii.sums_of(scene, first->pixels, light);
      for (size_t i = 0; i < added.size(); ++i) sums[i].add(added[i]);
    }
    if (use && teaches_emission(passes)) use->learn(light);
    if (!std::has_single_bit(++passes)) return;
    auto plans = std::make_shared<Plans>(*epochs.rbegin()->second);
    if (!sums.empty())
      plans->pixels = radii.plans(first->pixels, sums, passes, sqr(pass_radius(1, passes)));
    if (use)
      if (const auto learned = use->emission().learned()) plans->emission = learned;
    if (passes >= most_guided_passes) use.reset();
    epochs[passes] = std::move(plans);
  }

  uint64_t seed;
  std::shared_ptr<const Plans> first;
  RadiusLearning radii;
  std::vector<RadiusLearning::Sums> sums;  ///< empty: no radii are learned
  std::unique_ptr<LightPathUse> use;       ///< null: emission is not guided, or not any more
  uint32_t passes = 0;                     ///< that were learned from
  std::map<uint32_t, std::shared_ptr<const Plans>> epochs;  ///< by their first pass
};

VcmIntegrator::~VcmIntegrator() = default;

uint32_t VcmIntegrator::learned_passes() const {
  if (learns_radii()) return most_learned_passes;
  return settings_.guiding ? most_guided_passes : 0;
}

std::shared_ptr<const VcmIntegrator::Plans> VcmIntegrator::plans_for(const Pass& pass,
                                                                     std::stop_token stop) const {
  const auto first = plans(pass.samples_per_pixel);
  if (learned_passes() == 0) return first;
  // Epochs begin at passes 0, 1, 2, 4, 8 …
  const auto epoch_begin = [this](uint32_t index) {
    return std::min(learned_passes(), std::bit_floor(index));
  };
  const std::lock_guard lock(learning_mutex_);
  return isolated([&] {
    if (!learning_ || learning_->seed != pass.seed || learning_->first != first)
      learning_ = std::make_unique<Learning>(scene_, first, pass.seed, learns_radii());
    const uint32_t begin = epoch_begin(pass.index);
    // Passes that were not rendered here are made up for.
    while (learning_->passes < begin && !stop.stop_requested()) {
      Pass missing = pass;
      missing.index = learning_->passes;
      const Plans& plans = *learning_->epochs.at(epoch_begin(missing.index));
      SplatBuffer nowhere({{1, 1}, {0, 0}, {1, 1}, {}, 0}, ComponentSet());
      PassReport report;
      const LightVertices light =
          trace(plans, weights_for(plans, missing), missing, nowhere, stop, {}, report);
      if (!stop.stop_requested()) learning_->learn(scene_, light);
    }
    const auto found = learning_->epochs.find(begin);
    return found != learning_->epochs.end() ? found->second : first;
  });
}

void VcmIntegrator::learn_from(const LightVertices& light, const Pass& pass) const {
  const std::lock_guard lock(learning_mutex_);
  isolated([&] {
    // Passes out of order are traced anew where they are needed.
    if (learning_->seed == pass.seed && learning_->passes == pass.index &&
        learning_->first->samples_per_pixel == pass.samples_per_pixel &&
        pass.index < learned_passes())
      learning_->learn(scene_, light);
  });
}

uint32_t VcmIntegrator::remembered_paths(const Pass& pass) const {
  return settings_.guiding && teaches_emission(pass.index) ? LightPathUse::most_paths : 0;
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
      {scene_, *plans.emission, weights, settings_.components, settings_.maximum_events,
       light_path_count(pass.samples_per_pixel), float(pass.samples_per_pixel), plans.pixels,
       sqr(pass_radius(1, pass.index)), remembered_paths(pass)},
      pass, Stream::light_path, splats, stop, progress, report);
}

std::unique_ptr<PassState> VcmIntegrator::prepare(const Pass& pass, SplatBuffer& splats,
                                                  std::stop_token stop,
                                                  const ProgressFunction& progress) const {
  auto state = std::make_unique<State>();
  const bool needs_light = settings_.techniques.needs_light_paths();
  state->shrinkage = sqr(pass_radius(1, pass.index));
  state->camera_samples = float(pass.samples_per_pixel);
  if (needs_light) {
    state->plans = plans_for(pass, stop);
  } else {
    auto none = std::make_shared<Plans>();
    none->emission = plain_;
    state->plans = std::move(none);
  }
  state->weights = weights_for(*state->plans, pass);
  if (!needs_light) return state;
  state->light = trace(*state->plans, state->weights, pass, splats, stop, progress, state->report);
  if (settings_.techniques.merging) state->matt = MattMerging(state->light, state->weights);
  if (learned_passes() > 0 && !stop.stop_requested()) learn_from(state->light, pass);
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
