#include "kaustik/scene/aperture.h"
#include "kaustik/scene/camera_kinds.h"
#include "kaustik/scene/camera_view.h"

namespace kaustik {
namespace {

/// An orthographic camera with a lens: the cones that its pixels see through are all alike, and
/// meet in points at one distance. Through each point of the aperture it sees along parallel lines
/// that lean.
class Telecentric final : public Camera {
 public:
  explicit Telecentric(const CameraInputs& inputs)
      : frame_(inputs.arguments, false),
        window_(inputs.film),
        clip_(inputs.arguments),
        aperture_(inputs.arguments),
        focus_distance_(float(inputs.arguments.number("focus_distance"))),
        half_(frame_.scale.x, frame_.scale.y / float(window_.aspect())),
        pixel_area_(4 * half_.x * half_.y / window_.pixels()) {
    traits_.position = frame_.position;
    traits_.view = "sees along parallel lines through a lens";
    traits_.pixel_width = 0.5f * std::sqrt(pixel_area_);
    traits_.parallel_distance = parallel_distance_of(half_.x);
    traits_.has_lens = aperture_.radius() > 0;
  }

  CameraRay sample_ray(const Vec2f& raster, const LensNumbers& numbers) const override {
    const Vec2f lens = aperture_.at(numbers.place), plane = window_.plane_of(raster);
    const Vec3f start(plane.x * half_.x + lens.x, plane.y * half_.y + lens.y, 0);
    const Vec3f way = lean(lens);
    return clip_.clip({frame_.position + frame_.to_world(start), frame_.to_world(way), infinity},
                      way.z);
  }

  CameraConnection connect(const Vec3f& point, const LensNumbers& numbers) const override {
    const Vec2f lens = aperture_.at(numbers.place);
    const Vec3f way = lean(lens), local = frame_.to_local(point - frame_.position);
    CameraConnection c;
    c.direction = frame_.to_world(-way);
    c.distance = local.z / way.z;
    c.lens = point + c.direction * c.distance;
    if (!(local.z > 0)) return c;
    // Where the line meets the plane that is sharp.
    const float left = 1 - local.z / focus_distance_;
    c.raster = window_.raster_of(
        {(local.x - lens.x * left) / half_.x, (local.y - lens.y * left) / half_.y});
    // As much area as orthographic(), which lies across the lines that lean with their cosine.
    if (window_.holds(c.raster)) c.importance = sqr(c.distance) / (pixel_area_ * way.z);
    clip_.clip(c, way.z);
    return c;
  }

 private:
  /// From a point of the aperture toward the middle of the sharp plane, unit; z is positive.
  Vec3f lean(const Vec2f& lens) const {
    return normalize(Vec3f(-lens.x, -lens.y, focus_distance_));
  }

  CameraFrame frame_;
  PictureWindow window_;
  ClipRange clip_;
  Aperture aperture_;
  float focus_distance_;  ///< m
  Vec2f half_;            ///< of the picture's width and height, m
  float pixel_area_;      ///< of a pixel across the direction of view, m²
};

const TypeInfo& telecentric_info() {
  static const TypeInfo info = placed_camera_info(
      "telecentric",
      "Orthographic camera with a lens. It blurs everything nearer or farther than focus_distance.",
      lens_parameters(number_parameter("aperture_radius", 0, "Radius of the lens in the world.")));
  return info;
}

}  // namespace

CameraType telecentric_camera_type() {
  return {telecentric_info(), [](const CameraInputs& inputs) -> std::unique_ptr<Camera> {
            return std::make_unique<Telecentric>(inputs);
          }};
}

}  // namespace kaustik
