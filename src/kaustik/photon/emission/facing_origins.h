#pragma once
#include "kaustik/light/light.h"
#include "kaustik/photon/emission/aim_spheres.h"
#include "kaustik/photon/emission/emission.h"

namespace kaustik {

/// Points of a light from which a given direction leaves. Spheres and meshes of few triangles give
/// them in proportion to their projected area, so that no point faces away; other lights uniformly
/// by area.
class FacingOrigins {
 public:
  /// `shape`: of area lights, else null. Both must outlive this.
  FacingOrigins(const Light& light, const Shape* shape);

  /// False if there is none. `pdf`: per area (1 for lights that are points).
  bool sample(const Vec3f& direction, const Vec2f& u, SurfacePoint& origin, float& pdf) const;
  /// A ray of the light in that direction, by sample(): its density per solid angle, or whatever
  /// else the caller counts in, is `pdf_direction`. Flux zero: there is none.
  EmittedRay ray(const Vec3f& direction, float pdf_direction, const Vec2f& u,
                 const Wavelengths& wavelengths) const;
  /// Density of sample() for a point of the light that `direction` leaves.
  float pdf(const SurfacePoint& origin, const Vec3f& direction) const;

 private:
  bool sample_ball(const Vec3f& direction, const Vec2f& u, SurfacePoint& origin) const;
  bool sample_mesh(const Vec3f& direction, Vec2f u, SurfacePoint& origin) const;
  float projected_area(const Vec3f& direction) const;

  const Light* light_;
  const Shape* shape_;
  Ball ball_;
  struct Face {
    Vec3f area_vector;  ///< normal times area
    uint32_t triangle;
  };
  std::vector<Face> faces_;
};

/// The point of a ball light whose normal is unit `outward`; false if the shape has a hole there.
/// Found by a ray from outside, so that the shape itself says where and how exact it is.
bool point_of_ball(const Shape& shape, const Ball& ball, const Vec3f& outward, SurfacePoint& point);

}  // namespace kaustik
