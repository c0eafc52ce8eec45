#include "kaustik/integrator/auto.h"

#include "kaustik/integrator/path.h"
#include "kaustik/integrator/vcm.h"

namespace kaustik {

const TypeInfo& AutoIntegrator::info() { return auto_info(); }

AutoIntegrator::AutoIntegrator(const Arguments& arguments, const Scene& scene) {
  if (scene.has_scattering()) {
    method_ = std::make_unique<PathIntegrator>(arguments, scene);
    decision_ = "auto: paths from the camera alone, since media scatter light";
  } else {
    method_ = std::make_unique<VcmIntegrator>(arguments, scene);
  }
}

std::unique_ptr<PassState> AutoIntegrator::prepare(const Pass& pass, SplatBuffer& splats,
                                                   std::stop_token stop,
                                                   const ProgressFunction& progress) const {
  auto state = method_->prepare(pass, splats, stop, progress);
  if (!decision_.empty()) state->report.decisions.push_back(decision_);
  return state;
}

}  // namespace kaustik
