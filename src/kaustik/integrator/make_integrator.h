#pragma once
#include "kaustik/transport/integrator.h"

namespace kaustik {

/// Makes the integrator that `object` describes for `scene`, which must outlive it, and the models
/// of the scene's surfaces that have one of their own (Surface::illumination). What is accepted
/// without effect goes to `warnings`. Throws Error for unknown types and wrong parameters, and if
/// it `is_strict` for unknown ones (Description::is_strict).
std::unique_ptr<Integrator> make_integrator(const Object& object, const Scene& scene,
                                            std::vector<std::string>& warnings,
                                            bool is_strict = false);

/// The same without the models of surfaces.
std::unique_ptr<Integrator> make_integrator_alone(const Object& object, const Scene& scene,
                                                  std::vector<std::string>& warnings,
                                                  bool is_strict = false);

}  // namespace kaustik
