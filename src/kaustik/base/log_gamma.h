#pragma once
#include <cmath>

namespace kaustik {

/// log |Γ(x)|. std::lgamma writes the global signgam, too, which is a data race of two renders.
inline double log_gamma(double x) {
  int sign = 0;
  return ::lgamma_r(x, &sign);
}

}  // namespace kaustik
