#pragma once
#include <cstddef>
#include <optional>

#include "kaustik/scene/description.h"

namespace kaustik::pbrt {

/// The area of a shape in the world, m²; nothing: only the renderer can tell.
std::optional<double> area_of(const Object& shape);
/// Whether all of so many equal parts of a mesh's list of faces have the same area, about.
bool has_even_parts(const Object& shape, size_t parts);

}  // namespace kaustik::pbrt
