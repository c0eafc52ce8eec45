#include <fmt/format.h>

#include "kaustik/integrator/auto.h"
#include "kaustik/integrator/integrator.h"
#include "kaustik/integrator/light_tracer.h"
#include "kaustik/integrator/local_phong.h"
#include "kaustik/integrator/path.h"
#include "kaustik/integrator/photon_map_integrator.h"
#include "kaustik/integrator/ray_tracing.h"
#include "kaustik/integrator/vcm.h"

namespace kaustik {
namespace {

template <typename T>
IntegratorType row(const TypeInfo& info) {
  return {info, std::is_base_of_v<IlluminationModel, T>,
          [](const Arguments& arguments, const Scene& scene) -> std::unique_ptr<Integrator> {
            return std::make_unique<T>(arguments, scene);
          }};
}

IntegratorType from_camera_alone(IntegratorType type) {
  type.is_from_camera_alone = true;
  return type;
}

std::vector<std::string> valid_components() {
  return {component_names.begin(), component_names.end()};
}

}  // namespace

const std::vector<IntegratorType>& integrator_types() {
  static const std::vector<IntegratorType> types{
      row<AutoIntegrator>(AutoIntegrator::info()),
      from_camera_alone(row<PathIntegrator>(PathIntegrator::info())),
      row<LightTracer>(LightTracer::info()),
      row<PhotonMapIntegrator>(PhotonMapSettings::info()),
      row<VcmIntegrator>(vcm_info()),
      row<VcmIntegrator>(bdpt_info()),
      row<VcmIntegrator>(ppm_info()),
      from_camera_alone(row<LocalPhong>(LocalPhong::info())),
      from_camera_alone(row<RayTracing>(RayTracing::info())),
  };
  return types;
}

Parameter components_parameter() {
  return text_parameter("components", "all",
                        "Parts of the light to compute, separated by commas: emission, direct, "
                        "caustic, indirect, specular, volume, or all.");
}

ComponentSet read_components(const Arguments& arguments) {
  const std::string& text = arguments.text("components");
  if (text == "all") return ComponentSet::all();
  ComponentSet set;
  for (size_t start = 0; start <= text.size();) {
    const size_t end = std::min(text.find(',', start), text.size());
    std::string name = text.substr(start, end - start);
    std::erase(name, ' ');
    bool known = false;
    for (int i = 0; i < component_count; ++i)
      if (name == component_names[size_t(i)]) {
        set.add(Component(i));
        known = true;
      }
    if (!known)
      throw Error(ErrorKind::input, fmt::format("'components' names '{}'", name),
                  suggest(name, valid_components()), arguments.place_of("components"));
    start = end + 1;
  }
  return set;
}

}  // namespace kaustik
