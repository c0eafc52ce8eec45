#pragma once
#include "kaustik/vcm/lessons/lesson.h"
#include "kaustik/vcm/lessons/sample_learning.h"

namespace kaustik {

/// Camera samples go where those of the passes before differed: SampleLearning.
class SampleLesson final : public Lesson {
 public:
  /// `first` are the plans of the first pass.
  SampleLesson(const Scene& scene, const VcmPlans& first, ComponentSet wanted);

  void begin() override { samples_ = nothing_; }
  uint32_t end() const override { return SampleLearning::most_passes; }
  bool wants(uint32_t pass) const override { return pass < end(); }
  bool wants_samples(uint32_t pass) const override { return pass < end(); }
  std::unique_ptr<LessonSums> sums_of(const TaughtPass& taught, const std::stop_token& stop,
                                      uint64_t& rays) const override;
  void add(uint32_t pass, const LessonSums& sums) override;
  void apply(VcmPlans& plans, uint32_t epoch, const std::stop_token& stop, uint64_t& rays) override;
  void write(ByteWriter& writer) const override { samples_.write(writer); }
  void read(ByteReader& reader) override { samples_.read(reader); }

 private:
  const Scene& scene_;
  ComponentSet wanted_;
  const SampleLearning nothing_;
  SampleLearning samples_;
};

}  // namespace kaustik
