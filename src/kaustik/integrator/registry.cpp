#include "kaustik/integrator/registry.h"

#include "kaustik/integrator/light_tracer.h"
#include "kaustik/integrator/local_phong.h"
#include "kaustik/integrator/path.h"
#include "kaustik/integrator/ray_tracing.h"
#include "kaustik/photonmap/photon_map_integrator.h"
#include "kaustik/vcm/vcm.h"

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

IntegratorType at_gauges(IntegratorType type) {
  type.knows_gauges = true;
  return type;
}

}  // namespace

const std::vector<IntegratorType>& integrator_types() {
  static const std::vector<IntegratorType> types{
      at_gauges(row<VcmIntegrator>(auto_info())),
      at_gauges(from_camera_alone(row<PathIntegrator>(PathIntegrator::info()))),
      row<LightTracer>(LightTracer::info()),
      at_gauges(row<PhotonMapIntegrator>(PhotonMapSettings::info())),
      at_gauges(row<VcmIntegrator>(vcm_info())),
      at_gauges(row<VcmIntegrator>(bdpt_info())),
      at_gauges(row<VcmIntegrator>(ppm_info())),
      from_camera_alone(row<LocalPhong>(LocalPhong::info())),
      from_camera_alone(row<RayTracing>(RayTracing::info())),
  };
  return types;
}

}  // namespace kaustik
