#pragma once
#include <optional>
#include <vector>

#include "kaustik/base/vec.h"

namespace kaustik {

/// The colour map "viridis" (Smith, van der Walt and Firing 2015), perceptually uniform and
/// readable without colour vision: display-linear, from dark blue at 0 to yellow at 1; clamped
/// outside.
Vec3f viridis(float t);

/// From values to [0, 1], with round numbers to write beside it.
struct ColorScale {
  double minimum = 0, maximum = 1;
  bool is_logarithmic = false;
  std::vector<double> ticks;  ///< rising, from minimum to maximum

  /// Not clamped; −∞ for what has no logarithm.
  double position(double value) const;
  /// How many of the inner ticks `value` has reached.
  size_t band(double value) const;
};

struct ScaleSettings {
  bool is_logarithmic = false;
  std::optional<double> minimum, maximum;
};

/// A scale for these values (finite, any order). What is not set becomes a round number: linear
/// scales start at 0 and end above 98 % of the values that are positive; logarithmic ones also
/// leave out the lowest 2 % of them, and have at most four decades. Throws Error(input) if the
/// limits are no range.
ColorScale make_scale(std::vector<double> values, const ScaleSettings& settings);

}  // namespace kaustik
