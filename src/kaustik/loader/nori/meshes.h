#pragma once
#include <memory>

#include "kaustik/loader/nori/reading.h"

namespace kaustik::nori {

/// What stands for a <mesh> with its bsdf and its light; null: nothing, which is told.
std::shared_ptr<Object> shape_of(const Object& element, Reading& reading);

}  // namespace kaustik::nori
