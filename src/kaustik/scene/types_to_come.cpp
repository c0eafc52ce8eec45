#include "kaustik/scene/types_to_come.h"

#include <string_view>

#include "kaustik/material/bsdf.h"

namespace kaustik {
namespace {

struct Row {
  std::string_view family, type, remedy;
};

constexpr std::string_view curves = "export the curves as a mesh of tubes (ply)";
constexpr std::string_view ellipsoids = "some few can be spheres, each with a to_world of its own";
constexpr Row rows[] = {
    {"shape", "bsplinecurve", curves},
    {"shape", "linearcurve", curves},
    {"shape", "hair", curves},
    {"shape", "ellipsoids", ellipsoids},
    {"shape", "ellipsoidsmesh", ellipsoids},
    {"shape", "deformable", "export it at one time as a mesh (ply, obj)"},
    {"shape", "packed", "export the mesh as ply or serialized"},
    {"emitter", "collimated", "use a 'spot' with a small 'cutoff_angle'"},
    {"emitter", "timed_sunsky", "use 'sunsky' with the hour that matters most"},
    {"sensor", "perspective_rdist", ""},
    {"texture", "wireframe", ""},
    {"texture", "curvature", ""},
    {"phase", "sggx", ""},
    {"phase", "microflake", ""},
    {"phase", "kkay", ""},
    {"phase", "mixturephase", ""},
    {"volume", "nanovdb", "convert it to a gridvolume (.vol)"},
    {"volume", "nanovdbvolume", "convert it to a gridvolume (.vol)"},
    {"volume", "vdb", "convert it to a gridvolume (.vol)"},
    {"volume", "vdbvolume", "convert it to a gridvolume (.vol)"},
    {"volume", "volcache", ""},
    {"volume", "orientation", ""},
    {"volume", "hgridvolume", ""},
    {"volume", "fibervolume", ""},
};

}  // namespace

std::optional<std::string> remedy_for_type_to_come(const Object& object) {
  if (object.family == "bsdf") {
    const std::string_view remedy = remedy_for_bsdf_to_come(object.type);
    if (!remedy.empty()) return std::string(remedy);
  }
  for (const Row& row : rows)
    if (object.family == row.family && object.type == row.type) return std::string(row.remedy);
  return std::nullopt;
}

}  // namespace kaustik
