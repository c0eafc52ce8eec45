#include "kaustik/scene/camera.h"

#include "kaustik/scene/camera_kinds.h"

namespace kaustik {

const std::vector<CameraType>& camera_types() {
  static const std::vector<CameraType> types = {perspective_camera_type(), thin_lens_camera_type(),
                                                orthographic_camera_type()};
  return types;
}

const std::vector<FilmType>& film_types() {
  static const std::vector<FilmType> types = hdr_film_types();
  return types;
}

}  // namespace kaustik
