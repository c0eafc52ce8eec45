#include "kaustik/material/density_check.h"

#include <algorithm>

#include "kaustik/base/sampler.h"
#include "kaustik/image/photometry.h"

namespace kaustik {
namespace {

/// Independent of those of other indices.
BsdfSample drawn_sample(const Bsdf& bsdf, const Vec3f& wo, uint64_t seed, uint64_t index) {
  Sampler sampler(hash_mix(seed, index), 0);
  const float u_lobe = sampler.next_1d();
  return bsdf.sample({}, wo, u_lobe, sampler.next_2d(), Lobes::all);
}

}  // namespace

CellCounts expected_counts(const Bsdf& bsdf, const Vec3f& wo, Lobes lobes,
                           const DirectionGrid& grid, int samples) {
  CellCounts counts;
  double total = 0;
  for (size_t cell = 0; cell < grid.size(); ++cell) {
    const double share =
        grid.integrate(cell,
                       [&](const Vec3f& wi) { return Vec3d(bsdf.pdf({}, wo, wi, lobes), 0, 0); })
            .x;
    counts.push_back(share * samples);
    total += share;
  }
  counts.push_back(1 - total < 3e-4 ? 0 : (1 - total) * samples);
  return counts;
}

size_t counted_cell(const BsdfSample& sample, const DirectionGrid& grid) {
  const bool has_density = sample.event == Lobes::diffuse || sample.event == Lobes::glossy;
  return has_density ? grid.cell_of(sample.wi) : grid.size();
}

double density_p_value(CellCounts observed, const CellCounts& expected, double minimum_expected) {
  double samples = 0;
  for (const double count : observed) samples += count;
  if (expected.back() == 0) {
    if (observed.back() > 1e-3 * samples) return 0;
    observed.back() = 0;
  }
  return chi_square_p_value(observed, expected, minimum_expected);
}

double check_density(const Bsdf& bsdf, const Vec3f& wo, const DensityQuestion& question,
                     uint64_t seed) {
  const DirectionGrid grid = DirectionGrid::even(question.rows);
  CellCounts observed(grid.size() + 1);
  for (int i = 0; i < question.samples; ++i)
    observed[counted_cell(drawn_sample(bsdf, wo, seed, uint64_t(i)), grid)] += 1;
  return density_p_value(std::move(observed),
                         expected_counts(bsdf, wo, Lobes::all, grid, question.samples),
                         question.minimum_expected);
}

RunningStatistics sampled_reflectance(const Bsdf& bsdf, const Vec3f& wo, int64_t samples,
                                      uint64_t seed) {
  RunningStatistics result;
  for (int64_t i = 0; i < samples; ++i) {
    const Spectrum weight = drawn_sample(bsdf, wo, seed, uint64_t(i)).weight;
    result.add(double(photopic({weight[0], weight[1], weight[2]})));
  }
  return result;
}

}  // namespace kaustik
