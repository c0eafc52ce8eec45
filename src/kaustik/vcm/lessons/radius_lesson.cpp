#include "kaustik/vcm/lessons/radius_lesson.h"

#include "kaustik/photon/photon_map.h"

namespace kaustik {
namespace {

struct RadiusSums final : LessonSums {
  std::vector<RadiusLearning::Sums> of_probes;
};

}  // namespace

RadiusLesson::RadiusLesson(const Scene& scene, const VcmPlans& first, ComponentSet wanted)
    : scene_(scene), first_(first), wanted_(wanted), sums_(first.pixels.seen().probes().size()) {}

void RadiusLesson::begin() { sums_.assign(sums_.size(), {}); }

std::unique_ptr<LessonSums> RadiusLesson::sums_of(const TaughtPass& taught, const std::stop_token&,
                                                  uint64_t&) const {
  auto sums = std::make_unique<RadiusSums>();
  sums->of_probes = RadiusLearning::sums_of(first_.pixels, taught.light, wanted_, sums_);
  return sums;
}

void RadiusLesson::add(uint32_t, const LessonSums& sums) {
  const auto& added = static_cast<const RadiusSums&>(sums).of_probes;
  for (size_t i = 0; i < added.size(); ++i) sums_[i].add(added[i]);
}

void RadiusLesson::apply(VcmPlans& plans, uint32_t epoch, const std::stop_token& stop,
                         uint64_t& rays) {
  if (!radii_) {
    RadiusLearning made(scene_, first_.pixels, rays, stop);
    if (stop.stop_requested()) return;
    radii_ = std::move(made);
  }
  const float shrinkage = sqr(pass_radius(1, epoch));
  // First, so that plans are the same if they are asked for once more.
  RadiusLearning::narrow(sums_, epoch);
  plans.settle(radii_->plans(first_.pixels, sums_, epoch, shrinkage), shrinkage);
}

void RadiusLesson::read(ByteReader& reader) {
  sums_ = reader.get_array<RadiusLearning::Sums>(sums_.size());
  for (const RadiusLearning::Sums& sums : sums_)
    if (sums.levels < 1 || sums.levels > size_t(RadiusLearning::level_count))
      reader.damaged("a probe in it has another number of disks");
}

}  // namespace kaustik
