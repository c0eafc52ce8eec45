#pragma once
#include "kaustik/base/spectrum.h"
#include "kaustik/material/bsdf.h"
#include "kaustik/medium/medium.h"
#include "kaustik/transport/footprint.h"

namespace kaustik {

/// What a path carries from vertex to vertex, whichever end it started from.
struct PathState {
  Spectrum throughput{1.0f};  ///< radiance factor, or flux in W on light paths
  TransportMode mode = TransportMode::radiance;
  const Medium* medium = nullptr;  ///< that the next segment runs through; null: vacuum
  Footprint footprint;
  Wavelengths wavelengths;   ///< of the lanes; which of them are alive
  float pdf_forward = 0;     ///< density per solid angle of the last direction as sampled; 0: delta
  float pdf_unguided = 0;    ///< the same without a ScatterGuide
  float pdf_reverse = 0;     ///< density per solid angle with which the event before would send a
                             ///< path from the other end back; 0: delta or not asked for
  float roulette_scale = 1;  ///< what roulette multiplies the throughput by: the product of the
                             ///< squared relative indices crossed and of the numbers of branches
  int depth = 0;             ///< scattering events so far

  /// Where lanes part at an event (BsdfSample::only_lane) one of them goes on.
  void follow_lanes_of(const BsdfSample& sample) {
    if (sample.only_lane >= 0) wavelengths = wavelengths.only(sample.only_lane);
  }
};

}  // namespace kaustik
