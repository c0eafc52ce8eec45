#include <algorithm>
#include <optional>

#include "kaustik/base/warp.h"
#include "kaustik/scene/camera_kinds.h"
#include "kaustik/scene/camera_view.h"

namespace kaustik {
namespace {

/// Measures what leaves the scene in one direction, from outside of all shapes: the mean radiance
/// along parallel rays to a point, to a shape (uniform by its area), or to the disk that the
/// sphere around the scene shows.
class Distant final : public Camera {
 public:
  explicit Distant(const CameraInputs& inputs);

  CameraRay sample_ray(const Vec2f&, const LensNumbers& numbers) const override {
    const std::optional<Vec3f> target = target_at(numbers.place);
    if (!target) return CameraRay::none();
    const float before = dot(*target - middle_, direction_) + distance_;
    return {{*target - direction_ * before, direction_, infinity}, 0};
  }
  CameraConnection connect(const Vec3f&, const LensNumbers&) const override {
    return no_connection(traits_.position);
  }

 private:
  /// None: the shape gave none.
  std::optional<Vec3f> target_at(const Vec2f& u) const {
    if (point_) return point_;
    if (!shape_) {
      const Vec2f disk = square_to_disk(u) * radius_;
      return middle_ + across_.x * disk.x + across_.y * disk.y;
    }
    const ShapeSample sample = shape_->sample_area(u);
    if (!(sample.pdf_area > 0)) return std::nullopt;
    return sample.point.position;
  }

  Vec3f direction_;
  Frame across_;           ///< its z is the direction
  Vec3f middle_{0, 0, 0};  ///< of the sphere around the scene
  float radius_ = 1;       ///< of that sphere, m
  float distance_ = 1;     ///< from its middle to the plane where rays begin, m
  std::optional<Vec3f> point_;
  std::shared_ptr<const Shape> shape_;
};

Distant::Distant(const CameraInputs& inputs)
    : direction_(meter_direction(inputs.arguments)), across_(direction_), shape_(inputs.shape) {
  if (inputs.arguments.given("target")) point_ = Vec3f(inputs.arguments.point("target"));
  if (point_ && shape_)
    throw Error(ErrorKind::input, "the camera has two targets: a point and a shape", "keep one",
                inputs.arguments.place_of("target"));
  if (!inputs.scene_bounds.isEmpty()) {
    middle_ = center(inputs.scene_bounds);
    radius_ = std::max(1e-6f, bounding_radius(inputs.scene_bounds));
  }
  distance_ = 1.01f * radius_;
  traits_.position = middle_ - direction_ * distance_;
  traits_.view = "measures what leaves the scene in one direction";
  // No pixel: a beam so narrow that what is filtered by it, or merges within, hardly changes.
  constexpr float share = 1e-3f;
  traits_.pixel_width = share * radius_;
  traits_.parallel_distance = parallel_distance_of(radius_);
  traits_.has_lens = !point_;
  traits_.can_connect = false;
}

const TypeInfo& distant_info() {
  static const TypeInfo info = camera_info(
      "distant",
      "Measures the mean radiance that leaves the scene in one direction, over a nested shape, a "
      "point, or the cross-section of the sphere around the scene. Every pixel shows the same "
      "value, so one is enough.",
      {to_world_parameter("Transform from the camera's space to the world. It looks along +z."),
       optional(point_parameter("direction", {0, 0, 1},
                                "Direction in which it looks, instead of `to_world`."))
           .instead_of("to_world"),
       optional(point_parameter("target", {0, 0, 0}, "Point at which it looks.").in("m"))});
  return info;
}

}  // namespace

CameraType distant_camera_type() {
  return {distant_info(),
          [](const CameraInputs& inputs) -> std::unique_ptr<Camera> {
            return std::make_unique<Distant>(inputs);
          },
          false, true};
}

}  // namespace kaustik
