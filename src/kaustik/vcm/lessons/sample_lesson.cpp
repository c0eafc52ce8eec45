#include "kaustik/vcm/lessons/sample_lesson.h"

#include <algorithm>

namespace kaustik {
namespace {

struct SampleSums final : LessonSums {
  std::vector<SampleLearning::Sums> of_blocks;
};

/// Those of the epoch that begins with pass `begin`, after `before` (null: `samples` everywhere).
/// No index comes twice in a replicate, and as few as can be are left out.
std::shared_ptr<const SampleSpread> spread_of(uint32_t begin, std::vector<uint32_t> counts,
                                              const SampleSpread* before, uint32_t samples) {
  SampleSpread result{begin, std::move(counts), {}, {}};
  // A replicate has one pass at most in all the epochs before the 16th pass.
  const bool is_first_round = begin < replicate_count;
  const uint32_t rounds_before = std::max(1u, begin / replicate_count);
  for (size_t i = 0; i < result.counts.size(); ++i) {
    const uint32_t count = result.counts[i];
    // From a multiple on: whole runs of a sequence stratify one another best.
    const uint32_t before_it = before ? before->next_indices[i] : rounds_before * samples;
    const uint32_t used = (before_it + count - 1) / count * count;
    result.first_indices.push_back(is_first_round ? 0 : used);
    // Epochs are as long as all passes before them.
    result.next_indices.push_back(is_first_round ? std::max(used, count)
                                                 : used + rounds_before * count);
  }
  return std::make_shared<const SampleSpread>(std::move(result));
}

}  // namespace

SampleLesson::SampleLesson(const Scene& scene, const VcmPlans& first, ComponentSet wanted)
    : scene_(scene),
      wanted_(wanted),
      nothing_(first.pixels.seen().grid(), !first.techniques.needs_light_paths()),
      samples_(nothing_) {}

std::unique_ptr<LessonSums> SampleLesson::sums_of(const TaughtPass& taught,
                                                  const std::stop_token& stop,
                                                  uint64_t& rays) const {
  auto sums = std::make_unique<SampleSums>();
  sums->of_blocks =
      samples_.take_samples(scene_.film().filter, wanted_, taught.pass, taught.sample, stop, rays);
  return sums;
}

void SampleLesson::add(uint32_t pass, const LessonSums& sums) {
  samples_.learn(static_cast<const SampleSums&>(sums).of_blocks, pass);
}

void SampleLesson::apply(VcmPlans& plans, uint32_t epoch, const std::stop_token&, uint64_t&) {
  if (epoch < SampleLearning::least_passes || epoch > SampleLearning::most_passes) return;
  const uint32_t samples = plans.samples_per_pixel;
  SampleLearning::Counts found = samples_.counts(samples);
  const std::shared_ptr<const SampleSpread> before = plans.pixels.spread();
  if (found.of_block.empty()) {
    if (!before) return;
    found.of_block.assign(plans.pixels.seen().probes().size(), samples);
  }
  plans.pixels.set_spread(spread_of(epoch, std::move(found.of_block), before.get(), samples));
}

}  // namespace kaustik
