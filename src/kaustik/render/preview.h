#pragma once
#include <stop_token>

#include "kaustik/image/image.h"
#include "kaustik/scene/scene.h"

namespace kaustik {

/// A first look at the scene ("R", "G", "B"): one path from the camera for each square of pixels,
/// about 20 000 in all, smoothed by denoise() and spread over the pixels between. It is there long
/// before the first light pass of another method. No picture to measure anything by: paths from the
/// camera do not find all light, and what is small is missing or blurred. Black where it was
/// stopped. Its metadata say what it is: incomplete_key.
Image preview_picture(const Scene& scene, uint64_t seed, const std::stop_token& stop);

}  // namespace kaustik
