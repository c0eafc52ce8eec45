#pragma once

namespace kaustik {

/// What is known of a light's visibility: the fraction `known` arrives anyhow, the fraction
/// `by_ray` if a shadow ray finds nothing in its way.
struct VisibilityEstimate {
  float known = 0, by_ray = 1;
};

/// Who knows at a vertex whether light arrives there.
class VisibilityEstimator {
 public:
  virtual ~VisibilityEstimator() = default;
  /// Of the scene's light of that number.
  virtual VisibilityEstimate of(int light) = 0;
};

}  // namespace kaustik
