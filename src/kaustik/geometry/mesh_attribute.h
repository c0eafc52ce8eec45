#pragma once
#include <string>
#include <string_view>

#include "kaustik/geometry/shape.h"

namespace kaustik {

/// Null: the mesh has none of that name.
const MeshAttribute* find_attribute(const TriangleMesh& mesh, std::string_view name);

/// The one of that name; `who` is what the shape is called. Throws Error(input) at `place`, which
/// names those that there are, if it has none of the name or is no mesh.
const MeshAttribute& attribute_named(const Shape& shape, const std::string& who,
                                     const std::string& name, const Place& place);

/// At a point of a triangle; a single number stands in all three places.
Vec3f attribute_at(const TriangleMesh& mesh, const MeshAttribute& attribute, uint32_t triangle,
                   const Vec3f& position);
/// How the sum of the components times `weights` changes with the position on a triangle, per m; a
/// vector in its plane.
Vec3f attribute_gradient(const TriangleMesh& mesh, const MeshAttribute& attribute,
                         uint32_t triangle, const Vec3f& weights);
/// By area.
Vec3f attribute_mean(const TriangleMesh& mesh, const MeshAttribute& attribute);
/// Of all components; zero if there are no values.
float attribute_maximum(const MeshAttribute& attribute);

/// What a stored number stands for: integers for the part of `largest` that they are, sRGB encoded,
/// as 8-bit pictures have it and Mitsuba reads them; floats (`largest` is 0) for themselves.
float attribute_value(double stored, double largest);

/// Makes what is not finite 0; how many values that were.
size_t make_finite(MeshAttribute& attribute);
/// The remark on them.
std::string remark_on_attribute(const std::string& name, size_t count, const std::string& file);

}  // namespace kaustik
