#pragma once
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "kaustik/transport/integrator.h"
#include "kaustik/vcm/lessons/lessons.h"

namespace kaustik {

/// What passes of connection and merging go by: makes the plans of the first one, and has the
/// others taught by those before. Any number of threads may ask.
class VcmLearning : public SharedLessons {
 public:
  /// `scene` and `settings` must outlive this; `plain` is not guided.
  VcmLearning(const Scene& scene, const VcmSettings& settings,
              std::shared_ptr<const LightPathEmission> plain)
      : scene_(scene), settings_(settings), plain_(std::move(plain)) {}

  /// What a pass goes by. Counts what is traced for it. Worth nothing if it was stopped.
  PassPlans plans_for(const Pass& pass, const std::stop_token& stop,
                      const ProgressFunction& progress, PassReport& report);
  /// Learns from a pass of plans_for(), if it is the next one. Counts the rays.
  void learn_from(const VcmPass& traced, const std::stop_token& stop, uint64_t& rays);

  /// From now on what passes teach is kept for take_taught(). Null: plans are fixed.
  SharedLessons* share();
  std::optional<uint32_t> epoch_end(uint32_t pass) const override;
  Lessons lessons_for(const Pass& pass, const std::stop_token& stop,
                      const ProgressFunction& progress, PassReport& report) override;
  void take_over(const Lessons& lessons) override { go_on_with(lessons, LessonUse::go_on); }
  std::vector<uint8_t> take_taught(uint32_t pass) override;
  void add_taught(const Pass& pass, const std::vector<uint8_t>& taught) override;

  // Integrator
  PassReport learn(const Pass& pass, const std::stop_token& stop, const ProgressFunction& progress);
  Lessons lessons() const;
  void go_on_with(const Lessons& lessons, LessonUse use);

 private:
  /// The plans of the first pass; lessons that serve the pass are begun unless there are such.
  /// Worth nothing if it was stopped.
  std::shared_ptr<const VcmPlans> begin_lessons(const Pass& pass, const std::stop_token& stop,
                                                PassReport& report);
  /// Those for passes of so many samples, made when they are first asked for. Worth nothing if that
  /// was stopped.
  FirstPlans first_plans(uint32_t samples_per_pixel, const std::stop_token& stop,
                         PassReport& report);
  /// All that was learned; empty if nothing is learned.
  Lessons written_lessons() const;

  const Scene& scene_;
  const VcmSettings& settings_;
  std::shared_ptr<const LightPathEmission> plain_;
  mutable std::mutex mutex_;
  FirstPlans first_;                       ///< of the passes that were asked for last
  std::unique_ptr<VcmLessons> lessons_;    ///< null: there are none yet
  std::shared_ptr<const VcmPlans> fixed_;  ///< of all passes; null: they change with the passes
  bool is_shared_ = false;
  std::map<uint32_t, std::vector<uint8_t>> taught_;  ///< by passes that are shared
};

}  // namespace kaustik
