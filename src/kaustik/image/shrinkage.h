#pragma once
#include <array>

#include "kaustik/image/pixel_surfaces.h"

namespace kaustik {

/// A raw value X of each pixel, and a filtered one F.
struct Blend {
  Plane change;             ///< F − X
  Plane own_variance;       ///< of X, as the pixel alone knows it
  Plane joined_variance;    ///< of X, as all know it that were joined: FilteredLight::raw_variance
  Plane covariance;         ///< of X and F, by how halves of both differ
  Plane filtered_variance;  ///< of F, as if pixels were independent
  bool knows_halves = false;  ///< variances are by halves, not by samples
};

/// The share λ of raw in the blend F + λ (X − F) of least squared error, by pixel. By Stein's
/// unbiased estimate of that error λ = 1 − (Var X − Cov(X, F)) / (F − X)², where each term is a
/// mean over about 13 × 13 pixels, times `importance`; less a standard error, and within 0 and 1.
/// So the blend is no worse than the raw value but for what that estimate is off (James, Stein
/// 1961; for pictures Gu et al. 2022).
Plane share_of_raw(int width, int height, const Blend& blend, const Plane& importance);

/// A value of each pixel by two independent halves of the passes: X, and Z − X of what becomes of
/// it.
struct ChangedHalves {
  const std::array<Plane, 2>&raw, &change;
};
/// Standard error of Z: √(variance + bias²). The variance is that of its halves; bias² the larger
/// of (Z − X)² − Var X + 2 Cov(X, Z) − Var Z and of the squared mean of Z − X, less the noise of
/// that; pooled as above. `odd_share`: of a pixel's passes those of the second half.
Plane error_of_halves(int width, int height, const ChangedHalves& halves, const Plane& odd_share,
                      const Plane& importance);

}  // namespace kaustik
