#include "kaustik/scene/camera_view.h"

#include <cmath>
#include <cstdlib>
#include <numbers>

namespace kaustik {
namespace {

Vec2f principal_offset_of(const Arguments& arguments) {
  return {float(arguments.number("principal_point_offset_x")),
          float(arguments.number("principal_point_offset_y"))};
}

}  // namespace

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

ClipRange::ClipRange(const Arguments& arguments) {
  if (arguments.given("near_clip")) near_ = float(arguments.number("near_clip"));
  if (arguments.given("far_clip")) far_ = float(arguments.number("far_clip"));
  if (!(near_ < far_))
    throw Error(ErrorKind::input, "'near_clip' is not below 'far_clip': nothing is left to see",
                "give a smaller 'near_clip', or leave both out",
                arguments.place_of(arguments.given("far_clip") ? "far_clip" : "near_clip"));
}

std::vector<Parameter> clip_parameters() {
  return {optional(number_parameter("near_clip", 0,
                                    "Surfaces nearer than this are cut off, see "
                                    "docs/reference/sensor/index.md; none if absent.")
                       .range(0, 1e12)
                       .in("m")),
          optional(number_parameter("far_clip", 1e4,
                                    "Surfaces farther than this are cut off, see "
                                    "docs/reference/sensor/index.md; none if absent.")
                       .range(0, 1e12)
                       .in("m"))};
}

StraightView::StraightView(const CameraInputs& inputs)
    : frame(inputs.arguments, true),
      window(inputs.film, principal_offset_of(inputs.arguments)),
      clip(inputs.arguments),
      tan(tan_half_fov(inputs.arguments, window.aspect())),
      pixel_area(4 * tan.x * tan.y / window.pixels()) {}

CameraTraits StraightView::traits() const {
  CameraTraits result;
  result.position = frame.position;
  result.horizontal_fov = 360 * inv_pi * std::atan(tan.x);
  result.vertical_fov = 360 * inv_pi * std::atan(tan.y);
  result.pixel_spread = 0.5f * std::sqrt(pixel_area);
  return result;
}

CameraConnection StraightView::connect(const Vec3f& point, const Vec3f& lens,
                                       const Vec2f& shift) const {
  CameraConnection c;
  c.lens = lens;
  const Vec3f to_camera = c.lens - point;
  c.distance = length(to_camera);
  if (!(c.distance > 0)) return c;
  c.direction = to_camera * (1 / c.distance);
  const Vec3f local = frame.to_local(-c.direction);
  if (!(local.z > 0)) return c;
  const float x = local.x / local.z + shift.x, y = local.y / local.z + shift.y;
  c.raster = window.raster_of({x / tan.x, y / tan.y});
  // Through each point of the lens the plane is seen as through a pinhole there.
  if (window.holds(c.raster)) c.importance = 1 / (pixel_area * local.z * local.z * local.z);
  clip.clip(c, local.z);
  return c;
}

std::vector<Parameter> straight_view_parameters() {
  std::vector<Parameter> rows = field_of_view_parameters();
  rows.push_back(number_parameter("principal_point_offset_x", 0,
                                  "Offset of the picture's centre to the right of the optical "
                                  "axis, as a fraction of the width.")
                     .range(-100, 100));
  rows.push_back(
      number_parameter(
          "principal_point_offset_y", 0,
          "Offset of the picture's centre below the optical axis, as a fraction of the height.")
          .range(-100, 100));
  for (Parameter& row : clip_parameters()) rows.push_back(std::move(row));
  return rows;
}

Vec3f meter_direction(const Arguments& arguments) {
  const bool is_placed = arguments.given("to_world") || !arguments.given("direction");
  const Vec3d along = is_placed ? Vec3d(arguments.transform("to_world").vector({0, 0, 1}))
                                : arguments.point("direction");
  const double size = along.length();
  if (!(size > 0 && std::isfinite(size)))
    throw Error(ErrorKind::input, "the direction of view is zero, or beyond all numbers",
                "give a 'direction' or a 'to_world' of usual size",
                arguments.place_of(is_placed ? "to_world" : "direction"));
  return Vec3f(along.normalized());
}

std::vector<Parameter> ignored_camera_parameters() {
  return {ignored_parameter("shutter_open", ParameterKind::number),
          ignored_parameter("shutter_close", ParameterKind::number),
          ignored_parameter("srf", ParameterKind::color)};
}

TypeInfo camera_info(const std::string& name, const std::string& sentence,
                     std::vector<Parameter> rows) {
  for (Parameter& row : ignored_camera_parameters()) rows.push_back(std::move(row));
  return {"sensor", name, sentence, std::move(rows)};
}

TypeInfo placed_camera_info(const std::string& name, const std::string& sentence,
                            std::vector<Parameter> own_rows, std::vector<Parameter> view_rows) {
  std::vector<Parameter> rows = {
      to_world_parameter("Transform from the camera's space to the world.")};
  for (auto* some : {&own_rows, &view_rows})
    rows.insert(rows.end(), std::make_move_iterator(some->begin()),
                std::make_move_iterator(some->end()));
  return camera_info(name, sentence, std::move(rows));
}

}  // namespace kaustik
