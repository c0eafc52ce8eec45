#include "kaustik/base/warp.h"
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
  /// In units of the lens's radius: over the disk, or over a polygon that it holds.
  Vec2f on_aperture(const Vec2f& u) const;
  Vec2f on_lens(const LensNumbers& numbers) const { return on_aperture(numbers.place) * radius_; }
  Vec3f in_world(const Vec2f& on_lens) const {
    return view_.frame.position + view_.frame.left * on_lens.x + view_.frame.up * on_lens.y;
  }

  StraightView view_;
  float radius_ = 0, focus_distance_ = 1;  ///< m
  int blades_ = 0;                         ///< 0: a round aperture
  float blade_angle_ = 0;                  ///< of the polygon's first corner, radians
};

ThinLens::ThinLens(const CameraInputs& inputs)
    : view_(inputs),
      radius_(float(inputs.arguments.number("aperture_radius"))),
      focus_distance_(float(inputs.arguments.number("focus_distance"))),
      blades_(int(inputs.arguments.integer("blades"))),
      blade_angle_(float(inputs.arguments.number("blade_rotation")) * pi / 180) {
  if (blades_ == 1 || blades_ == 2)
    throw Error(ErrorKind::input, "an aperture of so few blades has no area",
                "give 3 or more 'blades', or 0 for a round one",
                inputs.arguments.place_of("blades"));
  traits_ = view_.traits();
  traits_.has_lens = radius_ > 0;
}

Vec2f ThinLens::on_aperture(const Vec2f& u) const {
  if (blades_ == 0) return square_to_disk(u);
  // One of the triangles between the middle and a side, and a point of it.
  const float at = u.x * float(blades_), side = std::min(std::floor(at), float(blades_ - 1));
  const float rest = std::clamp(at - side, 0.0f, 1.0f), root = std::sqrt(u.y);
  const auto corner = [&](float i) {
    const float angle = blade_angle_ + 2 * pi * i / float(blades_);
    return Vec2f(std::cos(angle), std::sin(angle));
  };
  return corner(side) * (root * (1 - rest)) + corner(side + 1) * (root * rest);
}

CameraRay ThinLens::sample_ray(const Vec2f& raster, const LensNumbers& numbers) const {
  const CameraFrame& frame = view_.frame;
  const Vec2f slopes = view_.slopes_of(raster), lens = on_lens(numbers);
  const float x = slopes.x * focus_distance_ - lens.x, y = slopes.y * focus_distance_ - lens.y;
  const Vec3f d = frame.forward * focus_distance_ + frame.left * x + frame.up * y;
  return view_.ray(in_world(lens), normalize(d));
}

CameraConnection ThinLens::connect(const Vec3f& point, const LensNumbers& numbers) const {
  const Vec2f lens = on_lens(numbers);
  // Where the ray meets the plane that is sharp, over its distance.
  return view_.connect(point, in_world(lens), lens / focus_distance_);
}

const TypeInfo& thin_lens_info() {
  static const TypeInfo info = [] {
    std::vector<Parameter> rows = {
        to_world_parameter("From the camera's space to the world."),
        required(
            number_parameter("aperture_radius", 0.01, "Radius of the lens.").range(0, 1e6).in("m")),
        number_parameter("focus_distance", 1e4, "How far away the picture is sharp.")
            .range(1e-6, 1e12)
            .in("m"),
        integer_parameter("blades", 0, "Sides of the aperture; 0: round.").range(0, 100),
        number_parameter("blade_rotation", 0, "Turns an aperture with blades.")
            .range(-360, 360)
            .in("degrees")};
    for (Parameter& row : straight_view_parameters()) rows.push_back(std::move(row));
    return camera_info(
        "thinlens",
        "Camera with a thin lens: what is nearer or farther than focus_distance is blurred.",
        std::move(rows));
  }();
  return info;
}

}  // namespace

CameraType thin_lens_camera_type() {
  return {thin_lens_info(), [](const CameraInputs& inputs) -> std::unique_ptr<Camera> {
            return std::make_unique<ThinLens>(inputs);
          }};
}

}  // namespace kaustik
