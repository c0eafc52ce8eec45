#pragma once
#include <map>
#include <memory>
#include <vector>

#include "kaustik/vcm/lessons/lesson.h"

namespace kaustik {

/// All that finished passes of a seed have taught connection and merging: plans change at passes 1,
/// 2, 4, 8 …, the begins of epochs, from the sums of all passes before.
class VcmLessons {
 public:
  /// From `first`, the plans of the first pass. All must outlive this.
  VcmLessons(const Scene& scene, std::shared_ptr<const VcmPlans> first, const VcmSettings& settings,
             uint64_t seed);
  /// Forgets all but what every seed has in common.
  void begin(uint64_t seed);

  const std::shared_ptr<const VcmPlans>& first() const { return first_; }
  uint64_t seed() const { return seed_; }
  /// Those that have been learned from: the first so many.
  uint32_t passes() const { return passes_; }
  /// Passes that are learned from; 0: none.
  uint32_t end() const { return end_; }
  /// First pass of the epoch that a pass belongs to: 0, 1, 2, 4, 8 …
  uint32_t epoch_begin(uint32_t pass) const;
  /// Whether the plans of that epoch can still be made or are there.
  bool knows_epoch(uint32_t epoch) const;
  /// Whether this is the pass to be learned from next.
  bool expects(const Pass& pass) const;
  /// Whether the pass has anything to teach; else learn() will do without its light paths.
  bool wants(uint32_t pass) const;
  bool wants_samples(uint32_t pass) const;

  /// The next pass; nothing of it if it was stopped.
  void learn(const TaughtPass& taught, const std::stop_token& stop, uint64_t& rays);
  /// Nothing that is wanted.
  void skip() { ++passes_; }
  /// The plans of the epoch that begins with this pass, made before that is learned from; those of
  /// the first pass if it was stopped.
  std::shared_ptr<const VcmPlans> plans_of(uint32_t epoch, const std::stop_token& stop,
                                           uint64_t& rays);
  /// The same for passes from 0 on that are not learned from, by all that has been learned.
  std::shared_ptr<const VcmPlans> fixed_plans(const std::stop_token& stop, uint64_t& rays);

  /// All of it, the plans included.
  void write(ByteWriter& writer) const;
  /// What write() wrote, of the same scene and settings. Throws as ByteReader does.
  static std::unique_ptr<VcmLessons> read(ByteReader& reader, const Scene& scene,
                                          const VcmSettings& settings,
                                          const LightPathEmission& plain);

 private:
  /// Those that the pass has anything to teach.
  std::vector<Lesson*> wanted(uint32_t pass) const;
  std::shared_ptr<VcmPlans> made_plans(uint32_t epoch, const std::stop_token& stop, uint64_t& rays);

  std::shared_ptr<const VcmPlans> first_;
  uint64_t seed_;
  std::vector<std::unique_ptr<Lesson>> lessons_;  ///< in the order in which they change plans
  uint32_t end_ = 0;
  uint32_t passes_ = 0;
  std::map<uint32_t, std::shared_ptr<const VcmPlans>> epochs_;  ///< by their first pass
};

}  // namespace kaustik
