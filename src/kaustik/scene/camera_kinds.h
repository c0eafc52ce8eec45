#pragma once
// The entries of camera_types() and film_types(), one per source file.

#include "kaustik/scene/camera.h"

namespace kaustik {

CameraType perspective_camera_type();
CameraType thin_lens_camera_type();
CameraType orthographic_camera_type();

/// "hdrfilm", and films of other programs that it stands for.
std::vector<FilmType> hdr_film_types();

}  // namespace kaustik
