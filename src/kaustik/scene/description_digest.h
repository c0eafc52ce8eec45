#pragma once
#include <cstdint>

#include "kaustik/scene/description.h"

namespace kaustik {

/// Numbers that differ in all likelihood between descriptions whose pictures differ.
struct DescriptionDigest {
  uint64_t scene = 0;       ///< of all but the scene's integrator
  uint64_t integrator = 0;  ///< of that
  friend bool operator==(const DescriptionDigest&, const DescriptionDigest&) = default;
};

/// Of every object, its type, id, properties and children in their order, and of the bytes of the
/// files that properties `filename` and `photon_map` name; where those lie makes no difference, nor
/// do comments and spaces in the scene file. Throws Error if such a file cannot be read.
DescriptionDigest description_digest(const Description& description);

}  // namespace kaustik
