#pragma once
// What is seen where something of a scene is missing.

#include <memory>

#include "kaustik/scene/description.h"

namespace kaustik {

/// In place of a picture that is not there: a magenta checker.
std::shared_ptr<Object> missing_texture(const Place& place);
/// In place of a mesh that is not there and whose box is known: that box, in the mesh's own space.
std::shared_ptr<Object> missing_mesh(const Bounds3f& box, const Transform& to_world,
                                     const Place& place);

}  // namespace kaustik
