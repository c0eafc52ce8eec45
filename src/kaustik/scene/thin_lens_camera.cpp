#include "kaustik/base/warp.h"
#include "kaustik/scene/camera_kinds.h"
#include "kaustik/scene/camera_view.h"

namespace kaustik {
namespace {

/// A camera with a thin lens, which is sharp in one distance: all rays of a point of the picture
/// meet there.
class ThinLens final : public Camera {
 public:
  ThinLens(const Arguments& arguments, const FilmSettings& film);

  Ray sample_ray(const Vec2f& raster, const Vec2f& u_lens) const override;
  CameraConnection connect(const Vec3f& point, const Vec2f& u_lens) const override;

 private:
  /// In units of the lens's radius: over the disk, or over a polygon that it holds.
  Vec2f on_aperture(const Vec2f& u) const;
  Vec2f on_lens(const Vec2f& u) const { return on_aperture(u) * radius_; }
  Vec3f in_world(const Vec2f& on_lens) const {
    return frame_.position + frame_.left * on_lens.x + frame_.up * on_lens.y;
  }

  CameraFrame frame_;
  PictureWindow window_;
  Vec2f tan_;                              ///< of half the fields of view
  float pixel_area_ = 1;                   ///< of one pixel on the plane at distance 1
  float radius_ = 0, focus_distance_ = 1;  ///< m
  int blades_ = 0;                         ///< 0: a round aperture
  float blade_angle_ = 0;                  ///< of the polygon's first corner, radians
};

ThinLens::ThinLens(const Arguments& arguments, const FilmSettings& film)
    : frame_(arguments, true),
      window_(film, principal_offset_of(arguments)),
      tan_(tan_half_fov(arguments, window_.aspect())),
      radius_(float(arguments.number("aperture_radius"))),
      focus_distance_(float(arguments.number("focus_distance"))),
      blades_(int(arguments.integer("blades"))),
      blade_angle_(float(arguments.number("blade_rotation")) * pi / 180) {
  if (blades_ == 1 || blades_ == 2)
    throw Error(ErrorKind::input, "an aperture of so few blades has no area",
                "give 3 or more 'blades', or 0 for a round one", arguments.place_of("blades"));
  traits_.position = frame_.position;
  traits_.horizontal_fov = 360 * inv_pi * std::atan(tan_.x);
  traits_.vertical_fov = 360 * inv_pi * std::atan(tan_.y);
  traits_.has_lens = radius_ > 0;
  pixel_area_ = 4 * tan_.x * tan_.y / window_.pixels();
  traits_.pixel_spread = 0.5f * std::sqrt(pixel_area_);
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

Ray ThinLens::sample_ray(const Vec2f& raster, const Vec2f& u_lens) const {
  const Vec2f plane = window_.plane_of(raster), lens = on_lens(u_lens);
  const float x = plane.x * tan_.x * focus_distance_ - lens.x,
              y = plane.y * tan_.y * focus_distance_ - lens.y;
  const Vec3f d = frame_.forward * focus_distance_ + frame_.left * x + frame_.up * y;
  return {in_world(lens), normalize(d), infinity};
}

CameraConnection ThinLens::connect(const Vec3f& point, const Vec2f& u_lens) const {
  CameraConnection c;
  const Vec2f lens = on_lens(u_lens);
  c.lens = in_world(lens);
  const Vec3f to_camera = c.lens - point;
  c.distance = length(to_camera);
  if (!(c.distance > 0)) return c;
  c.direction = to_camera * (1 / c.distance);
  const Vec3f local = frame_.to_local(-c.direction);
  if (!(local.z > 0)) return c;
  // Where the ray meets the plane that is sharp, over its distance.
  const float x = local.x / local.z + lens.x / focus_distance_,
              y = local.y / local.z + lens.y / focus_distance_;
  c.raster = window_.raster_of({x / tan_.x, y / tan_.y});
  // Through each point of the lens the plane is seen as through a pinhole there.
  if (window_.holds(c.raster)) c.importance = 1 / (pixel_area_ * local.z * local.z * local.z);
  return c;
}

TypeInfo make_thin_lens_info() {
  TypeInfo info{
      "sensor",
      "thinlens",
      "Camera with a thin lens: what is nearer or farther than focus_distance is blurred.",
      {to_world_parameter("From the camera's space to the world."),
       required(
           number_parameter("aperture_radius", 0.01, "Radius of the lens.").range(0, 1e6).in("m")),
       number_parameter("focus_distance", 1e4, "How far away the picture is sharp.")
           .range(1e-6, 1e12)
           .in("m"),
       integer_parameter("blades", 0, "Sides of the aperture; 0: round.").range(0, 100),
       number_parameter("blade_rotation", 0, "Turns an aperture with blades.")
           .range(-360, 360)
           .in("degrees")}};
  for (Parameter& parameter : perspective_parameters())
    info.parameters.push_back(std::move(parameter));
  for (Parameter& parameter : ignored_camera_parameters())
    info.parameters.push_back(std::move(parameter));
  return info;
}

const TypeInfo& thin_lens_info() {
  static const TypeInfo info = make_thin_lens_info();
  return info;
}

std::unique_ptr<Camera> create_thin_lens(const Arguments& arguments, const FilmSettings& film) {
  return std::make_unique<ThinLens>(arguments, film);
}

}  // namespace

CameraType thin_lens_camera_type() { return {thin_lens_info(), create_thin_lens}; }

}  // namespace kaustik
