#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

#include "kaustik/material/noise.h"

namespace kaustik {

/// The mean of a share x between two colours, held between 0 and 1, where noise is added to x
/// first: what is seen of it over a place so wide that the noise itself is not.
class NoisyRamp {
 public:
  /// Without noise.
  NoisyRamp() : means_(nodes) {
    for (size_t i = 0; i < nodes; ++i) means_[i] = std::clamp(place(i), 0.0f, 1.0f);
  }
  /// With one noise more, independent of the others: `noise` of values of gradient_noise.
  template <class Noise>
  NoisyRamp with(const Noise& noise) const {
    NoisyRamp wider = *this;
    for (size_t i = 0; i < nodes; ++i) {
      double sum = 0;
      for (const float value : noise_classes()) sum += double((*this)(place(i) + noise(value)));
      wider.means_[i] = float(sum / double(noise_classes().size()));
    }
    return wider;
  }

  float operator()(float x) const {
    const float at = std::clamp((x - lowest) * steps_per_unit, 0.0f, float(nodes - 1));
    const size_t i = std::min(size_t(at), nodes - 2);
    return means_[i] + (at - float(i)) * (means_[i + 1] - means_[i]);
  }

 private:
  /// Beyond it no noise of a texture brings x back between 0 and 1.
  static constexpr float lowest = -2, highest = 3;
  static constexpr float steps_per_unit = 128;  ///< 0 and 1 are nodes
  static constexpr size_t nodes = size_t((highest - lowest) * steps_per_unit) + 1;

  static float place(size_t node) { return lowest + float(node) / steps_per_unit; }

  std::vector<float> means_;
};

}  // namespace kaustik
