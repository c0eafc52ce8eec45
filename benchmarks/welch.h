#pragma once
#include <algorithm>
#include <cmath>

#include "kaustik/base/statistics.h"

namespace kaustik {

/// Chance of means that differ as much as these do or more in one direction, if the true ones
/// differ by the part `tolerance` of the larger one (Welch 1947).
inline double welch_p_value(const RunningStatistics& a, const RunningStatistics& b,
                            double tolerance) {
  const double excess = std::fabs(a.mean() - b.mean()) - tolerance * std::max(a.mean(), b.mean());
  if (!(excess > 0)) return 1;
  const double va = std::pow(a.standard_error(), 2), vb = std::pow(b.standard_error(), 2);
  if (!(va + vb > 0)) return 0;
  // Of shares, for squares of variances may be too small for a number.
  const double of_a = va / (va + vb), of_b = 1 - of_a;
  const double freedom =
      1 / (of_a * of_a / double(a.count() - 1) + of_b * of_b / double(b.count() - 1));
  return student_t_cdf(-excess / std::sqrt(va + vb), freedom);
}

}  // namespace kaustik
