#pragma once
#include <memory>

#include "kaustik/loader/nori/reading.h"

namespace kaustik::nori {

/// What stands for a <camera>, with its film and the sampler of the scene (null: none).
std::shared_ptr<Object> sensor_of(const Object& element, const Object* sampler, Reading& reading);

}  // namespace kaustik::nori
