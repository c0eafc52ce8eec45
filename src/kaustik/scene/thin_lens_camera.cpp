#include "kaustik/scene/aperture.h"
#include "kaustik/scene/camera_kinds.h"
#include "kaustik/scene/camera_view.h"

namespace kaustik {
namespace {

/// A camera with a thin lens, which is sharp in one distance: all rays of a point of the picture
/// meet there.
class ThinLens final : public Camera {
 public:
  explicit ThinLens(const CameraInputs& inputs);

  CameraRay sample_ray(const Vec2f& raster, const LensNumbers& numbers) const override;
  CameraConnection connect(const Vec3f& point, const LensNumbers& numbers) const override;

 private:
  Vec3f in_world(const Vec2f& on_lens) const {
    return view_.frame.position + view_.frame.left * on_lens.x + view_.frame.up * on_lens.y;
  }

  StraightView view_;
  Aperture aperture_;
  float focus_distance_;  ///< m
};

ThinLens::ThinLens(const CameraInputs& inputs)
    : view_(inputs),
      aperture_(inputs.arguments),
      focus_distance_(float(inputs.arguments.number("focus_distance"))) {
  traits_ = view_.traits();
  traits_.has_lens = aperture_.radius() > 0;
}

CameraRay ThinLens::sample_ray(const Vec2f& raster, const LensNumbers& numbers) const {
  const CameraFrame& frame = view_.frame;
  const Vec2f slopes = view_.slopes_of(raster), lens = aperture_.at(numbers.place);
  const float x = slopes.x * focus_distance_ - lens.x, y = slopes.y * focus_distance_ - lens.y;
  const Vec3f d = frame.forward * focus_distance_ + frame.left * x + frame.up * y;
  return view_.ray(in_world(lens), normalize(d));
}

CameraConnection ThinLens::connect(const Vec3f& point, const LensNumbers& numbers) const {
  const Vec2f lens = aperture_.at(numbers.place);
  // Where the ray meets the plane that is sharp, over its distance.
  return view_.connect(point, in_world(lens), lens / focus_distance_);
}

const TypeInfo& thin_lens_info() {
  static const TypeInfo info = placed_camera_info(
      "thinlens",
      "Camera with a thin lens. It blurs everything nearer or farther than focus_distance.",
      lens_parameters(required(number_parameter("aperture_radius", 0.01, "Radius of the lens."))),
      straight_view_parameters());
  return info;
}

}  // namespace

CameraType thin_lens_camera_type() {
  return {thin_lens_info(), [](const CameraInputs& inputs) -> std::unique_ptr<Camera> {
            return std::make_unique<ThinLens>(inputs);
          }};
}

}  // namespace kaustik
