#pragma once
#include <vector>

#include "kaustik/light/light.h"

namespace kaustik {

/// Relative importance of a power: the sum of its lanes.
inline double importance_of(const Spectrum& power) {
  return double(power[0]) + power[1] + power[2] + power[3];
}

/// Chooses lights with fixed chances in proportion to their weights.
class PowerDistribution {
 public:
  PowerDistribution() = default;
  /// One weight per light of the scene, at least 0; lights that are not meant to be chosen have 0.
  explicit PowerDistribution(const std::vector<double>& weights);

  /// No light has a weight.
  bool empty() const { return lights_.empty(); }
  /// Not while empty. `u` is replaced by a fresh uniform number.
  LightSelector::Choice choose(float& u) const;
  float probability(int light) const { return probability_of_light_[size_t(light)]; }

 private:
  std::vector<int> lights_;        ///< that have a weight
  std::vector<float> cumulative_;  ///< end of each one's part of [0, 1); the last is 1
  std::vector<float> probability_of_light_;
};

/// `u` in [low, low + width) as a number in [0, 1).
inline float rescaled(float u, float low, float width) {
  return std::clamp((u - low) / width, 0.0f, one_minus_epsilon);
}

}  // namespace kaustik
