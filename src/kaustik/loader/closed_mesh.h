#pragma once
#include "kaustik/base/array.h"

namespace kaustik {

/// Whether triangles enclose space: each edge belongs to two of them, which run along it in
/// opposite directions. Vertices at the same place are one. `positions`: floats [n, 3]; `faces`:
/// integers [m, 3], none of which may be out of range for a mesh that is closed.
bool is_closed(const Array& positions, const Array& faces);

}  // namespace kaustik
