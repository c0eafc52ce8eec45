#pragma once
#include <optional>

#include "kaustik/loader/radiance/materials.h"

namespace kaustik::radiance {

/// Where a lamp's surface stands.
struct LampSurface {
  Vec3d middle;
  double area = 0;              ///< of spheres: as it is seen
  std::optional<Vec3d> normal;  ///< unit, of flat surfaces; nothing: a sphere
};

/// A point lamp that shines from afar as the surface does, direction by direction: its radiance
/// times the pattern, its area, and the cosine. Null where it is dark, nothing where its pattern
/// has no value in any direction.
std::optional<ObjectPointer> luminaire_of(const DirectedLight& light, const LampSurface& surface,
                                          const Place& place);

}  // namespace kaustik::radiance
