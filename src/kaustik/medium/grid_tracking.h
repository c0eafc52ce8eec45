#pragma once
// Light on a line through a grid of densities, by looks at few places.
//
// Where the density has bounds, collisions can be drawn for the upper one, and taken back where the
// density turns out to be less (null collisions: Woodcock et al. 1965; Novák, Selle and Jarosz,
// "Residual Ratio Tracking for Estimating Attenuation in Participating Media", 2014; for several
// wavelengths at once Miller, Georgiev and Jarosz, "A Null-Scattering Path Integral Formulation of
// Light Transport", 2019). Of each piece of the line either this is done, or the integral is taken
// from cell to cell, without noise: whatever takes less time.

#include "kaustik/base/sampler.h"
#include "kaustik/base/spectrum.h"
#include "kaustik/volume/grid_crossing.h"

namespace kaustik {

/// An unbiased estimate of the share of the light of each lane that comes to the end of the line; 0
/// at least. `extinction`: of value 1 of the grid, 1/m. Numbers are drawn from `numbers`.
Spectrum tracked_transmittance(GridCrossing crossing, const Spectrum& extinction, Sampler numbers);

/// How far light flies on the line that collides as lane `lane` does.
struct TrackedFlight {
  bool collided = false;
  float distance = 0;  ///< t, if it has
  /// Per lane, up to a common factor: the probability that light of that lane comes as far, given
  /// the places that were looked at.
  Spectrum left{1};
};
/// `depth` ≥ 0: an optical depth, distributed exponentially, with which the flight begins.
TrackedFlight tracked_flight(GridCrossing crossing, const Spectrum& extinction, int lane,
                             float depth, Sampler numbers);

}  // namespace kaustik
