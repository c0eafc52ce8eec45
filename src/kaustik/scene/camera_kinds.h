#pragma once
// The entries of camera_types() and film_types(), one per source file.

#include "kaustik/scene/camera.h"

namespace kaustik {

CameraType perspective_camera_type();
CameraType thin_lens_camera_type();
CameraType orthographic_camera_type();
CameraType telecentric_camera_type();
CameraType fisheye_camera_type();
CameraType spherical_camera_type();
CameraType cylinder_camera_type();
CameraType irradiance_meter_type();
CameraType irradiance_points_type();
CameraType radiance_meter_type();
CameraType radiance_rays_type();
CameraType fluence_meter_type();
CameraType distant_camera_type();

/// "hdrfilm", and films of other programs that it stands for.
std::vector<FilmType> hdr_film_types();

}  // namespace kaustik
