#pragma once
#include <array>
#include <vector>

#include "kaustik/image/pixel_surfaces.h"

namespace kaustik {

/// Light with noise, of one kind, as a filter takes it.
struct NoisyLight {
  std::array<Plane, 3> rgb;  ///< the mean
  /// The photopic means of two independent halves of the passes, over that of all; empty: they are
  /// not known.
  std::array<Plane, 2> halves;
  /// Of the photopic mean as far as it is known by samples; empty: it is not.
  Plane variance;

  bool has_halves() const { return !halves[0].empty(); }
};

struct FilteredLight {
  /// The light of each half by weights that the other half has decided; without halves the first is
  /// that of all.
  std::array<std::array<Plane, 3>, 2> halves;
  Plane variance;  ///< of the photopic value of all, as if pixels were independent
  /// Of the photopic mean as it was rendered, averaged over the pixels that were joined: where some
  /// have met rare events the others have that noise, too.
  Plane raw_variance;
};

/// Averages over pixels of like surfaces whose light a test does not tell apart.
///
/// Seven times an average over 5 × 5 pixels that are 1 to 16 pixels apart, by the B₃ spline
/// (Dammertz et al. 2010), the likeness of the surfaces, and (1 − t²/t₀²)² of Welch's t = (l −
/// m)/√(v + w): the means and variances of the two pixels, as the averages so far know them. Where
/// the halves of the light are known, those weights are decided by the averages of one half and
/// applied to the light of the other (Back et al. 2023): then they do not depend on what they
/// weigh, and what is joined is unbiased wherever the joined means are equal. Without halves light
/// decides its own weights.
///
/// `odd_share`: of a pixel's passes those of the second half, by pixel; only with halves. Values
/// must be finite.
FilteredLight cross_filtered(const PixelSurfaces& surfaces, const NoisyLight& light,
                             const Plane& odd_share);

}  // namespace kaustik
