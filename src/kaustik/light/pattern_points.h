#pragma once
#include <memory>

#include "kaustik/light/emission_pattern.h"
#include "kaustik/light/square_distribution.h"

namespace kaustik {

/// Points of a shape by the brightness of a pattern on it: by a table over the square that
/// Shape::sample_area() takes its numbers from. A share of them is uniform by area.
class PatternPoints {
 public:
  /// Null for shapes that do not know their area_coordinates(), and for meshes of many triangles,
  /// which a table would not tell apart. Both must outlive the result.
  static std::unique_ptr<const PatternPoints> make(const Shape& shape,
                                                   const EmissionPattern& pattern);

  ShapeSample sample(const Vec2f& u) const;
  /// Density of sample() for a point of the shape, per area; between two cells of the table it may
  /// be either's.
  float pdf_area(const SurfacePoint& point) const;

 private:
  PatternPoints(const Shape& shape, const EmissionPattern& pattern);

  const Shape& shape_;
  SquareDistribution distribution_;
};

}  // namespace kaustik
