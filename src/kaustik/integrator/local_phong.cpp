#include "kaustik/integrator/local_phong.h"
#include "kaustik/transport/integrator_parameters.h"

namespace kaustik {
namespace {

std::vector<Parameter> parameters() {
  std::vector<Parameter> rows = LocalLight::parameters();
  rows.insert(rows.begin(), components_parameter());
  return rows;
}

}  // namespace

const TypeInfo& LocalPhong::info() {
  static const TypeInfo info{"integrator", "localphong",
                             "Local illumination as in Phong's model: direct light by each "
                             "surface's bsdf, plus ambient light. No mirror images.",
                             parameters()};
  return info;
}

LocalPhong::LocalPhong(const Arguments& arguments, const Scene& scene)
    : IlluminationModel(scene), light_(arguments) {
  traits_.components = read_components(arguments);
  traits_.default_samples_per_pass = 16;
}

bool LocalPhong::reflect(const PassState&, CameraWalk& walk, const RadianceTracer&) const {
  light_.add_to(walk, Lobes::all);
  return false;
}

}  // namespace kaustik
