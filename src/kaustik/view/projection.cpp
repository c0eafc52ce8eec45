#include "kaustik/view/projection.h"

#include <algorithm>
#include <cmath>

#include "kaustik/scene/camera.h"

namespace kaustik::view {
namespace {

constexpr double tolerance = 1e-4;

struct Place {
  double x, y;
};
struct Line {
  Vec3d origin, direction;
};

std::optional<Line> line_of(const Camera& camera, double x, double y) {
  const CameraRay ray = camera.sample_ray(Vec2f(float(x), float(y)), Camera::middle_of_lens());
  if (ray.is_none()) return std::nullopt;
  const Vec3d direction = Vec3d(ray.direction).normalized();
  return Line{Vec3d(ray.origin) - direction * double(ray.start), direction};
}

/// Unit vectors.
bool are_near(const Vec3d& a, const Vec3d& b) { return (a - b).length() <= tolerance; }

/// The inverse of the matrix with columns a, b, c, as its rows; none: there is none.
struct Rows {
  Vec3d x, y, z;
};
std::optional<Rows> inverse(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const double determinant = a.dot(b.cross(c));
  const double size = a.length() * b.length() * c.length();
  if (!(std::abs(determinant) > 1e-12 * size)) return std::nullopt;
  return Rows{b.cross(c) / determinant, c.cross(a) / determinant, a.cross(b) / determinant};
}

/// Of points relative to `origin`: w is the last row, or 1.
Projection projection_from(const Rows& rows, const Vec3d& origin, bool is_parallel) {
  const auto row = [&](const Vec3d& r) { return std::array{r.x, r.y, r.z, -r.dot(origin)}; };
  const auto x = row(rows.x), y = row(rows.y);
  const auto w = is_parallel ? std::array{0.0, 0.0, 0.0, 1.0} : row(rows.z);
  return {x[0], x[1], x[2], x[3], y[0], y[1], y[2], y[3], w[0], w[1], w[2], w[3]};
}

/// Lines through one point: directions that are linear in x and y, but for their lengths. Those of
/// three corners follow from that of the fourth.
std::optional<Projection> of_one_point(const std::array<Line, 4>& corners, const Vec2i& size) {
  const auto rows = inverse(corners[0].direction, corners[1].direction, corners[2].direction);
  if (!rows) return std::nullopt;
  const Vec3d& last = corners[3].direction;
  const double k0 = -rows->x.dot(last), k1 = rows->y.dot(last), k2 = rows->z.dot(last);
  if (!(k0 > 0 && k1 > 0 && k2 > 0)) return std::nullopt;
  const Vec3d start = corners[0].direction * k0;
  const auto direction = inverse((corners[1].direction * k1 - start) / double(size.x),
                                 (corners[2].direction * k2 - start) / double(size.y), start);
  if (!direction) return std::nullopt;
  return projection_from(*direction, corners[0].origin, false);
}

std::optional<Projection> of_parallel_lines(const std::array<Line, 4>& corners, const Vec2i& size) {
  const auto rows =
      inverse((corners[1].origin - corners[0].origin) / double(size.x),
              (corners[2].origin - corners[0].origin) / double(size.y), corners[0].direction);
  if (!rows) return std::nullopt;
  return projection_from(*rows, corners[0].origin, true);
}

/// Whether a point of the line is seen at x, y.
bool is_seen_at(const Projection& m, const Line& line, double x, double y, const Vec2i& size) {
  const Vec3d p = line.origin + line.direction;
  const auto row = [&](size_t i) {
    return m[i] * p.x + m[i + 1] * p.y + m[i + 2] * p.z + m[i + 3];
  };
  const double w = row(8);
  return w > 0 && std::abs(row(0) / w - x) <= tolerance * 10 * double(size.x) &&
         std::abs(row(4) / w - y) <= tolerance * 10 * double(size.y);
}

}  // namespace

std::optional<Projection> projection_of(const Camera& camera, const Vec2i& size) {
  const double width = double(size.x), height = double(size.y);
  std::array<Line, 4> corners;
  const std::array<Place, 4> places = {Place{0, 0}, {width, 0}, {0, height}, {width, height}};
  for (size_t i = 0; i < corners.size(); ++i) {
    const auto line = line_of(camera, places[i].x, places[i].y);
    if (!line) return std::nullopt;
    corners[i] = *line;
  }
  const Line& first = corners[0];
  double spread = 0;
  for (const Line& corner : corners)
    spread = std::max(spread, (corner.origin - first.origin).length());
  const bool has_one_point = spread <= tolerance * (1 + first.origin.length());
  const bool is_parallel =
      !has_one_point && std::all_of(corners.begin(), corners.end(), [&](const Line& corner) {
        return are_near(corner.direction, first.direction);
      });
  if (!has_one_point && !is_parallel) return std::nullopt;
  const auto projection =
      is_parallel ? of_parallel_lines(corners, size) : of_one_point(corners, size);
  if (!projection) return std::nullopt;
  for (const Place& place : {Place{width / 2, height / 2}, Place{0.3 * width, 0.9 * height}}) {
    const auto line = line_of(camera, place.x, place.y);
    if (!line || !is_seen_at(*projection, *line, place.x, place.y, size)) return std::nullopt;
  }
  return projection;
}

}  // namespace kaustik::view
