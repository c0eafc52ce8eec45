#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "benchmarks/quality.h"

namespace kaustik::bench {

/// What `kaustik render --time` would show after some times.
struct TimedRenders {
  /// One per time; nothing: a pixel had no sample yet.
  std::vector<std::optional<ImageComparison>> pictures;
  std::vector<double> seconds_taken;  ///< one per time: when that render was over
  Image last;                         ///< "R", "G", "B" of the last picture; empty: there is none
  uint32_t passes = 0;                ///< whole passes of the last one
  uint32_t samples_per_pass = 0;      ///< of the last one
  double cpu_share = 0;               ///< CPU time over time × threads, of all
};

/// An integrator that has learned nothing yet.
using IntegratorMaker = std::function<std::unique_ptr<Integrator>()>;

/// Renders once for each of `times` (seconds from the start of rendering), whatever other limits
/// the settings have, on as many threads as they name. A part of a pass counts, as it does for the
/// program. If the first pass has no picture in time, it is waited for a little: see
/// SessionSettings::seconds.
TimedRenders render_for(const std::vector<double>& times, const Scene& scene,
                        const IntegratorMaker& make_integrator, const SessionSettings& settings,
                        const Image& reference);

}  // namespace kaustik::bench
