#pragma once
#include <functional>
#include <memory>

#include "kaustik/light/emission_pattern.h"
#include "kaustik/light/square_distribution.h"

namespace kaustik {

/// A picture that a light throws from a point: it lies on the plane z = 1 of the light's own space,
/// over a rectangle or the ellipse within it. Rays are drawn where it is bright.
class Slide {
 public:
  enum class Outline { rectangle, ellipse };
  /// What leaves along a unit direction of the light's space, over the picture's value there.
  using Factor = std::function<float(const Vec3f& local)>;

  /// `half_size`: where on the plane the picture's uv (1, 1) lies; the origin is its middle. A null
  /// picture is 1 everywhere.
  Slide(std::shared_ptr<const EmissionPattern> picture, const Vec2f& half_size, Outline outline,
        const Factor& factor);

  /// The picture's value, along a unit direction; zero beside it.
  Spectrum value(const Vec3f& local, const Wavelengths& wavelengths) const;
  /// Its value times the factor, integrated over all directions in RGB mode.
  const Spectrum& integral() const { return integral_; }
  /// Cosine of the half angle of the cone about +z that holds it.
  float cos_angle() const;

  /// A unit direction, close in proportion to value times factor …
  Vec3f sample(const Vec2f& u) const { return direction_of(distribution_.sample(u)); }
  /// … and its density per solid angle; zero beside the picture.
  float pdf(const Vec3f& local) const;

 private:
  /// Points of the outline stand for those of the unit square; areas stay in proportion.
  Vec2f plane_point_of(const Vec2f& square) const;  ///< over half_size_: from −1 to 1
  Vec3f direction_of(const Vec2f& square) const;
  float area() const;
  /// Where along a direction the plane is met, over half_size_; false beside the picture.
  bool meet(const Vec3f& local, Vec2f& plane_point) const;
  SurfacePoint place_of(const Vec2f& plane_point) const;

  std::shared_ptr<const EmissionPattern> picture_;
  Vec2f half_size_;
  Outline outline_;
  Spectrum integral_;
  SquareDistribution distribution_;
};

}  // namespace kaustik
