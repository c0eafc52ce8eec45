#include "kaustik/scene/camera_kinds.h"
#include "kaustik/scene/camera_view.h"

namespace kaustik {
namespace {

/// A camera that sees everything along one direction, through a rectangle around its place: to the
/// picture's width 2 times the scale of to_world.
class Orthographic final : public Camera {
 public:
  Orthographic(const Arguments& arguments, const FilmSettings& film)
      : frame_(arguments, false),
        window_(film),
        half_(frame_.scale.x, frame_.scale.y / float(window_.aspect())),
        pixel_area_(4 * half_.x * half_.y / window_.pixels()) {
    traits_.position = frame_.position;
    traits_.pixel_width = 0.5f * std::sqrt(pixel_area_);
  }

  Ray sample_ray(const Vec2f& raster, const Vec2f&) const override {
    const Vec2f plane = window_.plane_of(raster);
    return {frame_.position + frame_.left * (plane.x * half_.x) + frame_.up * (plane.y * half_.y),
            frame_.forward, infinity};
  }

  CameraConnection connect(const Vec3f& point, const Vec2f&) const override {
    CameraConnection c;
    const Vec3f local = frame_.to_local(point - frame_.position);
    c.lens = point - frame_.forward * local.z;
    c.direction = -frame_.forward;
    c.distance = local.z;
    if (!(local.z > 0)) return c;
    c.raster = window_.raster_of({local.x / half_.x, local.y / half_.y});
    // A pixel sees so much area, however far away: the square of the distance cancels.
    if (window_.holds(c.raster)) c.importance = sqr(local.z) / pixel_area_;
    return c;
  }

 private:
  CameraFrame frame_;
  PictureWindow window_;
  Vec2f half_;        ///< of the picture's width and height, m
  float pixel_area_;  ///< m²
};

TypeInfo make_orthographic_info() {
  TypeInfo info{"sensor",
                "orthographic",
                "Camera that sees along parallel lines; the scale of to_world is half of the "
                "picture's width.",
                {to_world_parameter("From the camera's space to the world.")}};
  for (Parameter& parameter : ignored_camera_parameters())
    info.parameters.push_back(std::move(parameter));
  info.parameters.push_back(ignored_parameter("focus_distance", ParameterKind::number));
  return info;
}

const TypeInfo& orthographic_info() {
  static const TypeInfo info = make_orthographic_info();
  return info;
}

std::unique_ptr<Camera> create_orthographic(const Arguments& arguments, const FilmSettings& film) {
  return std::make_unique<Orthographic>(arguments, film);
}

}  // namespace

CameraType orthographic_camera_type() { return {orthographic_info(), create_orthographic}; }

}  // namespace kaustik
