#include "kaustik/scene/camera.h"

#include <algorithm>
#include <cmath>

#include "kaustik/scene/camera_kinds.h"

namespace kaustik {

LensNumbers Camera::numbers_to_look_around(uint32_t i) const {
  if (traits_.can_connect) return middle_of_lens();
  // Multiples of the powers of 1/x, x⁵ = x + 1, fill four dimensions evenly (Roberts 2018).
  const auto number = [&](double step) {
    return std::min(float(std::fmod(0.5 + double(i) * step, 1.0)), one_minus_epsilon);
  };
  return {{number(0.8566748838), number(0.7338918566)},
          {number(0.6287067211), number(0.5385972572)}};
}

const std::vector<CameraType>& camera_types() {
  static const std::vector<CameraType> types = {
      perspective_camera_type(), thin_lens_camera_type(), orthographic_camera_type(),
      telecentric_camera_type(), fisheye_camera_type(),   spherical_camera_type(),
      cylinder_camera_type(),    irradiance_meter_type(), irradiance_points_type(),
      radiance_meter_type(),     radiance_rays_type(),    fluence_meter_type(),
      distant_camera_type()};
  return types;
}

const std::vector<FilmType>& film_types() {
  static const std::vector<FilmType> types = hdr_film_types();
  return types;
}

}  // namespace kaustik
