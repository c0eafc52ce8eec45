#include "kaustik/vcm/learning.h"

#include <algorithm>

#include "kaustik/base/parallel.h"

namespace kaustik {

// Whoever waits in parallel work may take up other work meanwhile: with the mutex held it must be
// isolated, or that might want it, too.

FirstPlans VcmLearning::first_plans(uint32_t samples_per_pixel, const std::stop_token& stop,
                                    PassReport& report) {
  if (first_.plans && first_.plans->samples_per_pixel == samples_per_pixel) return first_;
  const FirstPlans made = VcmPlanner(scene_, settings_, plain_).make(samples_per_pixel, stop);
  report.rays += made.rays;
  if (!stop.stop_requested()) first_ = made;
  return made;
}

std::shared_ptr<const VcmPlans> VcmLearning::begin_lessons(const Pass& pass,
                                                           const std::stop_token& stop,
                                                           PassReport& report) {
  if (lessons_ && lessons_->serve(pass)) return lessons_->first();
  const FirstPlans first = first_plans(pass.samples_per_pixel, stop, report);
  if (stop.stop_requested()) return first.plans;
  if (lessons_ && lessons_->first() == first.plans)
    lessons_->begin(pass.seed);
  else
    lessons_ = std::make_unique<VcmLessons>(scene_, settings_, *plain_, first, pass.seed);
  return first.plans;
}

PassPlans VcmLearning::plans_for(const Pass& pass, const std::stop_token& stop,
                                 const ProgressFunction& progress, PassReport& report) {
  const std::lock_guard lock(mutex_);
  if (fixed_) return {.plans = fixed_};
  return isolated([&]() -> PassPlans {
    auto first = begin_lessons(pass, stop, report);
    if (stop.stop_requested()) return {.plans = std::move(first)};
    return lessons_->plans_for(pass, stop, progress, report);
  });
}

void VcmLearning::learn_from(const VcmPass& traced, const std::stop_token& stop, uint64_t& rays) {
  const std::lock_guard lock(mutex_);
  if (fixed_ || !lessons_) return;
  isolated([&] {
    if (!is_shared_) return lessons_->learn(traced, stop, rays);
    ByteWriter writer;
    if (lessons_->write_taught(traced, writer, stop, rays))
      taught_[traced.pass().index] = writer.take();
  });
}

SharedLessons* VcmLearning::share() {
  const std::lock_guard lock(mutex_);
  is_shared_ = true;
  return fixed_ ? nullptr : this;
}

std::optional<uint32_t> VcmLearning::epoch_end(uint32_t pass) const {
  const std::lock_guard lock(mutex_);
  return lessons_ ? lessons_->epoch_end(pass) : std::nullopt;
}

Lessons VcmLearning::lessons_for(const Pass& pass, const std::stop_token& stop,
                                 const ProgressFunction& progress, PassReport& report) {
  const std::lock_guard lock(mutex_);
  return isolated([&]() -> Lessons {
    begin_lessons(pass, stop, report);
    if (stop.stop_requested()) return {};
    lessons_->plans_for(pass, stop, progress, report);
    return written_lessons();
  });
}

std::vector<uint8_t> VcmLearning::take_taught(uint32_t pass) {
  const std::lock_guard lock(mutex_);
  const auto found = taught_.extract(pass);
  return found.empty() ? std::vector<uint8_t>() : std::move(found.mapped());
}

void VcmLearning::add_taught(const Pass& pass, const std::vector<uint8_t>& taught) {
  const std::lock_guard lock(mutex_);
  if (taught.empty() || !lessons_) return;
  ByteReader reader(taught, "what a pass has taught");
  lessons_->add_taught(pass, reader);
}

PassReport VcmLearning::learn(const Pass& pass, const std::stop_token& stop,
                              const ProgressFunction& progress) {
  PassReport report;
  const std::lock_guard lock(mutex_);
  if (fixed_) return report;
  report.warnings = settings_.warnings;
  isolated([&] {
    begin_lessons(pass, stop, report);
    if (stop.stop_requested()) return;
    lessons_->make_up(pass, std::min(pass.index, lessons_->end()), stop, progress, report);
    if (!stop.stop_requested())
      report.decisions = lessons_->fixed_plans(stop, report.rays)->decisions;
  });
  return report;
}

Lessons VcmLearning::lessons() const {
  const std::lock_guard lock(mutex_);
  return written_lessons();
}

Lessons VcmLearning::written_lessons() const {
  if (!lessons_ || lessons_->end() == 0) return {};
  ByteWriter writer;
  lessons_->write(writer);
  return {lessons_->passes(), writer.take()};
}

void VcmLearning::go_on_with(const Lessons& lessons, LessonUse use) {
  ByteReader reader(lessons.bytes, "what was learned");
  const std::lock_guard lock(mutex_);
  isolated([&] {
    lessons_ = VcmLessons::read(reader, scene_, settings_, *plain_);
    if (lessons_->passes() != lessons.passes) reader.damaged("it is of another number of passes");
    uint64_t rays = 0;
    if (use == LessonUse::fixed) fixed_ = lessons_->fixed_plans({}, rays);
  });
}

}  // namespace kaustik
