#pragma once
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "kaustik/vcm/lessons/connection_learning.h"
#include "kaustik/vcm/lessons/radius_learning.h"
#include "kaustik/vcm/lessons/sample_learning.h"
#include "kaustik/vcm/plan/plans.h"

namespace kaustik {

/// What finished passes of a seed have taught connection and merging: plans change at passes 1, 2,
/// 4, 8 …, from the sums of all passes before.
class VcmLearning {
 public:
  /// From `first`, the plans of the first pass. The settings must outlive this.
  VcmLearning(std::shared_ptr<const VcmPlans> first, const VcmSettings& settings);

  /// Passes that are learned from, where those are the plans of the first; 0: none.
  static uint32_t learned_passes(const VcmPlans& first, const VcmSettings& settings);
  /// First pass of the epoch that a pass belongs to: 0, 1, 2, 4, 8 …
  static uint32_t epoch_begin(uint32_t pass, uint32_t learned_passes);
  /// Paths whose beginnings a pass with such plans remembers.
  static uint32_t remembered_paths(uint32_t pass, const VcmPlans& plans);

  const std::shared_ptr<const VcmPlans>& first() const { return first_; }
  /// Whether the pass teaches how camera samples are spread: it is to take some for that.
  static bool wants_samples(uint32_t pass, const VcmPlans& first, const VcmSettings& settings);
  /// Whether the pass is one of the trial of connections: it is to take samples for that.
  static bool tries_connections(uint32_t pass, const VcmPlans& first, const VcmSettings& settings);
  /// Whether this is the pass to be learned from next.
  bool expects(const Pass& pass) const;
  uint64_t seed() const { return seed_; }
  /// Those that have been learned from: the first so many.
  uint32_t passes() const { return passes_; }

  /// Forgets all but what every seed has in common.
  void begin(uint64_t seed);
  /// Whether the next pass has anything to teach; else learn() will do with no vertices.
  bool wants_next() const;
  /// What takes the samples that wants_samples() speaks of, and tries_connections().
  const SampleLearning& samples() const { return samples_; }
  const ConnectionLearning& connections() const { return connections_; }
  /// What a pass has to teach beside its light paths, as far as it is wanted.
  struct Samples {
    std::vector<SampleLearning::Sums> spread;
    std::vector<ConnectionLearning::Trial> trial;
  };
  /// The next pass.
  void learn(const LightVertices& light, const Samples& samples);
  /// The plans of the epoch that begins with this pass, made before that is learned from; those of
  /// the first pass if it was stopped.
  std::shared_ptr<const VcmPlans> plans_of(uint32_t epoch, const Scene& scene,
                                           const std::stop_token& stop, uint64_t& rays);

 private:
  /// Of the epoch that begins, by the passes before.
  void spread_samples(VcmPlans& plans, uint32_t epoch) const;
  void choose_connections(VcmPlans& plans, uint32_t epoch);

  std::shared_ptr<const VcmPlans> first_;
  const VcmSettings& settings_;
  bool learns_radii_;
  std::unique_ptr<LightPathUse> use_;    ///< null: emission is not guided, or not any more
  std::optional<RadiusLearning> radii_;  ///< made when it is first asked for
  uint64_t seed_ = 0;
  std::vector<RadiusLearning::Sums> sums_;
  const SampleLearning no_samples_;  ///< nothing learned yet
  SampleLearning samples_;
  const ConnectionLearning no_connections_;
  ConnectionLearning connections_;
  uint32_t passes_ = 0;
  std::map<uint32_t, std::shared_ptr<const VcmPlans>> epochs_;  ///< by their first pass
};

}  // namespace kaustik
