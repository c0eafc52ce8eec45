#pragma once
#include <set>

#include "kaustik/loader/file_search.h"
#include "kaustik/scene/description.h"

namespace kaustik {

/// Mitsuba 0.6 gives shapes of type `obj` the materials that their files name (`usemtl`), out of
/// the MTL files that these name (`mtllib`), unless the shape has a bsdf of its own; bsdfs in the
/// shape that bear the name of a material stand for it. Each of `shapes` becomes one shape for each
/// material. Their parameter `load_materials` is done with. Files that cannot be read are left to
/// those who read the mesh; MTL files count as sources, what is left out as warnings.
void use_obj_materials(Description& description, const std::set<const Object*>& shapes,
                       const FindBeside& find);

}  // namespace kaustik
