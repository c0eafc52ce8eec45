#include "kaustik/scene/foreign_shapes.h"

#include <utility>

namespace kaustik {

std::string remedy_for_foreign_shape(const std::string& type) {
  constexpr const char* curves = "leave the curves out, or export them as a mesh of tubes (ply)";
  constexpr const char* ellipsoids =
      "leave them out; some few can be spheres, each with a to_world of its own";
  static const std::pair<const char*, const char*> remedies[] = {
      {"bsplinecurve", curves},
      {"linearcurve", curves},
      {"hair", curves},
      {"ellipsoids", ellipsoids},
      {"ellipsoidsmesh", ellipsoids},
      {"deformable", "export it at one time as a mesh (ply, obj)"},
      {"packed", "export the mesh as ply or serialized"}};
  for (const auto& [name, remedy] : remedies)
    if (type == name) return remedy;
  return {};
}

}  // namespace kaustik
