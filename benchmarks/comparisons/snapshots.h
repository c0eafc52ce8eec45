#pragma once
#include <optional>
#include <vector>

#include "benchmarks/quality.h"

namespace kaustik::bench {

/// How a picture stood at some times of its rendering.
struct Snapshots {
  /// One per time: the picture after the last pass that had ended by then. If none had, the samples
  /// of the first pass so far, where every pixel has one; else nothing.
  std::vector<std::optional<ImageComparison>> pictures;
  Image last;           ///< "R", "G", "B" of the last of them; empty: there is none
  uint32_t passes = 0;  ///< that have ended, of that
  uint32_t samples_per_pass = 0;
  double cpu_share = 0;  ///< CPU time over time × threads
};

/// Renders until the last of `times` (seconds from the start of rendering, ascending), whatever
/// other limits the settings have, on as many threads as they name. Looking at the picture stops
/// the clock.
Snapshots render_with_snapshots(const Scene& scene, const Integrator& integrator,
                                const SessionSettings& settings, const std::vector<double>& times,
                                const Image& reference);

}  // namespace kaustik::bench
