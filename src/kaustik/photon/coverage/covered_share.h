#pragma once

namespace kaustik {

/// What was found at a point of a disk.
enum class CoveredPoint {
  outside,  ///< it does not belong to what is asked about
  covered,  ///< no light can be kept there
  held      ///< light can be kept there
};

/// Draws points of a disk by `look()`, which answers a CoveredPoint, until one holds light: at
/// which of those that are not outside. In the mean that is one over the share of them that hold
/// light, but for shares of which `most_tries` see little: no more are tried. Nor are more than
/// `most_points` drawn.
template <typename LookAtPoint>
int tries_until_held(int most_tries, int most_points, const LookAtPoint& look) {
  int tries = 1;
  for (int points = 0; points < most_points && tries < most_tries; ++points) {
    const CoveredPoint found = look();
    if (found == CoveredPoint::held) break;
    if (found == CoveredPoint::covered) ++tries;
  }
  return tries;
}

}  // namespace kaustik
