#pragma once
// Whether a bsdf draws directions as its density says, and what it reflects, by statistics.

#include <vector>

#include "kaustik/base/statistics.h"
#include "kaustik/material/bsdf.h"
#include "kaustik/material/direction_grid.h"

namespace kaustik {

/// Numbers of samples by cell of a grid; the last one is of those that are in no cell, since they
/// are absorbed or of a delta lobe.
using CellCounts = std::vector<double>;

/// How many of `samples` directions for light toward wo lie in each cell, by the bsdf's density.
CellCounts expected_counts(const Bsdf& bsdf, const Vec3f& wo, Lobes lobes,
                           const DirectionGrid& grid, int samples);
/// Where a sample counts.
size_t counted_cell(const BsdfSample& sample, const DirectionGrid& grid);
/// Pearson's test, see chi_square_p_value(). The quadrature is not exact enough to tell a small
/// share outside of the cells from none: where none is expected, up to 1 ‰ is none.
double density_p_value(CellCounts observed, const CellCounts& expected,
                       double minimum_expected = 5);

/// What DensityCheck asks of a bsdf.
struct DensityQuestion {
  int rows = 10;  ///< of DirectionGrid::even()
  int samples = 1'000'000;
  double minimum_expected = 5;  ///< cells with fewer samples are pooled
};

/// The p value of `question.samples` directions that are drawn for light toward wo. `seed`: of
/// their random numbers.
double check_density(const Bsdf& bsdf, const Vec3f& wo, const DensityQuestion& question,
                     uint64_t seed);

/// The luminance of f·|cosθ|/density over so many independent samples for light toward wo: its mean
/// is what the surface reflects of even light of luminance 1.
RunningStatistics sampled_reflectance(const Bsdf& bsdf, const Vec3f& wo, int64_t samples,
                                      uint64_t seed);

}  // namespace kaustik
