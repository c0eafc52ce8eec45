#pragma once
#include <optional>

#include "kaustik/vcm/lessons/lesson.h"
#include "kaustik/vcm/lessons/radius_learning.h"

namespace kaustik {

/// Radii of merging by the light paths of the passes before: RadiusLearning.
class RadiusLesson final : public Lesson {
 public:
  /// `first` are the plans of the first pass. All must outlive this.
  RadiusLesson(const Scene& scene, const VcmPlans& first, ComponentSet wanted);

  void begin() override;
  uint32_t end() const override { return most_passes; }
  bool wants(uint32_t) const override { return true; }
  std::unique_ptr<LessonSums> sums_of(const TaughtPass& taught, const std::stop_token& stop,
                                      uint64_t& rays) const override;
  void add(uint32_t pass, const LessonSums& sums) override;
  void apply(VcmPlans& plans, uint32_t epoch, const std::stop_token& stop, uint64_t& rays) override;
  void write(ByteWriter& writer) const override { writer.put_array(sums_); }
  void read(ByteReader& reader) override;

 private:
  static constexpr uint32_t most_passes = 256;

  const Scene& scene_;
  const VcmPlans& first_;
  ComponentSet wanted_;
  std::optional<RadiusLearning> radii_;  ///< made when it is first asked for: that traces rays
  std::vector<RadiusLearning::Sums> sums_;
};

}  // namespace kaustik
