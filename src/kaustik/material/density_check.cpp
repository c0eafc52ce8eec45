#include "kaustik/material/density_check.h"

#include <algorithm>
#include <random>

#include "kaustik/image/photometry.h"

namespace kaustik {
namespace {

/// Independent numbers, as tests want them: those of renders are more even.
class Samples {
 public:
  Samples(const Bsdf& bsdf, const Vec3f& wo, uint64_t seed) : bsdf_(bsdf), wo_(wo), bits_(seed) {}
  BsdfSample next() {
    const float u_lobe = number(), x = number(), y = number();
    return bsdf_.sample({}, wo_, u_lobe, {x, y}, Lobes::all);
  }

 private:
  /// 0 ≤ u < 1
  float number() { return float(bits_() >> 40) * 0x1p-24f; }

  const Bsdf& bsdf_;
  Vec3f wo_;
  std::mt19937_64 bits_;
};

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
  Samples samples(bsdf, wo, seed);
  for (int i = 0; i < question.samples; ++i) observed[counted_cell(samples.next(), grid)] += 1;
  return density_p_value(std::move(observed),
                         expected_counts(bsdf, wo, Lobes::all, grid, question.samples),
                         question.minimum_expected);
}

RunningStatistics sampled_reflectance(const Bsdf& bsdf, const Vec3f& wo, int64_t samples,
                                      uint64_t seed) {
  RunningStatistics result;
  Samples drawn(bsdf, wo, seed);
  for (int64_t i = 0; i < samples; ++i) {
    const Spectrum weight = drawn.next().weight;
    result.add(double(photopic({weight[0], weight[1], weight[2]})));
  }
  return result;
}

}  // namespace kaustik
