#pragma once
// Cut stones.

#include "kit/mesh.h"

namespace kaustik::scenes {

/// Proportions of a round brilliant; shares are of the girdle's diameter unless said otherwise.
/// Tolkowsky's (1919), but for a girdle that can be seen.
struct BrilliantCut {
  double table = 0.53;          ///< from corner to corner
  double crown_degrees = 34.5;  ///< between the main facets above the girdle and the girdle's plane
  double pavilion_degrees = 40.75;  ///< the same below it
  double girdle = 0.02;             ///< its height
  double star = 0.5;  ///< length of the star facets, of the way from the table to the girdle
  double lower_halves = 0.8;  ///< length of those below, of the way from the girdle to the point
};

/// A brilliant of 57 facets and 16 of the girdle about z; the girdle's lower edge is in the plane
/// z = 0, the table above it, the point below. Metres.
Mesh brilliant(double diameter, const BrilliantCut& cut = {});

}  // namespace kaustik::scenes
