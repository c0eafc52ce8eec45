#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/comparisons/measurement.h"
#include "benchmarks/line_plot.h"

namespace kaustik::bench {

/// The measurements of a results file by scene and integrator: of each seed the newest.
class Results {
 public:
  explicit Results(const std::vector<Measurement>& in_order);

  /// In the order in which they were measured first.
  const std::vector<std::string>& scenes() const { return scenes_; }
  /// path, bdpt, ppm, vcm, photonmap, auto, others; as far as they were measured without settings.
  const std::vector<std::string>& integrators() const { return integrators_; }
  /// Those that were measured with settings (see type_of()).
  const std::vector<std::string>& variants() const { return variants_; }
  bool has(const std::string& integrator) const;
  const std::vector<Measurement>& all() const { return newest_; }
  /// When the scene was looked at, ascending.
  std::vector<double> times(const std::string& scene) const;
  double last_time(const std::string& scene) const { return times(scene).back(); }
  /// The mean over the seeds; nothing: not measured, or no pass had ended.
  std::optional<double> relmse(const std::string& scene, const std::string& integrator,
                               double time) const;
  std::optional<double> mean_ratio(const std::string& scene, const std::string& integrator) const;
  /// The passes in all of the time.
  std::optional<double> passes(const std::string& scene, const std::string& integrator) const;
  /// Of the reference's own noise, where it tells.
  std::optional<double> reference_relmse(const std::string& scene) const;

 private:
  std::optional<double> mean_over_seeds(
      const std::string& scene, const std::string& integrator,
      const std::function<std::optional<double>(const Measurement&)>& value) const;

  std::vector<Measurement> newest_;
  std::vector<std::string> scenes_, integrators_, variants_;
};

/// The integrator whose ratios are told: "auto" where it was measured, else "photonmap", which is
/// what renders when nothing is asked for.
std::string headline_of(const Results& results);

/// Tables in Markdown, over all scenes at the last time of each: the error by every integrator,
/// with the headline's ratios to the best of path, bdpt, ppm and vcm, and to path, and their
/// geometric means;
std::string error_table(const Results& results);
/// … the error at the first time by "photonmap" and the headline, and which of them is ahead; "" if
/// one was not measured;
std::string early_table(const Results& results);
/// … what becomes of the error, and of the time of a pass, when settings of an integrator are
/// others than its own: ratios to what it is without them. "" if none were measured;
std::string ablation_table(const Results& results);
/// … means of the pictures relative to those of the references;
std::string mean_table(const Results& results);
/// … and the figures of other renderers beside ours. "" if none of their scenes was measured.
std::string peer_table(const Results& results);

/// Error over time by every integrator.
LinePlot error_plot(const Results& results, const std::string& scene);

}  // namespace kaustik::bench
