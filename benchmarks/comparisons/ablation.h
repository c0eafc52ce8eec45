#pragma once
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/comparisons/measurement.h"

namespace kaustik::bench {

/// Error without a device over that with it, at equal time: the geometric mean over seeds.
struct Worth {
  double ratio = 1;
  /// Of one standard error over the seeds, as all devices tell of that scene together: the seeds of
  /// one are too few. Infinite: one seed does not tell.
  double factor = 1;
  double freedom = 0;  ///< of that
};

/// What each setting that switches something off does to the error: `auto:guiding=false` is
/// compared with `auto`, `ppm:a=1:b=2` with `ppm:a=1`.
class Ablation {
 public:
  /// Of measurements by CPU time.
  explicit Ablation(const std::vector<Measurement>& in_order);

  const std::vector<std::string>& scenes() const { return scenes_; }
  /// Whose wholes were measured, in the order in which they were measured first.
  const std::vector<std::string>& variants() const { return variants_; }
  /// Without the noise of the reference, of the seeds that both were measured with; nothing: of
  /// none, or that noise is more than half of an error of one of them.
  std::optional<Worth> worth(const std::string& scene, const std::string& variant) const;
  /// The reference's own error over that of what is whole: more than a tenth tells less.
  std::optional<double> reference_share(const std::string& scene) const;

 private:
  /// Of the seeds' ratios; nothing as of worth().
  std::optional<std::vector<double>> logarithms(const std::string& scene,
                                                const std::string& variant) const;
  const Measurement* find(const std::string& scene, const std::string& integrator,
                          uint64_t seed) const;

  std::vector<Measurement> newest_;
  std::vector<std::string> scenes_, variants_, wholes_;
};

/// What is asked of a device: to lower the error by a tenth on some scene, and to raise it by more
/// than a twentieth on none. All scenes together are told at 95 % (Šidák); what that leaves open
/// can't be told.
std::string verdict_of(const std::vector<Worth>& on_scenes);

/// One row per scene, one column per variant.
std::string worth_table(const Ablation& ablation);
/// One row per variant: where it is worth most and least, and the verdict.
std::string verdict_table(const Ablation& ablation);

}  // namespace kaustik::bench
