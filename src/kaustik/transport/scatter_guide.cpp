#include "kaustik/transport/scatter_guide.h"

#include <cmath>

#include "kaustik/base/warp.h"

namespace kaustik {
namespace {

/// Directions to a ball: about `axis`, unit.
struct Cone {
  Vec3f axis{0, 0, 1};
  float one_minus_cos = 2;

  Cone(const ScatterGuide::Ball& ball, const Vec3f& position) {
    const Vec3f to_center = ball.center - position;
    const float distance_sq = length_sq(to_center), radius_sq = sqr(ball.radius);
    if (!(distance_sq > radius_sq)) return;
    axis = to_center * (1 / std::sqrt(distance_sq));
    const float sine_sq = radius_sq / distance_sq;
    one_minus_cos = std::max(least, sine_sq / (1 + std::sqrt(1 - sine_sq)));
  }
  /// A thousandth of a radian on every side: narrower ones are lost in the rounding of directions.
  static constexpr float least = 5e-7f;
  bool holds(const Vec3f& direction) const {
    // Exact for narrow cones: 1 − cos of the angle between unit vectors, which is off by the angle
    // times their rounding. What is drawn within the cone must be found there.
    const float rounding = 4e-7f * std::sqrt(one_minus_cos);
    return 0.5f * length_sq(direction - axis) <= one_minus_cos + rounding;
  }
};

}  // namespace

int ScatterGuide::side_of(const Vec3f& normal) {
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (std::fabs(normal[i]) > std::fabs(normal[axis])) axis = i;
  return 2 * axis + (normal[axis] < 0 ? 1 : 0);
}

float ScatterGuide::pdf(const Ball& ball, const Vec3f& position, const Vec3f& direction) {
  const Cone cone(ball, position);
  return cone.holds(direction) ? cone_pdf(cone.one_minus_cos) : 0.0f;
}

Vec3f ScatterGuide::Place::sample(float u_ball, const Vec2f& u) const {
  const std::span<const Share> of_cell = shares();
  size_t i = 0;
  while (i + 1 < of_cell.size() && u_ball >= of_cell[i].of_paths) u_ball -= of_cell[i++].of_paths;
  const Cone cone(parts_->balls[of_cell[i].ball], position_);
  return Frame(cone.axis).to_world(square_to_cone(u, cone.one_minus_cos));
}

float ScatterGuide::Place::pdf(float plain, const Vec3f& direction) const {
  if (!cell_) return plain;
  float sum = (1 - cell_->guided) * plain;
  for (const Share& share : shares())
    sum += share.of_paths * ScatterGuide::pdf(parts_->balls[share.ball], position_, direction);
  return sum;
}

ScatterGuide::Place ScatterGuide::place(const Vec3f& position, int side) const {
  const Node* node = &parts_.nodes[size_t(side)];
  while (node->axis >= 0)
    node = &parts_.nodes[size_t(node->next) + (position[node->axis] < node->split ? 0 : 1)];
  const Cell& cell = parts_.cells[node->next];
  return cell.guided > 0 ? Place(parts_, cell, position) : Place();
}

ScatterGuide::Place ScatterGuide::place(const SurfaceVertex& vertex, const Vec3f& from) const {
  if (!guides(vertex)) return {};
  const Vec3f& normal = vertex.point().ng;
  return place(vertex.position(), side_of(dot(from, normal) < 0 ? -normal : normal));
}

}  // namespace kaustik
