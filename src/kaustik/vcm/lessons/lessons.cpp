#include "kaustik/vcm/lessons/lessons.h"

#include <algorithm>
#include <bit>

#include "kaustik/photon/photon_map.h"
#include "kaustik/vcm/lessons/guide_lesson.h"
#include "kaustik/vcm/lessons/radius_lesson.h"
#include "kaustik/vcm/lessons/sample_lesson.h"
#include "kaustik/vcm/plan/plans_file.h"

namespace kaustik {
namespace {

bool learns_radii(const VcmPlans& plans, const VcmSettings& settings) {
  return plans.techniques.merging && settings.learn_radii && !(settings.radius > 0);
}

bool learns_samples(const VcmPlans& plans, const VcmSettings& settings) {
  // A single sample can't be shared out.
  return settings.adaptive && plans.pilot && plans.samples_per_pixel > 1;
}

bool learns_guides(const VcmPlans& plans) {
  return plans.use && plans.techniques.needs_light_paths();
}

}  // namespace

VcmLessons::VcmLessons(const Scene& scene, std::shared_ptr<const VcmPlans> first,
                       const VcmSettings& settings, uint64_t seed)
    : first_(std::move(first)), seed_(seed) {
  if (learns_radii(*first_, settings))
    lessons_.push_back(std::make_unique<RadiusLesson>(scene, *first_, settings.components));
  if (learns_samples(*first_, settings))
    lessons_.push_back(std::make_unique<SampleLesson>(scene, *first_, settings.components));
  if (learns_guides(*first_)) lessons_.push_back(std::make_unique<GuideLesson>(*first_->use));
  for (const auto& lesson : lessons_) end_ = std::max(end_, lesson->end());
  epochs_ = {{0, first_}};
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

bool VcmLessons::knows_epoch(uint32_t epoch) const {
  return epochs_.contains(epoch) || epoch >= passes_;
}

bool VcmLessons::expects(const Pass& pass) const {
  // Sums of an epoch whose plans are still to be made stay as they are.
  return seed_ == pass.seed && passes_ == pass.index &&
         first_->samples_per_pixel == pass.samples_per_pixel && pass.index < end_ &&
         epochs_.contains(epoch_begin(pass.index));
}

std::vector<Lesson*> VcmLessons::wanted(uint32_t pass) const {
  std::vector<Lesson*> result;
  for (const auto& lesson : lessons_)
    if (pass < lesson->end() && lesson->wants(pass)) result.push_back(lesson.get());
  return result;
}

bool VcmLessons::wants(uint32_t pass) const { return !wanted(pass).empty(); }

bool VcmLessons::wants_samples(uint32_t pass) const {
  return std::any_of(lessons_.begin(), lessons_.end(),
                     [&](const auto& lesson) { return lesson->wants_samples(pass); });
}

void VcmLessons::learn(const TaughtPass& taught, const std::stop_token& stop, uint64_t& rays) {
  std::vector<std::pair<Lesson*, std::unique_ptr<LessonSums>>> sums;
  for (Lesson* lesson : wanted(passes_))
    sums.emplace_back(lesson, lesson->sums_of(taught, stop, rays));
  if (stop.stop_requested()) return;
  for (const auto& [lesson, of_pass] : sums) lesson->add(passes_, *of_pass);
  ++passes_;
}

std::shared_ptr<VcmPlans> VcmLessons::made_plans(uint32_t epoch, const std::stop_token& stop,
                                                 uint64_t& rays) {
  auto plans = std::make_shared<VcmPlans>(*epochs_.rbegin()->second);
  for (const auto& lesson : lessons_) lesson->apply(*plans, epoch, stop, rays);
  return plans;
}

std::shared_ptr<const VcmPlans> VcmLessons::plans_of(uint32_t epoch, const std::stop_token& stop,
                                                     uint64_t& rays) {
  const auto found = epochs_.find(epoch);
  if (found != epochs_.end()) return found->second;
  auto plans = made_plans(epoch, stop, rays);
  if (stop.stop_requested()) return first_;
  return epochs_[epoch] = std::move(plans);
}

std::shared_ptr<const VcmPlans> VcmLessons::fixed_plans(const std::stop_token& stop,
                                                        uint64_t& rays) {
  const auto found = epochs_.find(passes_);
  auto plans = found != epochs_.end() ? std::make_shared<VcmPlans>(*found->second)
                                      : made_plans(passes_, stop, rays);
  if (stop.stop_requested()) return first_;
  // Passes begin with the radii that the last one would have had.
  std::vector<PixelPlan> disks = plans->pixels.plans();
  if (plans->pilot) {
    for (PixelPlan& disk : disks) disk.merge_area *= sqr(pass_radius(1, passes_));
    plans->settle(std::move(disks), 1);
  }
  if (const auto& spread = plans->pixels.spread()) {
    SampleSpread from_begin;
    from_begin.counts = spread->counts;
    from_begin.first_indices.assign(spread->counts.size(), 0);
    from_begin.next_indices = spread->counts;
    plans->pixels.set_spread(std::make_shared<const SampleSpread>(std::move(from_begin)));
  }
  return plans;
}

void VcmLessons::write(ByteWriter& writer) const {
  writer.put(seed_);
  writer.put(passes_);
  write_plans(writer, *first_);
  const auto& [epoch, plans] = *epochs_.rbegin();
  writer.put(epoch);
  write_plans(writer, *plans);
  if (first_->use) first_->use->write(writer);
  for (const auto& lesson : lessons_) lesson->write(writer);
}

std::unique_ptr<VcmLessons> VcmLessons::read(ByteReader& reader, const Scene& scene,
                                             const VcmSettings& settings,
                                             const LightPathEmission& plain) {
  const auto seed = reader.get<uint64_t>();
  const auto passes = reader.get<uint32_t>();
  PlansReader plans(reader, scene, settings, plain);
  VcmPlans first = plans.next();
  const auto epoch = reader.get<uint32_t>();
  std::shared_ptr<const VcmPlans> of_epoch = std::make_shared<const VcmPlans>(plans.next());
  if (first.use) {
    auto use = std::make_shared<LightPathUse>(scene, plain, settings.components);
    use->read(reader);
    first.use = use;
  }
  auto lessons = std::make_unique<VcmLessons>(
      scene, std::make_shared<const VcmPlans>(std::move(first)), settings, seed);
  for (const auto& lesson : lessons->lessons_) lesson->read(reader);
  reader.expect_end();
  if (epoch > passes || (epoch > 0 && epoch != lessons->epoch_begin(epoch)))
    reader.damaged("its passes belong to no epoch");
  lessons->passes_ = passes;
  lessons->epochs_ = {{epoch, of_epoch}};
  return lessons;
}

}  // namespace kaustik
