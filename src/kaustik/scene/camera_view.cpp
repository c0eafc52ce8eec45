#include "kaustik/scene/camera_view.h"

namespace kaustik {

CameraFrame::CameraFrame(const Arguments& arguments, bool is_uniform) {
  const Transform& world_from_camera = arguments.transform("to_world");
  position = world_from_camera.point({0, 0, 0});
  left = world_from_camera.vector({1, 0, 0});
  up = world_from_camera.vector({0, 1, 0});
  forward = world_from_camera.vector({0, 0, 1});
  const float ahead = length(forward);
  scale = {length(left), length(up)};
  const auto differs = [](float a, float b) { return std::fabs(a - b) > 1e-3f * b; };
  const bool is_stretched = is_uniform ? differs(scale.x, ahead) || differs(scale.y, ahead)
                                       : !(scale.x > 0 && scale.y > 0 && ahead > 0);
  if (is_stretched || abs_dot(left, up) > 1e-3f * scale.x * scale.y ||
      abs_dot(left, forward) > 1e-3f * scale.x * ahead ||
      abs_dot(up, forward) > 1e-3f * scale.y * ahead)
    throw Error(ErrorKind::input, "the camera's to_world stretches or shears",
                is_uniform ? "use translations, rotations, look-at and uniform scales only"
                           : "use translations, rotations, look-at and scales only",
                arguments.place_of("to_world"));
  left *= 1 / (is_uniform ? ahead : scale.x);
  up *= 1 / (is_uniform ? ahead : scale.y);
  forward *= 1 / ahead;
}

PictureWindow::PictureWindow(const FilmSettings& film, const Vec2f& principal_offset)
    : full_size_(float(film.size.x), float(film.size.y)),
      crop_offset_(float(film.crop_offset.x), float(film.crop_offset.y)),
      crop_size_(float(film.crop_size.x), float(film.crop_size.y)),
      principal_offset_(principal_offset) {}

Vec2f principal_offset_of(const Arguments& arguments) {
  return {float(arguments.number("principal_point_offset_x")),
          float(arguments.number("principal_point_offset_y"))};
}

std::vector<Parameter> perspective_parameters() {
  std::vector<Parameter> rows = field_of_view_parameters();
  rows.push_back(number_parameter("principal_point_offset_x", 0,
                                  "Where the picture's centre lies right of the optical axis, as "
                                  "a share of its width.")
                     .range(-100, 100));
  rows.push_back(number_parameter("principal_point_offset_y", 0,
                                  "Where the picture's centre lies below the optical axis, as a "
                                  "share of its height.")
                     .range(-100, 100));
  return rows;
}

std::vector<Parameter> ignored_camera_parameters() {
  return {ignored_parameter("near_clip", ParameterKind::number),
          ignored_parameter("far_clip", ParameterKind::number),
          ignored_parameter("shutter_open", ParameterKind::number),
          ignored_parameter("shutter_close", ParameterKind::number)};
}

}  // namespace kaustik
