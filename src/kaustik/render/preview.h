#pragma once
#include <stop_token>

#include "kaustik/image/image.h"
#include "kaustik/scene/scene.h"

namespace kaustik {

/// A coarse first look at the scene ("R", "G", "B"): one path from the camera for each square of
/// pixels, some tens of thousands in all, so that it is there long before the first light pass of
/// another method. Paths from the camera do not find all light. Black where it was stopped.
Image preview_picture(const Scene& scene, uint64_t seed, const std::stop_token& stop);

}  // namespace kaustik
