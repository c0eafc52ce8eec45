#pragma once
// What cameras of several types share; not for other rooms.

#include "kaustik/base/field_of_view.h"
#include "kaustik/scene/camera.h"

namespace kaustik {

/// Where a camera stands and how it is turned.
struct CameraFrame {
  Vec3f position{0, 0, 0};
  Vec3f left{1, 0, 0}, up{0, 1, 0}, forward{0, 0, 1};  ///< unit, orthogonal
  Vec2f scale{1, 1};                                   ///< of to_world along left and up

  /// Of the row to_world. Throws Error(input) where it shears, or scales the two directions of the
  /// picture unlike; if `is_uniform`, the direction of view, too.
  CameraFrame(const Arguments& arguments, bool is_uniform);

  /// Components along left, up and forward.
  Vec3f to_local(const Vec3f& v) const { return {dot(v, left), dot(v, up), dot(v, forward)}; }
};

/// The crop window as a part of the whole picture, which reaches from −1 to 1: x to the left, y up.
class PictureWindow {
 public:
  explicit PictureWindow(const FilmSettings& film, const Vec2f& principal_offset = {0, 0});
  double aspect() const { return double(full_size_.x) / double(full_size_.y); }
  float pixels() const { return full_size_.x * full_size_.y; }

  Vec2f plane_of(const Vec2f& raster) const {
    const float sx = (raster.x + crop_offset_.x) / full_size_.x + principal_offset_.x;
    const float sy = (raster.y + crop_offset_.y) / full_size_.y + principal_offset_.y;
    return {1 - 2 * sx, 1 - 2 * sy};
  }
  Vec2f raster_of(const Vec2f& plane) const {
    return {(0.5f * (1 - plane.x) - principal_offset_.x) * full_size_.x - crop_offset_.x,
            (0.5f * (1 - plane.y) - principal_offset_.y) * full_size_.y - crop_offset_.y};
  }
  /// With a margin of the widest filter: splats beyond the edge still reach pixels inside.
  bool holds(const Vec2f& raster) const {
    constexpr float margin = 16;
    return raster.x > -margin && raster.y > -margin && raster.x < crop_size_.x + margin &&
           raster.y < crop_size_.y + margin;
  }

 private:
  Vec2f full_size_, crop_offset_, crop_size_, principal_offset_;
};

/// The rows of field_of_view_parameters(), principal_point_offset_x and _y of cameras with a field
/// of view of straight lines.
std::vector<Parameter> perspective_parameters();
Vec2f principal_offset_of(const Arguments& arguments);

/// Rows of Mitsuba's that mean nothing to any camera here.
std::vector<Parameter> ignored_camera_parameters();

}  // namespace kaustik
