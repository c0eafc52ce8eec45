#pragma once
#include <memory>

#include "kaustik/base/array.h"

namespace kaustik::gltf {

/// How indices become triangles, as glTF numbers it.
enum class Topology { triangles = 4, strip = 5, fan = 6 };

/// Triangles [n, 3] of indices [m], or of 0 … vertices − 1 where they are null. Triangles that lie
/// one by one are those of the buffer, not copied; what is left over at the end is left out.
std::shared_ptr<const Array> triangles_of(const std::shared_ptr<const Array>& indices,
                                          size_t vertices, Topology topology);

}  // namespace kaustik::gltf
