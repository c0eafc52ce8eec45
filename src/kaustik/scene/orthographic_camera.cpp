#include "kaustik/scene/camera_kinds.h"
#include "kaustik/scene/camera_view.h"

namespace kaustik {
namespace {

/// A camera that sees everything along one direction, through a rectangle around its place: to the
/// picture's width 2 times the scale of to_world.
class Orthographic final : public Camera {
 public:
  explicit Orthographic(const CameraInputs& inputs)
      : frame_(inputs.arguments, false),
        window_(inputs.film),
        clip_(inputs.arguments),
        half_(frame_.scale.x, frame_.scale.y / float(window_.aspect())),
        pixel_area_(4 * half_.x * half_.y / window_.pixels()) {
    traits_.position = frame_.position;
    traits_.view = "sees along parallel lines";
    traits_.pixel_width = 0.5f * std::sqrt(pixel_area_);
    traits_.parallel_distance = parallel_distance_of(half_.x);
  }

  CameraRay sample_ray(const Vec2f& raster, const LensNumbers&) const override {
    const Vec2f plane = window_.plane_of(raster);
    return clip_.clip(
        {frame_.position + frame_.left * (plane.x * half_.x) + frame_.up * (plane.y * half_.y),
         frame_.forward, infinity});
  }

  CameraConnection connect(const Vec3f& point, const LensNumbers&) const override {
    CameraConnection c;
    const Vec3f local = frame_.to_local(point - frame_.position);
    c.lens = point - frame_.forward * local.z;
    c.direction = -frame_.forward;
    c.distance = local.z;
    if (!(local.z > 0)) return c;
    c.raster = window_.raster_of({local.x / half_.x, local.y / half_.y});
    // A pixel sees so much area, however far away: the square of the distance cancels.
    if (window_.holds(c.raster)) c.importance = sqr(local.z) / pixel_area_;
    clip_.clip(c);
    return c;
  }

 private:
  CameraFrame frame_;
  PictureWindow window_;
  ClipRange clip_;
  Vec2f half_;        ///< of the picture's width and height, m
  float pixel_area_;  ///< m²
};

const TypeInfo& orthographic_info() {
  static const TypeInfo info = placed_camera_info(
      "orthographic",
      "Camera that sees along parallel lines. The scale of to_world is half the picture's width.",
      {ignored_parameter("focus_distance", ParameterKind::number)});
  return info;
}

}  // namespace

CameraType orthographic_camera_type() {
  return {orthographic_info(), [](const CameraInputs& inputs) -> std::unique_ptr<Camera> {
            return std::make_unique<Orthographic>(inputs);
          }};
}

}  // namespace kaustik
