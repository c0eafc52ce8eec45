#pragma once
#include "kaustik/vcm/lessons/lesson.h"
#include "kaustik/vcm/lessons/light_path_use.h"

namespace kaustik {

/// Light paths begin, and go on from matt surfaces, as those of the passes before were of use:
/// LightPathUse.
class GuideLesson final : public Lesson {
 public:
  /// Goes on from what the pilot's light paths taught; that must outlive this.
  explicit GuideLesson(const LightPathUse& pilot) : pilot_(pilot) { begin(); }

  void begin() override { use_ = std::make_unique<LightPathUse>(pilot_); }
  uint32_t end() const override { return most_passes; }
  bool wants(uint32_t pass) const override { return teaches(pass); }
  std::unique_ptr<LessonSums> sums_of(const TaughtPass& taught, const std::stop_token& stop,
                                      uint64_t& rays) const override;
  void add(uint32_t pass, const LessonSums& sums) override;
  void apply(VcmPlans& plans, uint32_t epoch, const std::stop_token& stop, uint64_t& rays) override;
  void write(ByteWriter& writer) const override { use_->write(writer); }
  void read(ByteReader& reader) override { use_->read(reader); }

  /// Paths whose beginnings a pass with such plans is to remember.
  static uint32_t remembered_paths(uint32_t pass, const VcmPlans& plans) {
    return plans.use && teaches(pass) ? LightPathUse::most_paths : 0;
  }

 private:
  static constexpr uint32_t most_passes = 16;
  /// Of each epoch the last pass.
  static bool teaches(uint32_t pass);

  const LightPathUse& pilot_;
  std::unique_ptr<LightPathUse> use_;
};

}  // namespace kaustik
