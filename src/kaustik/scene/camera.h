#pragma once
#include <memory>
#include <vector>

#include "kaustik/base/parameters.h"
#include "kaustik/base/sampler.h"
#include "kaustik/geometry/ray.h"
#include "kaustik/scene/film_settings.h"

namespace kaustik {

/// How a point is seen by the camera.
struct CameraConnection {
  Vec2f raster;     ///< pixel coordinates, in the frame of the crop window
  Vec3f lens;       ///< where light enters the camera, m, in the world
  Vec3f direction;  ///< unit, from the point to there
  float distance = 0;
  /// Raster area (pixels) per solid angle at the lens: a light path of radiant intensity I toward
  /// the lens adds I / distance² × importance to the radiance of its pixel.
  float importance = 0;  ///< zero: outside the picture or behind
};

/// What is the same for a camera whoever asks.
struct CameraTraits {
  Vec3f position{0, 0, 0};  ///< middle of the lens, m, in the world; a pinhole's lens is all there
  /// Half the angle that one pixel covers, radians: the ray's spread per unit distance.
  float pixel_spread = 0;
  float pixel_width = 0;  ///< half of what one pixel is wide at the lens, m; 0: a point
  float horizontal_fov = 0, vertical_fov = 0;  ///< degrees, of the whole (uncropped) picture; 0: it
                                               ///< sees along parallel lines
  bool has_lens = false;                       ///< whether it matters where on the lens rays begin
};

/// Where pictures are seen from. Rays begin at a point of the lens, which is told by two numbers in
/// [0, 1)²; whoever follows a ray and asks how a point is seen by it gives the same numbers again.
/// Immutable, thread-safe. Its own space: it looks along +z, +x to the left, +y up (Mitsuba).
class Camera {
 public:
  virtual ~Camera() = default;
  const CameraTraits& traits() const { return traits_; }

  /// For whom any ray will do.
  static Vec2f middle_of_lens() { return {0.5f, 0.5f}; }

  /// Numbers for a point of the lens: a dimension pair of `sampler` if there is a lens.
  Vec2f lens_numbers(Sampler& sampler) const {
    return traits_.has_lens ? sampler.next_2d() : middle_of_lens();
  }
  /// The same off a fork of `sampler`, which stays as it is.
  Vec2f forked_lens_numbers(const Sampler& sampler) const {
    return traits_.has_lens ? sampler.fork(Fork::lens).next_2d() : middle_of_lens();
  }

  /// `raster`: pixel coordinates in the crop window, (0, 0) its upper left corner. The origin is
  /// the point of the lens; the direction is unit.
  virtual Ray sample_ray(const Vec2f& raster, const Vec2f& u_lens) const = 0;
  /// By that point of the lens.
  virtual CameraConnection connect(const Vec3f& point, const Vec2f& u_lens) const = 0;

 protected:
  CameraTraits traits_;  ///< complete once the constructor is done
};

struct CameraType {
  const TypeInfo& info;
  /// Throws Error(input) for a transform that is degenerate.
  std::unique_ptr<Camera> (*create)(const Arguments&, const FilmSettings&);
};
/// "perspective", "thinlens", "orthographic".
const std::vector<CameraType>& camera_types();

}  // namespace kaustik
