#pragma once
// Textures that do nothing but make the facets of a smooth surface smooth.

#include <optional>
#include <vector>

#include "kaustik/base/transform.h"
#include "kaustik/loader/radiance/modifiers.h"

namespace kaustik::radiance {

/// Whether a modifier is one: that of gensurf (surf.cal), that of obj2rad (tmesh.cal), or Kaustik's
/// own, see FacetWriter.
bool is_smoothing(const Modifier* modifier);

/// The normals at the corners of a polygon with such a modifier, in the world, of any length;
/// nothing for others. `placed` is world from the space of the polygon.
std::optional<std::vector<Vec3d>> corner_normals_of(const Modifier* modifier,
                                                    const Primitive& polygon,
                                                    const Transform& placed);

}  // namespace kaustik::radiance
