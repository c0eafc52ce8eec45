#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/comparisons/measurement.h"

namespace kaustik::bench {

/// How tables name the builds of a program.
std::string letter_of(size_t build);

/// The measurements of a results file by scene and integrator, but those with settings (see
/// type_of()) and those by CPU time: of each seed the newest.
class Results {
 public:
  explicit Results(const std::vector<Measurement>& in_order);

  /// In the order in which they were measured first.
  const std::vector<std::string>& scenes() const { return scenes_; }
  /// path, bdpt, ppm, vcm, photonmap, auto, others.
  const std::vector<std::string>& integrators() const { return integrators_; }
  bool has(const std::string& integrator) const;
  const std::vector<Measurement>& all() const { return newest_; }
  /// When the scene was looked at, ascending.
  std::vector<double> times(const std::string& scene) const;
  double last_time(const std::string& scene) const { return times(scene).back(); }
  /// The mean over the seeds; nothing: not measured, or no pass had ended.
  std::optional<double> relmse(const std::string& scene, const std::string& integrator,
                               double time) const;
  std::optional<double> mean_ratio(const std::string& scene, const std::string& integrator) const;
  /// Of whole runs, which may be of different lengths.
  std::optional<double> seconds_per_pass(const std::string& scene,
                                         const std::string& integrator) const;
  /// Of the reference's own noise, where it tells.
  std::optional<double> reference_relmse(const std::string& scene) const;
  /// Measurement::reference_mean_ratio, where there is another.
  std::optional<double> reference_mean_ratio(const std::string& scene) const;
  /// Whether all of the scene was compared with the same one.
  bool has_one_reference(const std::string& scene) const;
  /// Of how many seeds relmse() is the mean.
  int seed_count(const std::string& scene, const std::string& integrator, double time) const;
  /// Checksums of the programs that have measured, the oldest first …
  const std::vector<std::string>& builds() const { return builds_; }
  /// … and which of them have measured the scene by these, as letters: "A, C".
  std::string builds_of(const std::string& scene,
                        const std::vector<std::string>& integrators) const;

 private:
  std::optional<double> newest_of(const std::string& scene,
                                  const std::function<double(const Measurement&)>& value) const;
  std::optional<double> mean_over_seeds(
      const std::string& scene, const std::string& integrator,
      const std::function<std::optional<double>(const Measurement&)>& value) const;

  std::vector<Measurement> newest_;
  std::vector<std::string> scenes_, integrators_, builds_;
};

/// The integrator whose ratios are told: "auto" where it was measured, else "photonmap", which is
/// what renders when nothing is asked for.
std::string headline_of(const Results& results);

}  // namespace kaustik::bench
