#include "kaustik/scene/camera_kinds.h"
#include "kaustik/scene/camera_view.h"

namespace kaustik {
namespace {

/// A pinhole.
class Perspective final : public Camera {
 public:
  explicit Perspective(const CameraInputs& inputs) : view_(inputs) { traits_ = view_.traits(); }

  CameraRay sample_ray(const Vec2f& raster, const LensNumbers&) const override {
    const Vec2f slopes = view_.slopes_of(raster);
    const CameraFrame& frame = view_.frame;
    const Vec3f d = frame.forward + frame.left * slopes.x + frame.up * slopes.y;
    return view_.ray(frame.position, normalize(d));
  }
  CameraConnection connect(const Vec3f& point, const LensNumbers&) const override {
    return view_.connect(point, view_.frame.position, {0, 0});
  }

 private:
  StraightView view_;
};

const TypeInfo& perspective_info() {
  static const TypeInfo info = placed_camera_info(
      "perspective",
      "Pinhole camera that looks along +z of its own space. +x points to the left of the picture.",
      {ignored_parameter("focus_distance", ParameterKind::number)}, straight_view_parameters());
  return info;
}

}  // namespace

CameraType perspective_camera_type() {
  return {perspective_info(), [](const CameraInputs& inputs) -> std::unique_ptr<Camera> {
            return std::make_unique<Perspective>(inputs);
          }};
}

}  // namespace kaustik
