#include <fmt/format.h>

#include <bit>

#include "kaustik/vcm/lessons/lesson_kinds.h"

namespace kaustik {
namespace {

struct GuideSums final : LessonSums {
  explicit GuideSums(LightPathUse::Seen of_pass) : seen(std::move(of_pass)) {}
  void write(ByteWriter& writer) const override { seen.write(writer); }

  LightPathUse::Seen seen;
};

class GuideLesson final : public Lesson {
 public:
  explicit GuideLesson(const LessonInputs& in)
      : first_(in.first),
        pilot_(in.use ? in.use
                      : std::make_shared<const LightPathUse>(in.scene, in.plain,
                                                             in.settings.components)) {
    forget();
  }

  void begin() override { forget(); }
  uint32_t end() const override { return most_passes; }
  /// Of each epoch the last pass.
  LessonNeeds needs_of(uint32_t pass) const override {
    if (!std::has_single_bit(pass + 1)) return {};
    return {.light = true, .remembered_paths = LightPathUse::most_paths};
  }
  std::unique_ptr<LessonSums> sums_of(const TaughtPass& taught,
                                      const std::stop_token& stop) const override {
    return std::make_unique<GuideSums>(use_->seen_in(*taught.light.front(), stop));
  }
  std::unique_ptr<LessonSums> read_sums(ByteReader& reader) const override {
    return std::make_unique<GuideSums>(use_->read_seen(reader));
  }
  void add(uint32_t, const LessonSums& sums) override {
    use_->learn(static_cast<const GuideSums&>(sums).seen);
  }
  void apply(VcmPlans& plans, uint32_t epoch, const std::stop_token& stop, uint64_t&) override {
    if (epoch <= most_passes) plans.guides = plans.guides.guided_by(*use_, stop);
  }
  std::string decision(const VcmPlans& plans, uint32_t epoch) const override;
  void write(ByteWriter& writer) const override {
    pilot_->write(writer);
    use_->write(writer);
  }
  void read(ByteReader& reader) override {
    auto pilot = std::make_shared<LightPathUse>(*pilot_);
    pilot->read(reader);
    pilot_ = std::move(pilot);
    forget();
    use_->read(reader);
  }

 private:
  void forget() { use_ = std::make_unique<LightPathUse>(*pilot_); }

  static constexpr uint32_t most_passes = 16;

  const VcmPlans& first_;
  std::shared_ptr<const LightPathUse> pilot_;  ///< what passes of every seed go on from
  std::unique_ptr<LightPathUse> use_;
};

std::string GuideLesson::decision(const VcmPlans& plans, uint32_t) const {
  std::vector<std::string> parts;
  if (const LightPathEmission& emission = *plans.guides.emission; emission.is_guided()) {
    parts.emplace_back("light paths choose lamps and directions by which paths were of use");
    if (const size_t lamps = emission.guided_lights(); lamps > 0)
      parts.push_back(fmt::format("{} of {} lamps have learned directions", lamps,
                                  emission.scene().lights().size()));
  }
  if (first_.guides.scattering && !plans.guides.scattering)
    parts.emplace_back("guiding light paths at matt surfaces no longer pays: it is switched off");
  return fmt::format("{}", fmt::join(parts, "; "));
}

}  // namespace

std::unique_ptr<Lesson> make_guide_lesson(const LessonInputs& in) {
  if (!in.settings.guides_light_paths() || !in.first.techniques.needs_light_paths()) return nullptr;
  return std::make_unique<GuideLesson>(in);
}

}  // namespace kaustik
