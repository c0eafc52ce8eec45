#include <cmath>
#include <numbers>

#include "kaustik/scene/camera_kinds.h"
#include "kaustik/scene/camera_view.h"

namespace kaustik {
namespace {

/// How far from the picture's middle a direction is seen, by its angle θ with the direction of
/// view: ρ(θ), 1 at the rim. Angles in radians (Kumler and Bauer 2000).
class FisheyeMapping {
 public:
  enum class Kind { equidistant, equisolid, stereographic, hemispherical };
  FisheyeMapping(Kind kind, float half_fov) : kind_(kind), half_fov_(half_fov) {
    at_rim_ = curve(half_fov);
  }

  float half_fov() const { return half_fov_; }
  float radius(float angle) const { return curve(angle) / at_rim_; }
  float angle(float radius) const {
    const float c = radius * at_rim_;
    switch (kind_) {
      case Kind::equidistant:
        return c;
      case Kind::equisolid:
        return 2 * std::asin(std::min(c, 1.0f));
      case Kind::stereographic:
        return 2 * std::atan(c);
      case Kind::hemispherical:
        return std::asin(std::min(c, 1.0f));
    }
    return 0;
  }
  /// ρ ρ' / sin θ: area of the picture, where the circle's radius is 1, per solid angle.
  float area_per_solid_angle(float angle) const {
    const float scale = 1 / sqr(at_rim_);
    switch (kind_) {
      case Kind::equidistant: {
        const float sine = std::sin(angle);
        return angle > 0 && sine > 0 ? scale * angle / sine : scale;
      }
      case Kind::equisolid:
        return scale * 0.25f;
      case Kind::stereographic: {
        const float cosine = std::cos(0.5f * angle);
        return scale * 0.25f / sqr(sqr(cosine));
      }
      case Kind::hemispherical:
        return scale * std::cos(angle);
    }
    return 0;
  }

 private:
  /// ρ but for its factor.
  float curve(float angle) const {
    switch (kind_) {
      case Kind::equidistant:
        return angle;
      case Kind::equisolid:
        return std::sin(0.5f * angle);
      case Kind::stereographic:
        return std::tan(0.5f * angle);
      case Kind::hemispherical:
        return std::sin(angle);
    }
    return 0;
  }

  Kind kind_;
  float half_fov_, at_rim_ = 1;
};

FisheyeMapping mapping_of(const Arguments& arguments) {
  using Kind = FisheyeMapping::Kind;
  const std::string& name = arguments.text("mapping");
  const Kind kind = name == "equisolid"       ? Kind::equisolid
                    : name == "stereographic" ? Kind::stereographic
                    : name == "hemispherical" ? Kind::hemispherical
                                              : Kind::equidistant;
  const double fov = arguments.number("fov");
  const double widest = kind == Kind::hemispherical ? 180 : kind == Kind::stereographic ? 359 : 360;
  if (fov > widest)
    throw Error(ErrorKind::input,
                "the mapping '" + name + "' cannot show a field of view of so many degrees",
                "give a smaller 'fov', or the mapping equidistant", arguments.place_of("fov"));
  return {kind, float(0.5 * fov * std::numbers::pi / 180)};
}

/// A camera that shows a whole cone or more of directions in the circle that fits the picture.
class Fisheye final : public Camera {
 public:
  explicit Fisheye(const CameraInputs& inputs)
      : frame_(inputs.arguments, true),
        window_(inputs.film),
        clip_(inputs.arguments),
        mapping_(mapping_of(inputs.arguments)),
        pixels_(0.5f * std::min(window_.full_size().x, window_.full_size().y)),
        to_circle_(window_.full_size() * (0.5f / pixels_)) {
    traits_.position = frame_.position;
    traits_.view =
        "fisheye of " + std::to_string(int(std::lround(360 * inv_pi * mapping_.half_fov()))) + "°";
    traits_.pixel_spread = 0.5f / (pixels_ * std::sqrt(mapping_.area_per_solid_angle(0)));
  }

  CameraRay sample_ray(const Vec2f& raster, const LensNumbers&) const override {
    const Vec2f at = window_.plane_of(raster) * to_circle_;
    const float radius = std::hypot(at.x, at.y);
    if (!(radius < 1)) return CameraRay::none();
    const float angle = mapping_.angle(radius);
    const float across = radius > 0 ? std::sin(angle) / radius : 0.0f;
    const Vec3f local(at.x * across, at.y * across, std::cos(angle));
    return clip_.clip({frame_.position, normalize(frame_.to_world(local)), infinity});
  }

  CameraConnection connect(const Vec3f& point, const LensNumbers&) const override {
    CameraConnection c;
    c.lens = frame_.position;
    const Vec3f to_camera = c.lens - point;
    c.distance = length(to_camera);
    if (!(c.distance > 0)) return c;
    c.direction = to_camera * (1 / c.distance);
    const Vec3f local = frame_.to_local(-c.direction);
    const float across = std::hypot(local.x, local.y);
    const float angle = std::atan2(across, local.z);
    if (!(angle < mapping_.half_fov())) return c;
    const float stretch = across > 0 ? mapping_.radius(angle) / across : 0.0f;
    c.raster = window_.raster_of(Vec2f(local.x, local.y) * stretch / to_circle_);
    if (window_.holds(c.raster)) c.importance = sqr(pixels_) * mapping_.area_per_solid_angle(angle);
    clip_.clip(c);
    return c;
  }

 private:
  CameraFrame frame_;
  PictureWindow window_;
  ClipRange clip_;
  FisheyeMapping mapping_;
  float pixels_;     ///< radius of the circle
  Vec2f to_circle_;  ///< half of the picture's sizes in units of that radius
};

const TypeInfo& fisheye_info() {
  static const TypeInfo info = placed_camera_info(
      "fisheye",
      "Camera that shows all directions within an angle of its view direction, in a circle as wide "
      "as the picture's shorter side. Black outside.",
      {choice_parameter(
           "mapping", "equidistant", {"equidistant", "equisolid", "stereographic", "hemispherical"},
           "Distance from the circle's centre: proportional to the angle, with equal areas for "
           "equal solid angles, with shapes kept, or like a hemisphere seen from afar."),
       number_parameter("fov", 180, "Field of view, from rim to rim.")
           .range(1e-2, 360)
           .in("degrees")});
  return info;
}

}  // namespace

CameraType fisheye_camera_type() {
  return {fisheye_info(), [](const CameraInputs& inputs) -> std::unique_ptr<Camera> {
            return std::make_unique<Fisheye>(inputs);
          }};
}

}  // namespace kaustik
