#pragma once
#include "kaustik/export.h"

namespace kaustik::v0 {

struct Interval {
  double low = 0, high = 0;
};

/// A mean and how well it is known. Luminances are photopic, in the picture's unit: W/(sr·m²), or
/// W/m² of meters of irradiance; 179 of them are cd/m².
struct KAUSTIK_EXPORT Estimate {
  double value = 0;
  /// Of the noise; infinite where fewer than two passes tell of it.
  double standard_error = 0;
  /// By how much the value is expected to be off beside its noise, to one side; 0: nothing is known
  /// of a bias.
  double bias = 0;
  /// Of Student's t, that the error has.
  double degrees_of_freedom = 1;
  /// Of a pixel's bias, as far as the pixels around share it; 0 of regions and points.
  double bias_standard_error = 0;

  /// Holds the truth with this chance, between 0 and 1. Throws Error for other chances.
  Interval interval(double confidence = 0.95) const;
};

}  // namespace kaustik::v0
