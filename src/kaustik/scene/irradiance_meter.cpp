#include <algorithm>
#include <cmath>

#include "kaustik/base/warp.h"
#include "kaustik/scene/camera_kinds.h"
#include "kaustik/scene/camera_view.h"

namespace kaustik {
namespace {

/// Measures what falls on a shape, on the side of its normals: the mean irradiance over its area.
/// Rays meet the shape at points that are uniform by area, straight from above, and the film asks
/// for irradiance, so that lamps of all kinds count.
/// A boundary that light does not notice (bsdf null) can't be met. There rays begin at such points
/// and go into the hemisphere around the normal with density cos θ / π; then the mean of π L is
/// E = ∫ L cos θ dω. Lamps that no ray meets are missed.
class IrradianceMeter final : public Camera {
 public:
  explicit IrradianceMeter(const CameraInputs& inputs)
      : shape_(inputs.shape), is_passed_(inputs.shape_is_passed) {
    traits_.position = center(shape_->bounds());
    traits_.view = "measures the irradiance of a shape";
    traits_.meter_unit = "lx";
    traits_.has_lens = true;
    traits_.can_connect = false;
    if (is_passed_) {
      // No pixel: a cone so narrow that what is filtered by it, or merges within, hardly changes.
      constexpr float half_angle = 0.005f;
      traits_.pixel_spread = half_angle;
      traits_.has_ways = true;
      traits_.weight = pi;
      traits_.measures_irradiance = true;
    } else {
      // As if it were seen in a picture of so many pixels on a side.
      constexpr float pixels = 32;
      const float side = std::sqrt(shape_->area());
      traits_.pixel_width = 0.5f * side / pixels;
      nearest_ *= side;
      traits_.parallel_distance = parallel_distance_of(0.5f * side);
    }
  }

  CameraRay sample_ray(const Vec2f&, const LensNumbers& numbers) const override {
    const ShapeSample sample = shape_->sample_area(numbers.place);
    if (!(sample.pdf_area > 0)) return CameraRay::none();
    const Vec3f& normal = sample.point.ng;
    if (is_passed_) {
      const Vec3f way = Frame(normal).to_world(square_to_cosine_hemisphere(numbers.way));
      return {spawn_ray(sample.point, normalize(way)), 0};
    }
    return {{offset_by(sample.point, normal, std::max(nearest_, errors_ * sample.point.error)),
             -normal, infinity},
            0};
  }
  CameraConnection connect(const Vec3f&, const LensNumbers&) const override {
    return no_connection(traits_.position);
  }

 private:
  std::shared_ptr<const Shape> shape_;
  bool is_passed_;  ///< by light, as if it were not there
  /// Rays begin as near as rounding allows, so that nothing stands between: so many bounds of the
  /// error of a point away, and a share of the shape's size where there is no error.
  static constexpr float errors_ = 32;
  float nearest_ = 1e-6f;  ///< m
};

const TypeInfo& irradiance_meter_info() {
  static const TypeInfo info =
      camera_info("irradiancemeter",
                  "Measures the mean irradiance, W/m², of the shape that holds it, on the side of "
                  "the normals. Every pixel shows the same value, so one is enough.",
                  {});
  return info;
}

}  // namespace

CameraType irradiance_meter_type() {
  return {irradiance_meter_info(),
          [](const CameraInputs& inputs) -> std::unique_ptr<Camera> {
            return std::make_unique<IrradianceMeter>(inputs);
          },
          true};
}

}  // namespace kaustik
