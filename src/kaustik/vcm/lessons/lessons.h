#pragma once
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "kaustik/vcm/lessons/lesson.h"
#include "kaustik/vcm/pass.h"

namespace kaustik {

/// What a pass goes by.
struct PassPlans {
  std::shared_ptr<const VcmPlans> plans;
  uint32_t remembered_paths = 0;  ///< that lessons ask of it
  /// Passes that were traced for it, in whose progress one more part is left.
  uint32_t made_up = 0;
};

/// All that finished passes of a seed have taught connection and merging: plans change at passes 1,
/// 2, 4, 8 …, the begins of epochs, from the sums of all passes before.
class VcmLessons {
 public:
  /// From the plans of the first pass. `scene`, `settings` and `plain`, which is not guided, must
  /// outlive this.
  VcmLessons(const Scene& scene, const VcmSettings& settings, const LightPathEmission& plain,
             const FirstPlans& first, uint64_t seed);
  /// Forgets all but what every seed has in common.
  void begin(uint64_t seed);

  /// The plans of the first pass.
  const std::shared_ptr<const VcmPlans>& first() const { return first_; }
  /// Those that have been learned from: the first so many.
  uint32_t passes() const { return passes_; }
  /// Passes that are learned from; 0: none.
  uint32_t end() const { return end_; }
  /// First pass of the epoch that a pass belongs to: 0, 1, 2, 4, 8 …
  uint32_t epoch_begin(uint32_t pass) const;
  /// First pass of the next epoch; none if there is none.
  std::optional<uint32_t> epoch_end(uint32_t pass) const;
  /// Whether the pass is of their seed and samples, and the plans of its epoch can still be made or
  /// are there.
  bool serve(const Pass& pass) const;

  /// What a pass that they serve goes by. First learns from all passes before its epoch that have
  /// not taught yet: their light paths and training pairs are traced, as far as lessons ask for
  /// them. Plans of the first pass if it was stopped.
  PassPlans plans_for(const Pass& pass, const std::stop_token& stop,
                      const ProgressFunction& progress, PassReport& report);
  /// Learns from a pass whose light paths have been traced by plans_for(), if it is the next one:
  /// passes out of order are traced anew where they are needed. Counts the rays.
  void learn(const VcmPass& traced, const std::stop_token& stop, uint64_t& rays);
  /// What such a pass teaches, one of an epoch whose plans are there, for add_taught() of others.
  /// False: it teaches nothing, or it was stopped.
  bool write_taught(const VcmPass& traced, ByteWriter& writer, const std::stop_token& stop,
                    uint64_t& rays) const;
  /// Learns from the pass if it is the next one. Throws as ByteReader does.
  void add_taught(const Pass& pass, ByteReader& reader);
  /// Learns from all passes before `until` that have not taught yet, passes like `pass`. Returns
  /// how many those were.
  uint32_t make_up(const Pass& pass, uint32_t until, const std::stop_token& stop,
                   const ProgressFunction& progress, PassReport& report);
  /// Plans for passes from 0 on that are not learned from, by all that has been learned.
  std::shared_ptr<const VcmPlans> fixed_plans(const std::stop_token& stop, uint64_t& rays);

  /// All of it, the plans included.
  void write(ByteWriter& writer) const;
  /// What write() wrote, of the same scene and settings. Throws as ByteReader does.
  static std::unique_ptr<VcmLessons> read(ByteReader& reader, const Scene& scene,
                                          const VcmSettings& settings,
                                          const LightPathEmission& plain);

 private:
  /// What all lessons together ask of a pass.
  LessonNeeds needs_of(uint32_t pass) const;
  /// It teaches something, and the plans that it goes by are there.
  bool can_teach(const Pass& pass) const;
  bool is_next(const Pass& pass) const;
  /// Those that such a pass teaches, in their order.
  std::vector<Lesson*> taught_by(uint32_t pass) const;
  /// What the pass adds to each of these; nothing if it was stopped.
  std::vector<std::unique_ptr<LessonSums>> sums_of(const VcmPass& traced,
                                                   const std::vector<Lesson*>& lessons,
                                                   const std::stop_token& stop,
                                                   uint64_t& rays) const;
  /// Of the next pass.
  void add(const std::vector<Lesson*>& lessons,
           const std::vector<std::unique_ptr<LessonSums>>& sums);
  /// Learns from the next pass; nothing if it was stopped.
  void take(const VcmPass& traced, const std::stop_token& stop, uint64_t& rays);
  /// Traces the next pass as far as is needed, and learns from it.
  void trace_next(const Pass& next, const std::stop_token& stop, const ProgressFunction& progress,
                  PassReport& report);
  /// The plans of the epoch that begins with this pass, made before that is learned from; those of
  /// the first pass if it was stopped.
  std::shared_ptr<const VcmPlans> plans_of(uint32_t epoch, const std::stop_token& stop,
                                           uint64_t& rays);
  std::shared_ptr<const VcmPlans> made_plans(uint32_t epoch, const std::stop_token& stop,
                                             uint64_t& rays);

  const Scene& scene_;
  const VcmSettings& settings_;
  std::shared_ptr<const VcmPlans> first_;
  uint64_t seed_;
  std::vector<std::unique_ptr<Lesson>> lessons_;  ///< in the order in which they change plans
  uint32_t end_ = 0;
  uint32_t passes_ = 0;
  std::map<uint32_t, std::shared_ptr<const VcmPlans>> epochs_;  ///< by their first pass
};

}  // namespace kaustik
