#pragma once
#include <memory>

#include "kaustik/loader/nori/reading.h"

namespace kaustik::nori {

/// Puts what stands for an <integrator> into the scene that has all else. Those that show no
/// materials (`ao`, `av`, `simple`) change its surfaces and its light. Returns why the picture is
/// another one than Nori's; "": it is the same.
std::string add_integrator(Object& scene, const Object& element, Reading& reading);

}  // namespace kaustik::nori
