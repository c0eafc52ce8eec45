// Cameras that look around an upright axis: spherical and cylinder.
#include <cmath>
#include <numbers>

#include "kaustik/scene/camera_kinds.h"
#include "kaustik/scene/camera_view.h"

namespace kaustik {
namespace {

/// What both have in common: the angle around the axis grows evenly along the picture's width, from
/// the left to the right; the middle looks along +z.
class Panorama : public Camera {
 public:
  CameraConnection connect(const Vec3f& point, const LensNumbers&) const final {
    CameraConnection c;
    c.lens = frame_.position;
    const Vec3f to_camera = c.lens - point;
    c.distance = length(to_camera);
    if (!(c.distance > 0)) return c;
    c.direction = to_camera * (1 / c.distance);
    // The one within the picture, if there is one.
    bool is_seen = false;
    visit_rasters(-c.direction, [&](const Vec2f& raster) {
      if (!is_seen || window_.shows(raster)) c.raster = raster;
      is_seen = true;
    });
    if (!is_seen) return c;
    c.importance = importance(frame_.to_local(-c.direction));
    clip_.clip(c);
    return c;
  }
  void visit_repetitions(const CameraConnection& connection,
                         const std::function<void(const CameraConnection&)>& visit) const override {
    visit_rasters(-connection.direction, [&](const Vec2f& raster) {
      if (raster == connection.raster) return;
      CameraConnection other = connection;
      other.raster = raster;
      visit(other);
    });
  }

 protected:
  /// `half_turn`: half of the angle that the picture's width covers, radians.
  Panorama(const CameraInputs& inputs, float half_turn, bool over_poles)
      : frame_(inputs.arguments, true),
        window_(inputs.film),
        clip_(inputs.arguments),
        half_turn_(half_turn),
        repetitions_(window_, window_.full_size().x * (pi / half_turn), over_poles,
                     inputs.film.filter.radius()) {
    traits_.position = frame_.position;
    traits_.repeats = true;
  }

  /// Of a unit vector in the camera's space, on the plane of PictureWindow.
  virtual Vec2f plane_of(const Vec3f& local) const = 0;
  /// Pixels per solid angle there.
  virtual float importance(const Vec3f& local) const = 0;

  CameraRay ray(const Vec3f& local) const {
    return clip_.clip({frame_.position, normalize(frame_.to_world(local)), infinity});
  }
  const PictureWindow& window() const { return window_; }
  float half_turn() const { return half_turn_; }
  /// Around the axis, positive to the left.
  static float azimuth(const Vec3f& local) { return std::atan2(local.x, local.z); }

 private:
  /// Those where a direction in the world is seen.
  template <typename Visit>
  void visit_rasters(const Vec3f& direction, const Visit& visit) const {
    repetitions_.visit(window_.raster_of(plane_of(frame_.to_local(direction))), visit);
  }

  CameraFrame frame_;
  PictureWindow window_;
  ClipRange clip_;
  float half_turn_;
  RasterRepetitions repetitions_;
};

/// All directions by their longitude and latitude, as in Mitsuba 0.6.
class Spherical final : public Panorama {
 public:
  explicit Spherical(const CameraInputs& inputs) : Panorama(inputs, pi, true) {
    traits_.view = "the whole sphere";
    traits_.pixel_spread = 0.5f / std::sqrt(importance({0, 0, 1}));
  }

  CameraRay sample_ray(const Vec2f& raster, const LensNumbers&) const override {
    const Vec2f plane = window().plane_of(raster);
    const float longitude = pi * plane.x, latitude = 0.5f * pi * plane.y;
    const float across = std::cos(latitude);
    return ray({std::sin(longitude) * across, std::sin(latitude), std::cos(longitude) * across});
  }

 protected:
  Vec2f plane_of(const Vec3f& local) const override {
    const float latitude = std::atan2(local.y, std::hypot(local.x, local.z));
    return {azimuth(local) * inv_pi, 2 * inv_pi * latitude};
  }
  float importance(const Vec3f& local) const override {
    constexpr float least = 1e-6f;  // at the poles, where a row of pixels is one point
    return window().pixels() * (0.5f * inv_pi * inv_pi) /
           std::max(least, std::hypot(local.x, local.z));
  }
};

/// A cylinder around an upright axis, unrolled: upright lines stay straight.
class CylinderCamera final : public Panorama {
 public:
  explicit CylinderCamera(const CameraInputs& inputs)
      : Panorama(inputs, float(0.5 * inputs.arguments.number("fov") * std::numbers::pi / 180),
                 false),
        half_height_(half_turn() / float(window().aspect())) {
    traits_.view = "a cylinder around it";
    traits_.pixel_spread = 0.5f / std::sqrt(importance({0, 0, 1}));
  }

  CameraRay sample_ray(const Vec2f& raster, const LensNumbers&) const override {
    const Vec2f plane = window().plane_of(raster);
    const float turned = half_turn() * plane.x;
    return ray({std::sin(turned), plane.y * half_height_, std::cos(turned)});
  }

 protected:
  Vec2f plane_of(const Vec3f& local) const override {
    return {azimuth(local) / half_turn(), local.y / (std::hypot(local.x, local.z) * half_height_)};
  }
  float importance(const Vec3f& local) const override {
    const float cosine = std::hypot(local.x, local.z);
    const float pixel = 2 * half_turn() / window().full_size().x;  // wide and high, at distance 1
    return 1 / (sqr(pixel) * cosine * cosine * cosine);
  }

 private:
  float half_height_;  ///< of the picture, where the cylinder's radius is 1
};

const TypeInfo& spherical_camera_info() {
  static const TypeInfo info =
      placed_camera_info("spherical",
                         "Camera that shows all directions by longitude and latitude, best in a "
                         "picture twice as wide as high. The middle looks along +z; up is +y.",
                         {});
  return info;
}

const TypeInfo& cylinder_camera_info() {
  static const TypeInfo info = placed_camera_info(
      "cylinder",
      "Camera that projects the surroundings on an upright cylinder and unrolls it. The middle "
      "looks along +z; up is +y; pixels on the horizon are square.",
      {number_parameter("fov", 360, "Field of view along the picture's width.")
           .range(1e-2, 360)
           .in("degrees")});
  return info;
}

}  // namespace

CameraType spherical_camera_type() {
  return {spherical_camera_info(), [](const CameraInputs& inputs) -> std::unique_ptr<Camera> {
            return std::make_unique<Spherical>(inputs);
          }};
}

CameraType cylinder_camera_type() {
  return {cylinder_camera_info(), [](const CameraInputs& inputs) -> std::unique_ptr<Camera> {
            return std::make_unique<CylinderCamera>(inputs);
          }};
}

}  // namespace kaustik
