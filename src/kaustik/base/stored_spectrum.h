#pragma once
#include <array>

#include "kaustik/base/spectrum.h"

namespace kaustik {

/// A spectrum in records of which there are millions: without the alignment of a register.
struct StoredSpectrum {
  StoredSpectrum() = default;
  StoredSpectrum(const Spectrum& s) : lanes{s[0], s[1], s[2], s[3]} {}  // NOLINT: the same
  Spectrum spectrum() const { return {lanes[0], lanes[1], lanes[2], lanes[3]}; }

  std::array<float, Spectrum::lane_count> lanes{};
};

}  // namespace kaustik
