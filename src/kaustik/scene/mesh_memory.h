#pragma once
#include <cstdint>

#include "kaustik/scene/description.h"

namespace kaustik {

/// Bytes that the meshes of a scene take at most while they are read and made ready for rays, by
/// the sizes of their files and buffers: 10 million triangles in a binary PLY file of 190 MB
/// take 1.3 GB, text less for its size. Each counts once; what cannot be read, nothing.
uint64_t expected_mesh_memory(const Description& description);

}  // namespace kaustik
