#pragma once
#include <memory>
#include <vector>

#include "kaustik/base/parameters.h"
#include "kaustik/geometry/ray.h"
#include "kaustik/scene/film_settings.h"

namespace kaustik {

/// How a point is seen by the camera.
struct CameraConnection {
  Vec2f raster;     ///< pixel coordinates, in the frame of the crop window
  Vec3f direction;  ///< unit, from the point to the camera
  float distance = 0;
  /// Raster area (pixels) per solid angle at the camera: a light path of radiant intensity I toward
  /// the camera adds I / distance² × importance to the radiance of its pixel.
  float importance = 0;  ///< zero: outside the picture or behind
};

/// Perspective pinhole. Looks along +z of its own space, +x to the left, +y up (Mitsuba).
class Camera {
 public:
  /// `info()`'s arguments; throws Error for a transform that is degenerate.
  Camera(const Arguments& arguments, const FilmSettings& film);
  static const TypeInfo& info();

  /// `raster`: pixel coordinates in the crop window, (0, 0) its upper left corner.
  Ray sample_ray(const Vec2f& raster) const;
  CameraConnection connect(const Vec3f& point) const;
  Vec3f position() const { return position_; }
  /// Half the angle that one pixel covers, radians: the ray's spread per unit distance.
  float pixel_spread() const { return pixel_spread_; }
  /// Degrees, of the whole (uncropped) picture.
  float horizontal_fov() const { return horizontal_fov_; }
  float vertical_fov() const { return vertical_fov_; }

 private:
  Vec3f position_, left_, up_, forward_;
  float tan_x_ = 1, tan_y_ = 1;  ///< of half the fields of view
  Vec2f full_size_, crop_offset_, crop_size_, principal_offset_;
  float pixel_area_ = 1;  ///< of one pixel on the plane at distance 1
  float pixel_spread_ = 0;
  float horizontal_fov_ = 0, vertical_fov_ = 0;
};

}  // namespace kaustik
