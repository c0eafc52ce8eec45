#include "kaustik/vcm/vcm.h"

#include <algorithm>

#include "kaustik/base/parallel.h"
#include "kaustik/photon/photon_map.h"
#include "kaustik/vcm/camera_path/camera_path.h"
#include "kaustik/vcm/lessons/guide_lesson.h"
#include "kaustik/vcm/light_pass.h"

namespace kaustik {
namespace {

/// Progress of part `i` of `count` alike.
ProgressFunction part_of(const ProgressFunction& whole, uint32_t i, uint32_t count) {
  if (!whole) return {};
  return [&whole, i, count](double share) { whole((i + share) / count); };
}

}  // namespace

struct VcmIntegrator::State final : PassState {
  std::shared_ptr<const VcmPlans> plans;
  PathWeights weights;
  LightVertices light;
  MattMerging matt;
  float shrinkage = 1;  ///< of the disks of merging
  MediumDisks media;    ///< shrunk
  float connection_scale = 0;
  /// Per pixel, on average: what all weights go by, so those of all ways of finding a path still
  /// sum to 1 where a pixel gets more or fewer.
  float camera_samples = 1;

  State(std::shared_ptr<const VcmPlans> of_pass, const PathWeights& weights_of_pass,
        const Pass& pass)
      : plans(std::move(of_pass)),
        weights(weights_of_pass),
        shrinkage(sqr(pass_radius(1, pass.index))),
        media(plans->media.shrunk(shrinkage)),
        camera_samples(float(pass.samples_per_pixel)) {}
};

VcmIntegrator::VcmIntegrator(const Arguments& arguments, const Scene& scene)
    : scene_(scene),
      settings_(arguments),
      plain_(std::make_shared<const LightPathEmission>(scene, settings_.aim)) {
  if (scene.has_scattering()) {
    // It knows of what use paths are on surfaces alone.
    settings_.guiding = false;
    // So does the pilot, which then can't choose. What few vertices merge in thin media leaves
    // bright dots that connections take off.
    if (settings_.chooses_light_paths)
      settings_.techniques.splats = settings_.techniques.connections = true;
  }
  traits_ = {.splats = settings_.techniques.splats,
             .estimates_bias = settings_.techniques.merging,
             .components = settings_.components,
             .default_samples_per_pass = settings_.samples_per_pass};
}

std::shared_ptr<const VcmPlans> VcmIntegrator::plans(uint32_t samples_per_pixel,
                                                     const std::stop_token& stop,
                                                     PassReport& report) const {
  const std::lock_guard lock(plans_mutex_);
  if (plans_ && plans_->samples_per_pixel == samples_per_pixel) return plans_;
  auto made = isolated([&] {
    return std::make_shared<const VcmPlans>(
        VcmPlanner(scene_, settings_, plain_).make(samples_per_pixel, stop));
  });
  report.rays += made->pilot_rays;
  if (!stop.stop_requested()) plans_ = made;
  return made;
}

std::shared_ptr<const VcmPlans> VcmIntegrator::begin_lessons(const Pass& pass,
                                                             const std::stop_token& stop,
                                                             PassReport& report) const {
  if (lessons_ && lessons_->seed() == pass.seed &&
      lessons_->first()->samples_per_pixel == pass.samples_per_pixel &&
      lessons_->knows_epoch(lessons_->epoch_begin(pass.index)))
    return lessons_->first();
  auto first = plans(pass.samples_per_pixel, stop, report);
  if (stop.stop_requested()) return first;
  if (lessons_ && lessons_->first() == first)
    lessons_->begin(pass.seed);
  else
    lessons_ = std::make_unique<VcmLessons>(scene_, first, settings_, pass.seed);
  return first;
}

bool VcmIntegrator::make_up(const Pass& pass, uint32_t until, std::stop_token stop,
                            const ProgressFunction& progress, uint32_t& made_up,
                            PassReport& report) const {
  const uint32_t count = until - std::min(until, lessons_->passes());
  for (made_up = 0; made_up < count; ++made_up) {
    Pass missing = pass;
    missing.index = lessons_->passes();
    learn_missing(lessons_->plans_of(lessons_->epoch_begin(missing.index), stop, report.rays),
                  missing, stop, part_of(progress, made_up, count + 1), report);
    if (stop.stop_requested()) return false;
  }
  return true;
}

std::shared_ptr<const VcmPlans> VcmIntegrator::plans_for(const Pass& pass, std::stop_token stop,
                                                         const ProgressFunction& progress,
                                                         uint32_t& made_up,
                                                         PassReport& report) const {
  const std::lock_guard lock(learning_mutex_);
  if (fixed_) return fixed_;
  return isolated([&] {
    auto first = begin_lessons(pass, stop, report);
    if (stop.stop_requested()) return first;
    const uint32_t begin = lessons_->epoch_begin(pass.index);
    if (!make_up(pass, begin, stop, progress, made_up, report)) return first;
    return lessons_->plans_of(begin, stop, report.rays);
  });
}

void VcmIntegrator::learn_missing(std::shared_ptr<const VcmPlans> plans, const Pass& missing,
                                  std::stop_token stop, const ProgressFunction& progress,
                                  PassReport& report) const {
  if (!lessons_->wants(missing.index)) return lessons_->skip();
  SplatBuffer nowhere({{1, 1}, {0, 0}, {1, 1}, {}, 0}, ComponentSet());
  State state(plans, weights_for(*plans, missing), missing);
  // Nobody sees its splats; what camera samples connect to is of use for these alone.
  PathWeights::Settings unseen = state.weights.settings();
  unseen.techniques.splats = false;
  unseen.techniques.connections =
      unseen.techniques.connections && lessons_->wants_samples(missing.index);
  trace_light(state, missing, PathWeights(unseen), nowhere, stop, progress);
  take_lesson(state, missing, stop);
  report.rays += state.report.rays;
  report.photons += state.report.photons;
}

void VcmIntegrator::take_lesson(State& state, const Pass& pass, const std::stop_token& stop) const {
  const PlanWindow& window = state.plans->pixels.seen().grid().window();
  const TakeSample sample = [&](const Vec2f& raster, Sampler& sampler, SampleSink& sink) {
    trace_sample(state, window.in_crop(raster), sampler, sink);
  };
  lessons_->learn({.pass = pass, .light = state.light, .sample = sample}, stop, state.report.rays);
}

void VcmIntegrator::take_lesson_if_next(State& state, const Pass& pass,
                                        const std::stop_token& stop) const {
  const std::lock_guard lock(learning_mutex_);
  // Passes out of order are traced anew where they are needed.
  if (fixed_ || !lessons_ || !lessons_->expects(pass)) return;
  isolated([&] {
    if (lessons_->wants(pass.index))
      take_lesson(state, pass, stop);
    else
      lessons_->skip();
  });
}

Lessons VcmIntegrator::lessons() const {
  const std::lock_guard lock(learning_mutex_);
  if (!lessons_ || lessons_->end() == 0) return {};
  ByteWriter writer;
  lessons_->write(writer);
  return {lessons_->passes(), writer.take()};
}

void VcmIntegrator::go_on_with(const Lessons& lessons, LessonUse use) {
  ByteReader reader(lessons.bytes, "what was learned");
  const std::lock_guard lock(learning_mutex_);
  isolated([&] {
    lessons_ = VcmLessons::read(reader, scene_, settings_, *plain_);
    if (lessons_->passes() != lessons.passes) reader.damaged("it is of another number of passes");
    uint64_t rays = 0;
    if (use == LessonUse::fixed) fixed_ = lessons_->fixed_plans({}, rays);
  });
}

PassReport VcmIntegrator::learn(const Pass& pass, std::stop_token stop,
                                const ProgressFunction& progress) const {
  PassReport report;
  const std::lock_guard lock(learning_mutex_);
  if (fixed_) return report;
  isolated([&] {
    uint32_t made_up = 0;
    begin_lessons(pass, stop, report);
    if (!stop.stop_requested() &&
        make_up(pass, std::min(pass.index, lessons_->end()), stop, progress, made_up, report))
      report.decisions = lessons_->fixed_plans(stop, report.rays)->decisions;
  });
  return report;
}

PathWeights VcmIntegrator::weights_for(const VcmPlans& plans, const Pass& pass) const {
  PathWeights::Settings weights;
  weights.techniques = plans.techniques;
  weights.light_paths =
      float(light_path_count(scene_.film(), pass.samples_per_pixel, plans.light_paths));
  weights.connections = float(settings_.connections) / plans.connectible_per_path;
  weights.merge_area = plans.pixels.other_area() * sqr(pass_radius(1, pass.index));
  weights.accepted_area = accepted_area(plans.pixels);
  weights.first_medium_share = 1 / float(pass.samples_per_pixel);
  return PathWeights(weights);
}

LightVertices VcmIntegrator::trace(const VcmPlans& plans, const PathWeights& weights,
                                   const Pass& pass, SplatBuffer& splats, std::stop_token stop,
                                   const ProgressFunction& progress, PassReport& report) const {
  const float shrinkage = sqr(pass_radius(1, pass.index));
  return trace_light_vertices(
      {scene_, *plans.emission, weights, settings_.components, settings_.maximum_events,
       light_path_count(scene_.film(), pass.samples_per_pixel, plans.light_paths),
       float(pass.samples_per_pixel), plans.pixels, shrinkage,
       fixed_ ? 0 : GuideLesson::remembered_paths(pass.index, plans), plans.media.shrunk(shrinkage),
       plans.scattering.get(), plans.scattering != nullptr},
      pass, Stream::light_path, splats, stop, progress, report);
}

void VcmIntegrator::trace_light(State& state, const Pass& pass, const PathWeights& weights,
                                SplatBuffer& splats, std::stop_token stop,
                                const ProgressFunction& progress) const {
  if (!state.plans->techniques.needs_light_paths()) return;
  state.light = trace(*state.plans, weights, pass, splats, stop, progress, state.report);
  if (state.plans->techniques.merging) state.matt = MattMerging(state.light, state.weights);
  state.connection_scale =
      float(double(state.light.connectible.size()) /
            (double(settings_.connections) * double(state.light.connectible_paths())));
}

std::unique_ptr<PassState> VcmIntegrator::prepare(const Pass& pass, SplatBuffer& splats,
                                                  std::stop_token stop,
                                                  const ProgressFunction& progress) const {
  uint32_t made_up = 0;
  PassReport report;
  const auto plans = plans_for(pass, stop, progress, made_up, report);
  auto state = std::make_unique<State>(plans, weights_for(*plans, pass), pass);
  state->report = std::move(report);
  state->report.decisions.insert(state->report.decisions.end(), plans->decisions.begin(),
                                 plans->decisions.end());
  if (!plans->techniques.any())
    state->report.warnings.emplace_back(
        "all techniques are switched off: only lights that the camera sees straight are there; "
        "switch on unidirectional, next_event, splats, connections or merging");
  trace_light(*state, pass, state->weights, splats, stop, part_of(progress, made_up, made_up + 1));
  if (!stop.stop_requested()) take_lesson_if_next(*state, pass, stop);
  return state;
}

PixelSamples VcmIntegrator::pixel_samples(const PassState& state, const Pass& pass,
                                          const Vec2i& pixel) const {
  const VcmPlans& plans = *static_cast<const State&>(state).plans;
  const SampleSpread* spread = plans.pixels.spread().get();
  // Fixed plans may be of passes with another number of samples.
  if (!spread || plans.samples_per_pixel != pass.samples_per_pixel)
    return Integrator::pixel_samples(state, pass, pixel);
  const size_t block = plans.pixels.seen().grid().index_at(Vec2f(float(pixel.x), float(pixel.y)));
  const uint32_t count = spread->counts[block];
  const uint32_t rounds = (pass.index - spread->begin) / replicate_count;
  return {spread->first_indices[block] + rounds * count, count};
}

void VcmIntegrator::sample(const PassState& pass_state, const Vec2f& raster, Sampler& sampler,
                           SampleSink& sink) const {
  const auto& state = static_cast<const State&>(pass_state);
  trace_sample(state, raster, sampler, sink);
}

void VcmIntegrator::trace_sample(const State& state, const Vec2f& raster, Sampler& sampler,
                                 SampleSink& sink) const {
  const PathWeights::Settings& weights = state.weights.settings();
  trace_camera_path({.scene = scene_,
                     .emission = *state.plans->emission,
                     .weights = state.weights,
                     .light = state.light,
                     .matt = state.matt,
                     .seen = state.plans->pixels.seen(),
                     .camera_samples = state.camera_samples,
                     .connection_scale = state.connection_scale,
                     .merge_radius_sq = weights.merge_area * inv_pi,
                     .media = state.media,
                     .maximum_events = settings_.maximum_events,
                     .roulette_depth = settings_.roulette_depth,
                     .connections = settings_.connections,
                     .scattering = state.plans->scattering.get(),
                     .visibility = settings_.visibility},
                    state.plans->pixels.at(raster, state.shrinkage), raster, sampler, sink);
}

}  // namespace kaustik
