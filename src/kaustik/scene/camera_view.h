#pragma once
// What cameras of several types share; not for other rooms.

#include <cmath>

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

  /// Components along left, up and forward, and back.
  Vec3f to_local(const Vec3f& v) const { return {dot(v, left), dot(v, up), dot(v, forward)}; }
  Vec3f to_world(const Vec3f& v) const { return left * v.x + up * v.y + forward * v.z; }
};

/// The crop window as a part of the whole picture, which reaches from −1 to 1: x to the left, y up.
class PictureWindow {
 public:
  explicit PictureWindow(const FilmSettings& film, const Vec2f& principal_offset = {0, 0});
  double aspect() const { return double(full_size_.x) / double(full_size_.y); }
  float pixels() const { return full_size_.x * full_size_.y; }
  /// Of the whole picture and of the crop window, pixels.
  const Vec2f& full_size() const { return full_size_; }
  const Vec2f& crop_size() const { return crop_size_; }
  const Vec2f& crop_offset() const { return crop_offset_; }

  Vec2f plane_of(const Vec2f& raster) const {
    const float sx = (raster.x + crop_offset_.x) / full_size_.x + principal_offset_.x;
    const float sy = (raster.y + crop_offset_.y) / full_size_.y + principal_offset_.y;
    return {1 - 2 * sx, 1 - 2 * sy};
  }
  Vec2f raster_of(const Vec2f& plane) const {
    return {(0.5f * (1 - plane.x) - principal_offset_.x) * full_size_.x - crop_offset_.x,
            (0.5f * (1 - plane.y) - principal_offset_.y) * full_size_.y - crop_offset_.y};
  }
  /// Whether it lies in the crop window.
  bool shows(const Vec2f& raster) const {
    return raster.x >= 0 && raster.y >= 0 && raster.x < crop_size_.x && raster.y < crop_size_.y;
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

/// What is cut off of the view: all that is nearer and all that is farther. Distances are along the
/// direction of view, or from the camera where it looks all around. What lies behind is seen in
/// place of what is cut off, and beyond the far end the background.
class ClipRange {
 public:
  /// Of the rows near_clip and far_clip. Throws Error(input) where the one is not below the other.
  explicit ClipRange(const Arguments& arguments);

  /// What is left of a camera's ray; `cosine`, positive, of its angle with the direction of view.
  CameraRay clip(const Ray& ray, float cosine = 1) const {
    CameraRay clipped{ray, 0};
    if (near_ > 0) {
      clipped.start = near_ / cosine;
      clipped.origin += ray.direction * clipped.start;
    }
    clipped.t_max = (far_ - near_) / cosine;
    return clipped;
  }
  /// A connection of a point that is cut off is of no importance; others end where rays begin.
  void clip(CameraConnection& connection, float cosine = 1) const {
    const float along = connection.distance * cosine;
    if (along < near_ || along > far_) connection.importance = 0;
    if (near_ > 0) connection.lens -= connection.direction * (near_ / cosine);
  }

 private:
  float near_ = 0, far_ = infinity;  ///< m
};
/// The rows near_clip and far_clip.
std::vector<Parameter> clip_parameters();

/// What cameras have in common whose view is one of straight lines.
struct StraightView {
  CameraFrame frame;
  PictureWindow window;
  ClipRange clip;
  Vec2f tan;             ///< of half the fields of view
  float pixel_area = 1;  ///< of one pixel on the plane at distance 1

  explicit StraightView(const CameraInputs& inputs);
  /// But for what is said of the lens.
  CameraTraits traits() const;

  /// Where the plane at distance 1 is seen: x along left, y along up.
  Vec2f slopes_of(const Vec2f& raster) const {
    const Vec2f plane = window.plane_of(raster);
    return {plane.x * tan.x, plane.y * tan.y};
  }
  /// The ray from a point of the lens along `direction`, unit.
  CameraRay ray(const Vec3f& lens, const Vec3f& direction) const {
    return clip.clip({lens, direction, infinity}, dot(direction, frame.forward));
  }
  /// By a point of the lens, in the world. What is seen straight ahead of it has the slopes `shift`
  /// in the picture: zero in the middle.
  CameraConnection connect(const Vec3f& point, const Vec3f& lens, const Vec2f& shift) const;
};

/// The rows of cameras with such a view but to_world: those of field_of_view_parameters(),
/// principal_point_offset_x and _y, near_clip and far_clip.
std::vector<Parameter> straight_view_parameters();

/// Where pictures that show the world all around show the same again: after a full turn along x,
/// and, if they reach over the poles, mirrored beyond their upper and lower edge, half a turn on.
class RasterRepetitions {
 public:
  /// `turn`: pixels of a full turn. `reach`: how far beyond the crop window it matters, pixels.
  RasterRepetitions(const PictureWindow& window, float turn, bool over_poles, float reach)
      : offset_(window.crop_offset()),
        size_(window.crop_size()),
        height_(window.full_size().y),
        turn_(turn),
        reach_(reach),
        over_poles_(over_poles) {}

  /// Visits all rasters, in and near the crop window, where that one is seen, itself included.
  template <typename Visit>
  void visit(const Vec2f& raster, const Visit& visit) const {
    if (!over_poles_) return visit_row(raster, visit);
    const float period = 2 * height_;
    const float mirrored = -raster.y - 2 * offset_.y;
    visit_series(raster.y, period, size_.y, [&](float y) { visit_row({raster.x, y}, visit); });
    visit_series(mirrored, period, size_.y, [&](float y) {
      visit_row({raster.x + 0.5f * turn_, y}, visit);
    });
  }

 private:
  template <typename Visit>
  void visit_row(const Vec2f& raster, const Visit& visit) const {
    if (!over_poles_ && !(raster.y > -reach_ && raster.y < size_.y + reach_)) return;
    visit_series(raster.x, turn_, size_.x, [&](float x) { visit(Vec2f(x, raster.y)); });
  }
  /// at + k · period, as far as that matters along a side of that size.
  template <typename Visit>
  void visit_series(float at, float period, float size, const Visit& visit) const {
    const float first = std::ceil((-reach_ - at) / period);
    for (float k = first; at + k * period < size + reach_; k += 1) visit(at + k * period);
  }

  Vec2f offset_, size_;
  float height_, turn_, reach_;
  bool over_poles_;
};

/// CameraTraits::parallel_distance of one whose picture is twice that wide, m.
inline float parallel_distance_of(float half_width) {
  constexpr float tan_of_usual_half_fov = 0.4663077f;  // 25°
  return half_width / tan_of_usual_half_fov;
}

/// What a camera answers that no light path connects to.
inline CameraConnection no_connection(const Vec3f& camera) {
  CameraConnection connection;
  connection.raster = {0, 0};
  connection.lens = camera;
  connection.direction = {0, 0, 1};
  connection.distance = 1;
  return connection;
}

/// Along which a meter looks: +z of to_world, or where there is none the row `direction`. Throws
/// Error(input) for a direction that is zero.
Vec3f meter_direction(const Arguments& arguments);

/// Rows of Mitsuba's that mean nothing to any camera here.
std::vector<Parameter> ignored_camera_parameters();

/// The table of a type of camera: its rows, and those that all have.
TypeInfo camera_info(const std::string& name, const std::string& sentence,
                     std::vector<Parameter> rows);
/// The same of one that `to_world` places: that row, its own, and those that say what it sees.
TypeInfo placed_camera_info(const std::string& name, const std::string& sentence,
                            std::vector<Parameter> own_rows,
                            std::vector<Parameter> view_rows = clip_parameters());

}  // namespace kaustik
