#pragma once
#include "kaustik/geometry/shape.h"

namespace kaustik {

/// The mesh of the arguments `positions`, `faces`, `normals`, `uv` and of the attributes, in its
/// own space; what is not given is empty. Throws Error(input), at the place of the buffer that is
/// wrong, for numbers that are not finite, indices that are out of range, buffers that do not go
/// together, and a mesh without faces.
TriangleMesh mesh_of_buffers(const Arguments& arguments);

/// Their rows.
std::vector<Parameter> mesh_buffer_parameters();

}  // namespace kaustik
