#include "kit/sweep.h"

#include <stdexcept>

namespace kaustik::scenes {
namespace {

double turn(const Vec2d& a, const Vec2d& b, const Vec2d& c) { return (b - a).cross(c - a); }

bool is_inside(const Vec2d& p, const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

bool is_ear(const Curve& outline, const std::vector<uint32_t>& left, size_t i) {
  const size_t n = left.size();
  const Vec2d &a = outline[left[(i + n - 1) % n]], &b = outline[left[i]],
              &c = outline[left[(i + 1) % n]];
  if (turn(a, b, c) <= 0) return false;
  for (const uint32_t other : left) {
    const Vec2d& p = outline[other];
    if (p != a && p != b && p != c && is_inside(p, a, b, c)) return false;
  }
  return true;
}

/// Where the outline stands at one point of a path.
struct Section {
  Vec3d at, right, up;
  Vec3d direction;     ///< in which the path arrives
  Vec3d mitre_normal;  ///< of the plane in which the outline is cut
};

/// `v` turned as the direction `from` turns to `to` (both unit length, not opposite).
Vec3d carried(const Vec3d& v, const Vec3d& from, const Vec3d& to) {
  const Vec3d axis = from.cross(to);
  const double c = from.dot(to);
  return v * c + axis.cross(v) + axis * (axis.dot(v) / (1 + c));
}

std::vector<Section> sections_of(const Path& path, const Vec3d& up, bool closed) {
  const size_t n = path.size();
  if (n < 2) throw std::invalid_argument("swept: the path needs two points");
  const auto direction = [&](size_t i) { return (path[(i + 1) % n] - path[i % n]).normalized(); };
  std::vector<Section> sections;
  Vec3d arriving = direction(closed ? n - 1 : 0);
  Vec3d side = arriving.cross(up).normalized();
  for (size_t i = 0; i < n; ++i) {
    const Vec3d leaving = i + 1 < n || closed ? direction(i) : arriving;
    sections.push_back(
        {path[i], side, side.cross(arriving), arriving, (arriving + leaving).normalized()});
    side = carried(side, arriving, leaving);
    arriving = leaving;
  }
  return sections;
}

/// The offset slid along the path's direction into the mitre's plane.
Vec3d placed(const Section& section, const Vec2d& p) {
  const Vec3d offset = section.right * p.x + section.up * p.y;
  const double slide =
      offset.dot(section.mitre_normal) / section.direction.dot(section.mitre_normal);
  return section.at + offset - section.direction * slide;
}

std::vector<double> shares_of_path(const Path& path, bool closed) {
  std::vector<double> at = {0.0};
  for (size_t i = 1; i < path.size() + (closed ? 1 : 0); ++i)
    at.push_back(at.back() + (path[i % path.size()] - path[i - 1]).length());
  const double whole = at.back();
  for (double& a : at) a /= whole;
  return at;
}

/// Adds the outline at one end as a face; `flip` where the outside is against the path.
void add_cap(Mesh& mesh, const Section& section, const Curve& outline, double scale, bool flip) {
  Imath::Box<Vec2d> bounds;
  for (const Vec2d& p : outline) bounds.extendBy(p);
  const auto first = uint32_t(mesh.vertices.size());
  for (const Vec2d& p : outline)
    mesh.add(placed(section, p * scale), (p - bounds.min) / bounds.size());
  for (const auto& [a, b, c] : triangulated(outline))
    mesh.triangle(first + a, first + (flip ? c : b), first + (flip ? b : c));
}

}  // namespace

std::vector<std::array<uint32_t, 3>> triangulated(const Curve& outline) {
  std::vector<uint32_t> left(outline.size());
  for (uint32_t i = 0; i < left.size(); ++i) left[i] = i;
  std::vector<std::array<uint32_t, 3>> triangles;
  while (left.size() > 3) {
    size_t i = 0;
    while (i < left.size() && !is_ear(outline, left, i)) ++i;
    if (i == left.size())
      throw std::invalid_argument("the outline crosses itself or runs clockwise");
    const size_t n = left.size();
    triangles.push_back({left[(i + n - 1) % n], left[i], left[(i + 1) % n]});
    left.erase(left.begin() + std::ptrdiff_t(i));
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

Mesh extruded(const Curve& outline, double z0, double z1, double crease_degrees) {
  // Along +z with `up` = y, the right side is direction x up = -x; so the outline is mirrored.
  Curve mirrored(outline.rbegin(), outline.rend());
  for (Vec2d& p : mirrored) p.x = -p.x;
  SweepOptions options;
  options.crease_degrees = crease_degrees;
  return swept(mirrored, {{0, 0, z0}, {0, 0, z1}}, {0, 1, 0}, options);
}

Mesh swept(const Curve& outline, const Path& path, const Vec3d& up, const SweepOptions& options) {
  const bool closed = options.closed_path;
  const std::vector<Section> sections = sections_of(path, up, closed);
  const std::vector<double> v = shares_of_path(path, closed);
  const auto scale_at = [&](double share) { return options.scale ? options.scale(share) : 1.0; };
  Curve around = outline;
  around.push_back(outline.front());
  Curve lengths = {{0, 0}};
  for (size_t i = 1; i < around.size(); ++i)
    lengths.emplace_back(lengths.back().x + (around[i] - around[i - 1]).length(), 0);
  Mesh mesh;
  for (size_t i = 0; i < v.size(); ++i)
    for (size_t k = 0; k < around.size(); ++k)
      mesh.add(placed(sections[i % sections.size()], around[k] * scale_at(v[i])),
               {lengths[k].x / lengths.back().x, v[i]});
  const auto row = uint32_t(around.size());
  for (uint32_t i = 0; i + 1 < v.size(); ++i)
    for (uint32_t k = 0; k + 1 < row; ++k) {
      const uint32_t a = i * row + k;
      mesh.quad(a, a + row, a + row + 1, a + 1);
    }
  if (!closed) {
    add_cap(mesh, sections.front(), outline, scale_at(0), false);
    add_cap(mesh, sections.back(), outline, scale_at(1), true);
  }
  return shaded(mesh, options.crease_degrees);
}

Mesh tube(double radius, const Path& path, int segments, const SweepOptions& options) {
  const Vec3d along = (path[1] - path[0]).normalized();
  const Vec3d up = std::fabs(along.z) < 0.9 ? Vec3d(0, 0, 1) : Vec3d(0, 1, 0);
  return swept(circle(radius, segments), path, up, options);
}

Mesh frame(const Curve& outline, double width, double height) {
  const double x = 0.5 * width, z = 0.5 * height;
  SweepOptions options;
  options.closed_path = true;
  // Walked so that the right of the path is outward when up is toward the viewer.
  return swept(outline, {{-x, 0, -z}, {x, 0, -z}, {x, 0, z}, {-x, 0, z}}, {0, -1, 0}, options);
}

}  // namespace kaustik::scenes
