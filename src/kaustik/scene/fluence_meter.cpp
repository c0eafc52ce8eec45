#include "kaustik/base/warp.h"
#include "kaustik/scene/camera_kinds.h"
#include "kaustik/scene/camera_view.h"

namespace kaustik {
namespace {

/// Looks from a point into all directions alike: the mean of what its rays meet is the mean
/// radiance at the point, (1/4π) ∫ L dω. Lamps that no ray meets are missed.
class FluenceMeter final : public Camera {
 public:
  explicit FluenceMeter(const CameraInputs& inputs) {
    traits_.position = inputs.arguments.transform("to_world").point({0, 0, 0});
    traits_.view = "measures the mean radiance at a point";
    traits_.meter_unit = "cd/m²";
    traits_.has_ways = true;
    traits_.can_connect = false;
    // No pixel: a cone so narrow that what is filtered by it, or merges within, hardly changes.
    constexpr float half_angle = 0.005f;
    traits_.pixel_spread = half_angle;
  }

  CameraRay sample_ray(const Vec2f&, const LensNumbers& numbers) const override {
    return {{traits_.position, normalize(square_to_sphere(numbers.way)), infinity}, 0};
  }
  CameraConnection connect(const Vec3f&, const LensNumbers&) const override {
    return no_connection(traits_.position);
  }
};

const TypeInfo& fluence_meter_info() {
  static const TypeInfo info = camera_info(
      "fluencemeter",
      "Measures the mean radiance at a point over all directions, without the direct light of "
      "point, spot and directional lamps. Every pixel shows the same value, so one is enough.",
      {to_world_parameter(
          "Transform from the meter's space to the world. The point is at the origin.")});
  return info;
}

}  // namespace

CameraType fluence_meter_type() {
  return {fluence_meter_info(), [](const CameraInputs& inputs) -> std::unique_ptr<Camera> {
            return std::make_unique<FluenceMeter>(inputs);
          }};
}

}  // namespace kaustik
