#include "kaustik/light/pattern_points.h"

#include "kaustik/light/power_distribution.h"

namespace kaustik {
namespace {

/// Cells of the table along each side, how wide in uv what one of them stands for is taken to be,
/// and the share of points that is uniform.
constexpr int cells_per_side = 128;
constexpr float width_of_cell = 1.0f / cells_per_side;
constexpr double uniform_share_of_points = 0.1;

constexpr size_t most_triangles = 64;

SquareDistribution distribution_over(const Shape& shape, const EmissionPattern& pattern) {
  std::vector<double> weights;
  for (int y = 0; y < cells_per_side; ++y)
    for (int x = 0; x < cells_per_side; ++x) {
      const Vec2f u((float(x) + 0.5f) * width_of_cell, (float(y) + 0.5f) * width_of_cell);
      weights.push_back(
          importance_of(pattern.mean_about(shape.sample_area(u).point, width_of_cell)));
    }
  return {cells_per_side, cells_per_side, weights, uniform_share_of_points};
}

}  // namespace

PatternPoints::PatternPoints(const Shape& shape, const EmissionPattern& pattern)
    : shape_(shape), distribution_(distribution_over(shape, pattern)) {}

std::unique_ptr<const PatternPoints> PatternPoints::make(const Shape& shape,
                                                         const EmissionPattern& pattern) {
  if (!(shape.area() > 0)) return nullptr;
  if (shape.mesh() && shape.mesh()->triangles.size() > most_triangles) return nullptr;
  if (!shape.area_coordinates(shape.sample_area({0.3f, 0.4f}).point)) return nullptr;
  return std::unique_ptr<const PatternPoints>(new PatternPoints(shape, pattern));
}

ShapeSample PatternPoints::sample(const Vec2f& u) const {
  float density = 0;
  const Vec2f square = distribution_.sample(u, density);
  ShapeSample sample = shape_.sample_area(square);
  sample.pdf_area *= density;
  return sample;
}

float PatternPoints::pdf_area(const SurfacePoint& point) const {
  const std::optional<Vec2f> square = shape_.area_coordinates(point);
  if (!square) return 0;
  return distribution_.pdf({std::clamp(square->x, 0.0f, 1.0f), std::clamp(square->y, 0.0f, 1.0f)}) /
         shape_.area();
}

}  // namespace kaustik
