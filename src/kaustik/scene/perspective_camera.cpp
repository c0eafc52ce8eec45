#include "kaustik/scene/camera_kinds.h"
#include "kaustik/scene/camera_view.h"

namespace kaustik {
namespace {

/// A pinhole.
class Perspective final : public Camera {
 public:
  Perspective(const Arguments& arguments, const FilmSettings& film);

  Ray sample_ray(const Vec2f& raster, const Vec2f& u_lens) const override;
  CameraConnection connect(const Vec3f& point, const Vec2f& u_lens) const override;

 private:
  CameraFrame frame_;
  PictureWindow window_;
  Vec2f tan_;             ///< of half the fields of view
  float pixel_area_ = 1;  ///< of one pixel on the plane at distance 1
};

Perspective::Perspective(const Arguments& arguments, const FilmSettings& film)
    : frame_(arguments, true),
      window_(film, principal_offset_of(arguments)),
      tan_(tan_half_fov(arguments, window_.aspect())) {
  traits_.position = frame_.position;
  traits_.horizontal_fov = 360 * inv_pi * std::atan(tan_.x);
  traits_.vertical_fov = 360 * inv_pi * std::atan(tan_.y);
  pixel_area_ = 4 * tan_.x * tan_.y / window_.pixels();
  traits_.pixel_spread = 0.5f * std::sqrt(pixel_area_);
}

Ray Perspective::sample_ray(const Vec2f& raster, const Vec2f&) const {
  const Vec2f plane = window_.plane_of(raster);
  const Vec3f d =
      frame_.forward + frame_.left * (plane.x * tan_.x) + frame_.up * (plane.y * tan_.y);
  return {traits_.position, normalize(d), infinity};
}

CameraConnection Perspective::connect(const Vec3f& point, const Vec2f&) const {
  CameraConnection c;
  c.lens = traits_.position;
  const Vec3f to_camera = c.lens - point;
  c.distance = length(to_camera);
  if (!(c.distance > 0)) return c;
  c.direction = to_camera * (1 / c.distance);
  const float cosine = -dot(c.direction, frame_.forward);
  if (!(cosine > 0)) return c;
  const float x = -dot(c.direction, frame_.left) / cosine,
              y = -dot(c.direction, frame_.up) / cosine;
  c.raster = window_.raster_of({x / tan_.x, y / tan_.y});
  if (window_.holds(c.raster)) c.importance = 1 / (pixel_area_ * cosine * cosine * cosine);
  return c;
}

TypeInfo make_perspective_info() {
  TypeInfo info{
      "sensor",
      "perspective",
      "Pinhole camera that looks along +z of its own space; +x points to the left of the picture.",
      {to_world_parameter("From the camera's space to the world.")}};
  for (Parameter& parameter : perspective_parameters())
    info.parameters.push_back(std::move(parameter));
  for (Parameter& parameter : ignored_camera_parameters())
    info.parameters.push_back(std::move(parameter));
  info.parameters.push_back(ignored_parameter("focus_distance", ParameterKind::number));
  return info;
}

const TypeInfo& perspective_info() {
  static const TypeInfo info = make_perspective_info();
  return info;
}

std::unique_ptr<Camera> create_perspective(const Arguments& arguments, const FilmSettings& film) {
  return std::make_unique<Perspective>(arguments, film);
}

}  // namespace

CameraType perspective_camera_type() { return {perspective_info(), create_perspective}; }

}  // namespace kaustik
