#pragma once
#include <memory>

#include "kaustik/loader/nori/reading.h"

namespace kaustik::nori {

/// What stands for a <bsdf>.
std::shared_ptr<Object> bsdf_of(const Object& element, Reading& reading);
/// That of meshes which have none.
std::shared_ptr<Object> usual_bsdf(const Place& place);
/// Matt, of one reflectance.
std::shared_ptr<Object> matt(const Rgb& reflectance, const Place& place);
/// What stands for a <texture>; null: nothing, which is told.
std::shared_ptr<Object> texture_of(const Object& element, Reading& reading);

}  // namespace kaustik::nori
