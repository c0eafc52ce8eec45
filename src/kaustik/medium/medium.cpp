#include "kaustik/medium/medium.h"

#include <cassert>
#include <cmath>

namespace kaustik {

Medium::Medium(std::shared_ptr<const PhaseFunction> phase, bool scatters)
    : phase_(std::move(phase)), scatters_(scatters) {
  assert(phase_);
  for (size_t i = 0; i < phase_looks_.size(); ++i) {
    const float angle = pi * float(i) / float(phase_looks_.size() - 1);
    phase_looks_[i] = phase_->eval({0, 0, 1}, {std::sin(angle), 0, -std::cos(angle)});
  }
}

Spectrum Medium::rough_transmittance(const MediumSegment& segment, const Wavelengths& wavelengths,
                                     const Sampler& sampler) const {
  return transmittance(segment, wavelengths, sampler);
}

Spectrum Medium::measured_transmittance(const MediumSegment& segment, const std::vector<LineKnot>&,
                                        const Wavelengths& wavelengths,
                                        const Sampler& sampler) const {
  return transmittance(segment, wavelengths, sampler);
}

}  // namespace kaustik
