#pragma once
#include <algorithm>
#include <optional>

#include "kaustik/base/scratch.h"
#include "kaustik/medium/medium.h"

namespace kaustik {

/// Transmittances from the begin of a segment to many of its points: media that take long to cross
/// are crossed once.
class SegmentTransmittance {
 public:
  /// All must outlive this.
  SegmentTransmittance(const Medium& medium, const MediumSegment& segment,
                       const Wavelengths& wavelengths, const Sampler& sampler, Scratch& scratch)
      : medium_(medium),
        segment_(segment),
        wavelengths_(wavelengths),
        sampler_(sampler),
        scratch_(scratch) {}

  /// Of the way of that length, no longer than the segment's.
  Spectrum to(float distance) {
    if (!knots_) {
      knots_.emplace(scratch_.list<LineKnot>());
      medium_.measure(segment_, **knots_);
    }
    return medium_.measured_transmittance({segment_.origin, segment_.direction, distance}, **knots_,
                                          wavelengths_, sampler_);
  }

 private:
  const Medium& medium_;
  MediumSegment segment_;
  const Wavelengths& wavelengths_;
  const Sampler& sampler_;
  Scratch& scratch_;
  std::optional<Scratch::List<LineKnot>> knots_;  ///< once something has been asked for
};

}  // namespace kaustik
