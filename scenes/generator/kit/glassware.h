#pragma once
// Vessels of glass with what is in them; each stands on z = 0 about the origin. Metres.

#include "kit/primitives.h"

namespace kaustik::scenes {

/// Two closed bodies that overlap in the vessel's wall, for bsdfs with a `priority`: the glass's
/// has to be the higher one.
struct Vessel {
  Mesh glass, liquid;
};

/// What fills a vessel of revolution up to the height `level`. `inside` is the profile of its
/// hollow, from the axis upward; the liquid reaches `overlap` into the glass, and climbs
/// `meniscus` > 0 up the wall.
Mesh filling(const Curve& inside, double level, double overlap, double meniscus, int segments);

/// A decanter 23 cm high and 12 cm across, filled up to `level`.
Vessel decanter(double level);
/// A wine glass 19 cm high, filled up to `level`.
Vessel wine_glass(double level);

/// A cup 9 cm high of sheet metal with `flutes` flutes.
Mesh fluted_cup(int flutes);

}  // namespace kaustik::scenes
