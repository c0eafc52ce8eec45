#pragma once
#include <cstdint>
#include <vector>

#include "kaustik/scene/description.h"

namespace kaustik {

/// The picture of a texture `bitmap`, as its `raw`, `gamma` and `channel` have it, times a factor:
/// an EXR file of single floats, grey where the picture and the factor are. A bitmap of that file
/// without `gamma` and `channel` is the same texture times the factor. Throws Error(input) for what
/// build_scene() would refuse.
std::vector<uint8_t> picture_as_exr(const Object& bitmap, const Rgb& factor);

}  // namespace kaustik
