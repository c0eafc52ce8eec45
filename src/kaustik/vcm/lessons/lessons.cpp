#include "kaustik/vcm/lessons/lessons.h"

#include <algorithm>
#include <bit>

#include "kaustik/vcm/lessons/lesson_kinds.h"
#include "kaustik/vcm/plan/plans_file.h"

namespace kaustik {

VcmLessons::VcmLessons(const Scene& scene, const VcmSettings& settings,
                       const LightPathEmission& plain, const FirstPlans& first, uint64_t seed)
    : scene_(scene),
      settings_(settings),
      first_(first.plans),
      seed_(seed),
      lessons_(make_lessons({.scene = scene,
                             .settings = settings,
                             .plain = plain,
                             .first = *first_,
                             .use = first.use,
                             .radii = first.radii})),
      epochs_{{0, first_}} {
  for (const auto& lesson : lessons_) end_ = std::max(end_, lesson->end());
}

void VcmLessons::begin(uint64_t seed) {
  seed_ = seed;
  passes_ = 0;
  epochs_ = {{0, first_}};
  for (const auto& lesson : lessons_) lesson->begin();
}

uint32_t VcmLessons::epoch_begin(uint32_t pass) const {
  return std::min(end_, std::bit_floor(pass));
}

bool VcmLessons::serve(const Pass& pass) const {
  const uint32_t epoch = epoch_begin(pass.stage());
  return seed_ == pass.seed && first_->samples_per_pixel == pass.samples_per_pixel &&
         (epochs_.contains(epoch) || epoch >= passes_);
}

std::optional<uint32_t> VcmLessons::epoch_end(uint32_t pass) const {
  const uint32_t begin = epoch_begin(pass);
  if (begin >= end_) return std::nullopt;
  return std::min(end_, std::max(1u, 2 * begin));
}

bool VcmLessons::can_teach(const Pass& pass) const {
  // Sums of an epoch whose plans are still to be made stay as they are.
  return !pass.is_regional() && serve(pass) && pass.index < end_ &&
         epochs_.contains(epoch_begin(pass.index));
}

bool VcmLessons::is_next(const Pass& pass) const {
  return can_teach(pass) && passes_ == pass.index;
}

LessonNeeds VcmLessons::needs_of(uint32_t pass) const {
  LessonNeeds needs;
  for (const auto& lesson : lessons_)
    if (pass < lesson->end()) needs = needs.with(lesson->needs_of(pass));
  return needs;
}

std::vector<Lesson*> VcmLessons::taught_by(uint32_t pass) const {
  std::vector<Lesson*> taught;
  for (const auto& lesson : lessons_)
    if (pass < lesson->end() && lesson->needs_of(pass).any()) taught.push_back(lesson.get());
  return taught;
}

std::vector<std::unique_ptr<LessonSums>> VcmLessons::sums_of(const VcmPass& traced,
                                                             const std::vector<Lesson*>& lessons,
                                                             const std::stop_token& stop,
                                                             uint64_t& rays) const {
  const BlockGrid& grid = traced.plans().pixels.seen().grid();
  const TakeSample sample = [&](const Vec2f& raster, Sampler& sampler, SampleSink& sink) {
    traced.sample(grid.window().in_crop(raster), sampler, sink);
  };
  std::vector<std::unique_ptr<LessonSums>> sums;
  for (const Lesson* lesson : lessons) {
    const std::vector<TrainingPlace> places = lesson->places(traced.pass());
    const std::vector<TrainingPair> pairs = training_pairs({.grid = grid,
                                                            .filter = scene_.film().filter,
                                                            .components = settings_.components,
                                                            .pass = traced.pass(),
                                                            .take = sample},
                                                           places, stop);
    for (const TrainingPair& pair : pairs) rays += pair.rays[0] + pair.rays[1];
    if (stop.stop_requested()) return {};
    sums.push_back(
        lesson->sums_of({.light = traced.light_of_sets(), .places = places, .pairs = pairs}, stop));
  }
  if (stop.stop_requested()) return {};
  return sums;
}

void VcmLessons::add(const std::vector<Lesson*>& lessons,
                     const std::vector<std::unique_ptr<LessonSums>>& sums) {
  for (size_t i = 0; i < lessons.size(); ++i) lessons[i]->add(passes_, *sums[i]);
  ++passes_;
}

void VcmLessons::take(const VcmPass& traced, const std::stop_token& stop, uint64_t& rays) {
  const std::vector<Lesson*> lessons = taught_by(passes_);
  const auto sums = sums_of(traced, lessons, stop, rays);
  if (!stop.stop_requested()) add(lessons, sums);
}

bool VcmLessons::write_taught(const VcmPass& traced, ByteWriter& writer,
                              const std::stop_token& stop, uint64_t& rays) const {
  const Pass& pass = traced.pass();
  if (!can_teach(pass)) return false;
  const std::vector<Lesson*> lessons = taught_by(pass.index);
  const auto sums = sums_of(traced, lessons, stop, rays);
  if (stop.stop_requested()) return false;
  writer.put(uint64_t(lessons.size()));
  for (const auto& of_lesson : sums) of_lesson->write(writer);
  return true;
}

void VcmLessons::add_taught(const Pass& pass, ByteReader& reader) {
  if (!is_next(pass)) return;
  const std::vector<Lesson*> lessons = taught_by(pass.index);
  if (reader.get<uint64_t>() != lessons.size()) reader.damaged("it is of other lessons");
  std::vector<std::unique_ptr<LessonSums>> sums;
  for (const Lesson* lesson : lessons) sums.push_back(lesson->read_sums(reader));
  reader.expect_end();
  add(lessons, sums);
}

void VcmLessons::learn(const VcmPass& traced, const std::stop_token& stop, uint64_t& rays) {
  if (is_next(traced.pass())) take(traced, stop, rays);
}

void VcmLessons::trace_next(const Pass& next, const std::stop_token& stop,
                            const ProgressFunction& progress, PassReport& report) {
  const auto plans = plans_of(epoch_begin(next.index), stop, report.rays);
  if (stop.stop_requested()) return;
  const LessonNeeds needs = needs_of(next.index);
  if (!needs.any()) {
    ++passes_;
    return;
  }
  VcmPass missing(scene_, settings_, plans, next);
  // Nobody sees its splats; what camera samples connect to is of use for these alone.
  SplatBuffer nowhere = SplatBuffer::nowhere();
  missing.trace_light({.splats = false,
                       .connections = needs.pairs,
                       .cache = needs.pairs,
                       .remembered_paths = needs.remembered_paths},
                      nowhere, stop, progress, report);
  take(missing, stop, report.rays);
}

uint32_t VcmLessons::make_up(const Pass& pass, uint32_t until, const std::stop_token& stop,
                             const ProgressFunction& progress, PassReport& report) {
  const uint32_t count = until - std::min(until, passes_);
  for (uint32_t i = 0; i < count && !stop.stop_requested(); ++i) {
    Pass missing = pass;
    missing.index = passes_;
    missing.wavelengths = pass.wavelengths.of_other_pass(pass.seed, passes_);
    trace_next(missing, stop, part_of(progress, i, count + 1), report);
  }
  return count;
}

PassPlans VcmLessons::plans_for(const Pass& pass, const std::stop_token& stop,
                                const ProgressFunction& progress, PassReport& report) {
  const uint32_t begin = epoch_begin(pass.stage());
  PassPlans result;
  result.made_up = make_up(pass, begin, stop, progress, report);
  result.plans = stop.stop_requested() ? first_ : plans_of(begin, stop, report.rays);
  // Regional passes teach nothing.
  if (!pass.is_regional()) result.remembered_paths = needs_of(pass.index).remembered_paths;
  return result;
}

std::shared_ptr<const VcmPlans> VcmLessons::made_plans(uint32_t epoch, const std::stop_token& stop,
                                                       uint64_t& rays) {
  auto plans = std::make_shared<VcmPlans>(*epochs_.rbegin()->second);
  plans->decisions = first_->decisions;
  for (const auto& lesson : lessons_) lesson->apply(*plans, epoch, stop, rays);
  if (stop.stop_requested()) return first_;
  for (const auto& lesson : lessons_)
    if (std::string text = lesson->decision(*plans, epoch); !text.empty())
      plans->decisions.push_back(std::move(text));
  return plans;
}

std::shared_ptr<const VcmPlans> VcmLessons::plans_of(uint32_t epoch, const std::stop_token& stop,
                                                     uint64_t& rays) {
  const auto found = epochs_.find(epoch);
  if (found != epochs_.end()) return found->second;
  auto plans = made_plans(epoch, stop, rays);
  if (!stop.stop_requested()) epochs_[epoch] = plans;
  return plans;
}

std::shared_ptr<const VcmPlans> VcmLessons::fixed_plans(const std::stop_token& stop,
                                                        uint64_t& rays) {
  const auto found = epochs_.find(passes_);
  const auto last = found != epochs_.end() ? found->second : made_plans(passes_, stop, rays);
  return std::make_shared<const VcmPlans>(last->begun_anew(passes_));
}

void VcmLessons::write(ByteWriter& writer) const {
  writer.put(seed_);
  writer.put(passes_);
  write_plans(writer, *first_);
  const auto& [epoch, plans] = *epochs_.rbegin();
  writer.put(epoch);
  write_plans(writer, *plans);
  for (const auto& lesson : lessons_) lesson->write(writer);
}

std::unique_ptr<VcmLessons> VcmLessons::read(ByteReader& reader, const Scene& scene,
                                             const VcmSettings& settings,
                                             const LightPathEmission& plain) {
  const auto seed = reader.get<uint64_t>();
  const auto passes = reader.get<uint32_t>();
  PlansReader plans(reader, scene, settings, plain);
  const FirstPlans first{.plans = std::make_shared<const VcmPlans>(plans.next())};
  const auto epoch = reader.get<uint32_t>();
  auto of_epoch = std::make_shared<const VcmPlans>(plans.next());
  auto lessons = std::make_unique<VcmLessons>(scene, settings, plain, first, seed);
  for (const auto& lesson : lessons->lessons_) lesson->read(reader);
  reader.expect_end();
  if (epoch > passes || (epoch > 0 && epoch != lessons->epoch_begin(epoch)))
    reader.damaged("its passes belong to no epoch");
  lessons->passes_ = passes;
  lessons->epochs_ = {{epoch, std::move(of_epoch)}};
  return lessons;
}

}  // namespace kaustik
