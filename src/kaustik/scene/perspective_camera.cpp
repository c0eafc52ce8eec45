#include "kaustik/scene/camera_kinds.h"

namespace kaustik {
namespace {

/// A pinhole.
class Perspective final : public Camera {
 public:
  Perspective(const Arguments& arguments, const FilmSettings& film);

  Ray sample_ray(const Vec2f& raster, const Vec2f& u_lens) const override;
  CameraConnection connect(const Vec3f& point, const Vec2f& u_lens) const override;

 private:
  Vec3f left_, up_, forward_;
  float tan_x_ = 1, tan_y_ = 1;  ///< of half the fields of view
  Vec2f full_size_, crop_offset_, crop_size_, principal_offset_;
  float pixel_area_ = 1;  ///< of one pixel on the plane at distance 1
};

/// tan of half the field of view along x, from the axis that `fov` is measured on.
double tan_half_x(double fov_degrees, const std::string& axis, double aspect) {
  const double t = std::tan(0.5 * fov_degrees * std::numbers::pi / 180.0);
  if (axis == "y" || (axis == "smaller" && aspect > 1) || (axis == "larger" && aspect < 1))
    return t * aspect;
  if (axis == "diagonal") return t * aspect / std::sqrt(aspect * aspect + 1);
  return t;
}

Perspective::Perspective(const Arguments& arguments, const FilmSettings& film)
    : full_size_(float(film.size.x), float(film.size.y)),
      crop_offset_(float(film.crop_offset.x), float(film.crop_offset.y)),
      crop_size_(float(film.crop_size.x), float(film.crop_size.y)),
      principal_offset_(float(arguments.number("principal_point_offset_x")),
                        float(arguments.number("principal_point_offset_y"))) {
  const Transform& world_from_camera = arguments.transform("to_world");
  traits_.position = world_from_camera.point({0, 0, 0});
  left_ = world_from_camera.vector({1, 0, 0});
  up_ = world_from_camera.vector({0, 1, 0});
  forward_ = world_from_camera.vector({0, 0, 1});
  const float scale = length(forward_);
  const auto differs = [](float a, float b) { return std::fabs(a - b) > 1e-3f * b; };
  if (differs(length(left_), scale) || differs(length(up_), scale) ||
      abs_dot(left_, up_) + abs_dot(left_, forward_) + abs_dot(up_, forward_) >
          1e-3f * scale * scale)
    throw Error(ErrorKind::input, "the camera's to_world stretches or shears",
                "use translations, rotations, look-at and uniform scales only",
                arguments.place_of("to_world"));
  left_ *= 1 / scale;
  up_ *= 1 / scale;
  forward_ *= 1 / scale;

  const double aspect = double(full_size_.x) / full_size_.y;
  double fov = 0;
  std::string axis = arguments.text("fov_axis");
  if (arguments.given("fov")) {
    fov = arguments.number("fov");
  } else {
    // Mitsuba: the focal length refers to the diagonal of 36 × 24 mm film.
    const std::string& text =
        arguments.given("focal_length") ? arguments.text("focal_length") : "50mm";
    char* end = nullptr;
    const double millimetres = std::strtod(text.c_str(), &end);
    if (!(millimetres > 0) || std::string(end) != "mm")
      throw Error(ErrorKind::input, "'focal_length' is '" + text + "'",
                  "give a positive number followed by mm, such as 35mm",
                  arguments.place_of("focal_length"));
    fov =
        2 * std::atan(std::sqrt(36.0 * 36 + 24 * 24) / (2 * millimetres)) * 180 / std::numbers::pi;
    axis = "diagonal";
  }
  tan_x_ = float(tan_half_x(fov, axis, aspect));
  tan_y_ = float(tan_x_ / aspect);
  traits_.horizontal_fov = 360 * inv_pi * std::atan(tan_x_);
  traits_.vertical_fov = 360 * inv_pi * std::atan(tan_y_);
  pixel_area_ = 4 * tan_x_ * tan_y_ / (full_size_.x * full_size_.y);
  traits_.pixel_spread = 0.5f * std::sqrt(pixel_area_);
}

Ray Perspective::sample_ray(const Vec2f& raster, const Vec2f&) const {
  const float sx = (raster.x + crop_offset_.x) / full_size_.x + principal_offset_.x;
  const float sy = (raster.y + crop_offset_.y) / full_size_.y + principal_offset_.y;
  const Vec3f d = forward_ + left_ * ((1 - 2 * sx) * tan_x_) + up_ * ((1 - 2 * sy) * tan_y_);
  return {traits_.position, normalize(d), infinity};
}

CameraConnection Perspective::connect(const Vec3f& point, const Vec2f&) const {
  CameraConnection c;
  c.lens = traits_.position;
  const Vec3f to_camera = c.lens - point;
  c.distance = length(to_camera);
  if (!(c.distance > 0)) return c;
  c.direction = to_camera * (1 / c.distance);
  const float cosine = -dot(c.direction, forward_);
  if (!(cosine > 0)) return c;
  const float x = -dot(c.direction, left_) / cosine, y = -dot(c.direction, up_) / cosine;
  c.raster.x = (0.5f * (1 - x / tan_x_) - principal_offset_.x) * full_size_.x - crop_offset_.x;
  c.raster.y = (0.5f * (1 - y / tan_y_) - principal_offset_.y) * full_size_.y - crop_offset_.y;
  // A margin of the widest filter: splats beyond the edge still reach pixels inside.
  constexpr float margin = 16;
  if (!(c.raster.x > -margin && c.raster.y > -margin && c.raster.x < crop_size_.x + margin &&
        c.raster.y < crop_size_.y + margin))
    return c;
  c.importance = 1 / (pixel_area_ * cosine * cosine * cosine);
  return c;
}

const TypeInfo& perspective_info() {
  static const TypeInfo info{
      "sensor",
      "perspective",
      "Pinhole camera that looks along +z of its own space; +x points to the left of the picture.",
      {to_world_parameter("From the camera's space to the world."),
       optional(number_parameter("fov", 50, "Field of view along fov_axis.")
                    .range(1e-4, 179.9)
                    .in("degrees")),
       optional(text_parameter("focal_length", "50mm",
                               "Focal length for 35 mm film, instead of fov (a number and mm).")),
       choice_parameter("fov_axis", "x", {"x", "y", "diagonal", "smaller", "larger"},
                        "What fov is measured along."),
       number_parameter("principal_point_offset_x", 0,
                        "Where the picture's centre lies right of the optical axis, as a share of "
                        "its width.")
           .range(-100, 100),
       number_parameter("principal_point_offset_y", 0,
                        "Where the picture's centre lies below the optical axis, as a share of its "
                        "height.")
           .range(-100, 100),
       ignored_parameter("near_clip", ParameterKind::number),
       ignored_parameter("far_clip", ParameterKind::number),
       ignored_parameter("focus_distance", ParameterKind::number),
       ignored_parameter("shutter_open", ParameterKind::number),
       ignored_parameter("shutter_close", ParameterKind::number)}};
  return info;
}

std::unique_ptr<Camera> create_perspective(const Arguments& arguments, const FilmSettings& film) {
  return std::make_unique<Perspective>(arguments, film);
}

}  // namespace

CameraType perspective_camera_type() { return {perspective_info(), create_perspective}; }

}  // namespace kaustik
