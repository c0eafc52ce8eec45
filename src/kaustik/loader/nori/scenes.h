#pragma once
#include <memory>

#include "kaustik/loader/nori/reading.h"

namespace kaustik::nori {

struct ReadScene {
  std::shared_ptr<Object> scene;
  std::string difference;  ///< why its picture is another one than Nori's; "": it is the same
};

/// What stands for a <scene>. Throws Error(input) if it has no camera.
ReadScene scene_of(const Object& element, Reading& reading);
/// A scene whose one shape, a ball, has the bsdf.
std::shared_ptr<Object> ball_of(const Object& bsdf, Reading& reading);

}  // namespace kaustik::nori
