#pragma once
// What lies on tables; each lies on z = 0 about the origin. Metres.

#include "kit/primitives.h"

namespace kaustik::scenes {

/// A pear 10 cm high, standing; its neck leans a little.
struct Pear {
  Mesh flesh, stalk;
};
Pear pear(uint64_t seed);

/// A lemon 8 cm long, lying along x.
Mesh lemon(uint64_t seed);

/// A closed book lying flat, its spine at low y: width along x is the spine's length.
struct Book {
  Mesh cover, pages, gilding;
};
Book book(double spine, double depth, double thickness);

}  // namespace kaustik::scenes
