#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "kaustik/base/parameters.h"
#include "kaustik/base/sampler.h"
#include "kaustik/geometry/ray.h"
#include "kaustik/geometry/shape.h"
#include "kaustik/scene/film_settings.h"

namespace kaustik {

/// A ray of a camera. Where the camera sees nothing there is none: t_max is negative.
struct CameraRay : Ray {
  float start = 0;  ///< from the lens to the ray's origin, m: what is nearer is cut off
  bool is_none() const { return t_max < 0; }
  static CameraRay none() { return {{{0, 0, 0}, {0, 0, 1}, -1.0f}, 0}; }
};

/// Numbers in [0, 1)² that tell where on the lens a ray begins and, of cameras that look many ways
/// from each of its points (meters), which way it goes.
struct LensNumbers {
  Vec2f place{0.5f, 0.5f}, way{0.5f, 0.5f};

  LensNumbers() = default;
  LensNumbers(const Vec2f& of_place) : place(of_place) {}
  LensNumbers(const Vec2f& of_place, const Vec2f& of_way) : place(of_place), way(of_way) {}
  friend bool operator==(const LensNumbers& a, const LensNumbers& b) {
    return a.place == b.place && a.way == b.way;
  }
};

/// How a point is seen by the camera.
struct CameraConnection {
  Vec2f raster;        ///< pixel coordinates, in the frame of the crop window
  Vec3f lens;          ///< where light enters the camera, m, in the world: a point of the lens, or
                       ///< before it where what is near is cut off
  Vec3f direction;     ///< unit, from the point to there
  float distance = 0;  ///< from the point to the lens, m
  /// Raster area (pixels) per solid angle at the lens: a light path of radiant intensity I toward
  /// the lens adds I / distance² × importance to the radiance of its pixel.
  float importance = 0;  ///< zero: outside the picture or behind
};

/// A point, and the side of it, whose irradiance a camera measures: light passes it as if it were
/// not there. Paths of the camera begin there, as on a white matt surface.
struct Gauge {
  Vec3f position{0, 0, 0};  ///< m, in the world
  Vec3f normal{0, 0, 1};    ///< unit, on the side that is measured
};

/// What is the same for a camera whoever asks.
struct CameraTraits {
  Vec3f position{0, 0, 0};  ///< middle of the lens, m, in the world; a pinhole's lens is all there
  /// Half the angle that one pixel covers, radians: the ray's spread per unit distance.
  float pixel_spread = 0;
  float pixel_width = 0;  ///< half of what one pixel is wide at the lens, m; 0: a point
  float horizontal_fov = 0, vertical_fov = 0;  ///< degrees, of the whole (uncropped) picture, of
                                               ///< views of straight lines; 0: of another kind
  std::string view;         ///< what it sees, for the user, where there is no field of view
  bool has_lens = false;    ///< whether it matters where on the lens rays begin
  bool has_ways = false;    ///< whether LensNumbers::way matters
  bool can_connect = true;  ///< whether it can be asked how a point is seen; else connect()
                            ///< answers with importance 0
  bool repeats = false;     ///< see Camera::visit_repetitions()
  float weight = 1;         ///< that a ray's radiance counts with
  bool measures_irradiance = false;  ///< then that weight is π, and pixels are irradiances
  /// Of a meter: "lx" or "cd/m²", what its pixels are times lumens_per_watt_white; "": it takes a
  /// picture.
  std::string meter_unit;
  /// Each pixel measures something of its own: nothing is filtered or learned across pixels. The
  /// picture has this size, then; 0: pixels are those of a picture.
  Vec2i size_of_pixels_apart{0, 0};
  bool are_pixels_apart() const { return size_of_pixels_apart.x > 0; }
  /// Of a camera that sees along parallel lines: from where one of usual field of view would see as
  /// much, m; 0: it sees from a point.
  float parallel_distance = 0;
};

/// Where pictures are seen from. Rays begin at a point of the lens, which is told by numbers in
/// [0, 1)²; whoever follows a ray and asks how a point is seen by it gives the same numbers again.
/// Immutable, thread-safe. Its own space: it looks along +z, +x to the left, +y up (Mitsuba).
class Camera {
 public:
  virtual ~Camera() = default;
  const CameraTraits& traits() const { return traits_; }

  /// For whom any ray will do.
  static LensNumbers middle_of_lens() { return {}; }
  /// Of the i-th of several rays that look around: the middle of the lens, but of a meter, which
  /// would look one way only, another point and way for each.
  LensNumbers numbers_to_look_around(uint32_t i) const;

  /// Numbers for a point of the lens: a dimension pair of `sampler` if there is a lens, another one
  /// for the way.
  LensNumbers lens_numbers(Sampler& sampler) const {
    LensNumbers numbers;
    if (traits_.has_lens) numbers.place = sampler.next_2d();
    if (traits_.has_ways) numbers.way = sampler.next_2d();
    return numbers;
  }
  /// The same off a fork of `sampler`, which stays as it is.
  LensNumbers forked_lens_numbers(const Sampler& sampler) const {
    return traits_.has_lens ? LensNumbers(sampler.fork(Fork::lens).next_2d()) : middle_of_lens();
  }

  /// `raster`: pixel coordinates in the crop window, (0, 0) its upper left corner. The origin is
  /// the point of the lens, but for what is cut off; the direction is unit.
  virtual CameraRay sample_ray(const Vec2f& raster, const LensNumbers& lens) const = 0;
  /// By that point of the lens.
  virtual CameraConnection connect(const Vec3f& point, const LensNumbers& lens) const = 0;

  /// Where paths begin that have no ray of a camera: one for each of the first pixels, row by row;
  /// none: paths begin with rays.
  const std::vector<Gauge>& gauges() const { return gauges_; }
  /// Number of the gauge that a pixel shows; −1: there is none.
  virtual int gauge_at(const Vec2f& /*raster*/) const { return -1; }

  /// Cameras that look all around show what lies at one edge of the picture beyond another one,
  /// too, where pixel filters reach. Visits `connection` with the other rasters where it is seen.
  virtual void visit_repetitions(const CameraConnection& /*connection*/,
                                 const std::function<void(const CameraConnection&)>&) const {}

 protected:
  CameraTraits traits_;  ///< complete once the constructor is done
  std::vector<Gauge> gauges_;
};

/// What a camera is made of.
struct CameraInputs {
  const Arguments& arguments;
  const FilmSettings& film;
  /// That it belongs to or looks at; null: none.
  std::shared_ptr<const Shape> shape = nullptr;
  bool shape_is_passed = false;  ///< by light and by rays, as if it were not there (bsdf null)
  Bounds3f scene_bounds = {};
};

struct CameraType {
  const TypeInfo& info;
  /// Throws Error(input) for a transform that is degenerate.
  std::unique_ptr<Camera> (*create)(const CameraInputs&);
  bool needs_shape = false;  ///< it belongs to a shape
  bool takes_shape = false;  ///< it may hold one, which it looks at
};
/// "perspective", "thinlens", "orthographic", "telecentric", "fisheye", "spherical", "cylinder",
/// "irradiancemeter", "irradiancepoints", "radiancemeter", "radiancerays", "fluencemeter",
/// "distant".
const std::vector<CameraType>& camera_types();

}  // namespace kaustik
