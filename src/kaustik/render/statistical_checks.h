#pragma once
// Measures what claims about scenes and bsdfs are checked with.

#include <cstdint>

#include "kaustik/base/statistics.h"
#include "kaustik/scene/description.h"

namespace kaustik {

/// How much is drawn.
struct CheckEffort {
  int64_t samples = 100'000;  ///< in all, at least
  uint64_t seed = 1;
  int threads = 0;  ///< 0: all
};

/// The mean over the picture of the luminance, W/(sr·m²), that the scene's own integrator finds:
/// one value for each of `replicate_count` independent passes. Throws Error.
RunningStatistics picture_luminances(const Description& description, const CheckEffort& effort);

/// The luminance that the bsdf of the scene's first shape reflects and transmits of even light of
/// luminance 1, at an angle to the normal: one value for each sample. Throws Error.
RunningStatistics reflected_luminances(const Description& description, double angle_degrees,
                                       const CheckEffort& effort);

/// How directions are counted that a bsdf draws.
struct DensityCells {
  int rows = 10;                ///< of equal height along z, with twice as many cells each
  double minimum_expected = 5;  ///< samples of a cell, below which it is pooled
};

/// The p value of Pearson's test that the bsdf of the scene's first shape draws directions as its
/// density says, for light in the random direction of that number on the outer side. Throws Error,
/// also for a bsdf without a density.
double sampling_p_value(const Description& description, int direction, const DensityCells& cells,
                        const CheckEffort& effort);

}  // namespace kaustik
