#include <fmt/format.h>

#include <algorithm>

#include "kaustik/vcm/lessons/lesson_kinds.h"
#include "kaustik/vcm/lessons/sample_learning.h"

namespace kaustik {
namespace {

struct SampleSums final : LessonSums {
  explicit SampleSums(std::vector<SampleLearning::Sums> sums) : of_blocks(std::move(sums)) {}
  void write(ByteWriter& writer) const override { writer.put_array(of_blocks); }

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

class SampleLesson final : public Lesson {
 public:
  explicit SampleLesson(const LessonInputs& in)
      : nothing_(in.first.pixels.seen().grid(), !in.first.techniques.needs_light_paths()),
        samples_(nothing_) {}

  void begin() override { samples_ = nothing_; }
  uint32_t end() const override { return SampleLearning::most_passes; }
  LessonNeeds needs_of(uint32_t) const override { return {.pairs = true}; }
  std::vector<TrainingPlace> places(const Pass& pass) const override {
    return samples_.places(pass.index);
  }
  std::unique_ptr<LessonSums> sums_of(const TaughtPass& taught,
                                      const std::stop_token&) const override {
    return std::make_unique<SampleSums>(samples_.sums_of(taught.places, taught.pairs));
  }
  std::unique_ptr<LessonSums> read_sums(ByteReader& reader) const override {
    return std::make_unique<SampleSums>(
        reader.get_array<SampleLearning::Sums>(samples_.block_count()));
  }
  void add(uint32_t pass, const LessonSums& sums) override {
    samples_.learn(static_cast<const SampleSums&>(sums).of_blocks, pass);
  }
  void apply(VcmPlans& plans, uint32_t epoch, const std::stop_token& stop, uint64_t& rays) override;
  std::string decision(const VcmPlans& plans, uint32_t epoch) const override;
  void write(ByteWriter& writer) const override { samples_.write(writer); }
  void read(ByteReader& reader) override { samples_.read(reader); }

 private:
  const SampleLearning nothing_;
  SampleLearning samples_;
};

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

std::string SampleLesson::decision(const VcmPlans& plans, uint32_t) const {
  const std::shared_ptr<const SampleSpread> spread = plans.pixels.spread();
  if (!spread) return {};
  const auto [least, most] = std::minmax_element(spread->counts.begin(), spread->counts.end());
  if (*least == *most) return {};
  return fmt::format(
      "pixels get {} to {} samples in a pass, by how much those of the passes "
      "before differ",
      *least, *most);
}

}  // namespace

std::unique_ptr<Lesson> make_sample_lesson(const LessonInputs& in) {
  if (!in.settings.adaptive || !in.first.pilot || in.first.samples_per_pixel < 2) return nullptr;
  return std::make_unique<SampleLesson>(in);
}

}  // namespace kaustik
