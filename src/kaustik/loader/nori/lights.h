#pragma once
#include <memory>

#include "kaustik/loader/nori/reading.h"

namespace kaustik::nori {

/// What stands for an <emitter> of the scene; null: nothing, which is told.
std::shared_ptr<Object> lamp_of(const Object& element, Reading& reading);
/// Whether an <emitter> is a picture around the scene, wherever it stands.
bool is_surroundings(const Object& element);
/// Light that is the same from everywhere, and not seen by the camera unless `is_visible`.
std::shared_ptr<Object> even_light(const Rgb& radiance, bool is_visible, const Place& place);
/// A lamp of that power, W, equal in all directions.
std::shared_ptr<Object> point_lamp(const Rgb& power, const Vec3d& position, const Place& place);
/// What stands for an <emitter> of a mesh; null: nothing, which is told.
std::shared_ptr<Object> area_lamp_of(const Object& element, Reading& reading);

}  // namespace kaustik::nori
