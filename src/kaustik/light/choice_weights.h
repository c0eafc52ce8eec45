#pragma once
#include <array>
#include <cstddef>

#include "kaustik/light/emission_ball.h"
#include "kaustik/light/power_distribution.h"

namespace kaustik {

/// What each of a few things is chosen in proportion to. The same numbers serve sampling and
/// densities, so that both agree to the bit.
class ChoiceWeights {
 public:
  static constexpr size_t most = LightSelector::maximum_learned;
  static_assert(most % EmissionBalls::padding == 0);

  /// To be filled in before raise(): `count` irradiances, then zeros up to
  /// EmissionBalls::padded(count).
  float* values() { return values_.data(); }
  /// Nothing that has any weight keeps less than `least` times the best one's: estimates err.
  void raise(size_t count, float least);
  /// Where nothing has any weight: in proportion to others, which are not all zero.
  void replace(size_t count, const float* values);

  /// Sum of the irradiances, before any were raised; infinity counts as 1e30. 0 where replaced.
  float sum() const { return sum_; }
  /// Index of one. `u` is replaced by a fresh uniform number.
  size_t choose(size_t count, float& u) const {
    const float target = u * total_;
    float low = 0, next = 0;
    size_t chosen = 0;
    for (size_t i = 0; i < count; ++i) {
      if (!(values_[i] > 0)) continue;
      low = next;
      next += values_[i];
      chosen = i;
      if (target < next) break;
    }
    u = rescaled(target, low, values_[chosen]);
    return chosen;
  }
  float probability(size_t i) const { return values_[i] / total_; }

 private:
  alignas(32) std::array<float, most> values_;
  float sum_, total_;
};

}  // namespace kaustik
