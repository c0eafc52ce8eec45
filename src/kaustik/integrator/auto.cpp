#include "kaustik/integrator/auto.h"

#include "kaustik/integrator/vcm.h"

namespace kaustik {

const TypeInfo& AutoIntegrator::info() { return auto_info(); }

AutoIntegrator::AutoIntegrator(const Arguments& arguments, const Scene& scene) {
  method_ = std::make_unique<VcmIntegrator>(arguments, scene);
}

std::unique_ptr<PassState> AutoIntegrator::prepare(const Pass& pass, SplatBuffer& splats,
                                                   std::stop_token stop,
                                                   const ProgressFunction& progress) const {
  return method_->prepare(pass, splats, stop, progress);
}

}  // namespace kaustik
