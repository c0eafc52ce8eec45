#include "kaustik/vcm/lessons/guide_lesson.h"

#include <bit>

namespace kaustik {
namespace {

struct GuideSums final : LessonSums {
  LightPathUse::Seen seen;
};

}  // namespace

bool GuideLesson::teaches(uint32_t pass) {
  return pass < most_passes && std::has_single_bit(pass + 1);
}

std::unique_ptr<LessonSums> GuideLesson::sums_of(const TaughtPass& taught, const std::stop_token&,
                                                 uint64_t&) const {
  auto sums = std::make_unique<GuideSums>();
  sums->seen = use_->seen_in(taught.light);
  return sums;
}

void GuideLesson::add(uint32_t, const LessonSums& sums) {
  use_->learn(static_cast<const GuideSums&>(sums).seen);
}

void GuideLesson::apply(VcmPlans& plans, uint32_t epoch, const std::stop_token&, uint64_t&) {
  if (epoch <= most_passes) plans.guide_by(*use_);
}

}  // namespace kaustik
