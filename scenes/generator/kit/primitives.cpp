#include "kit/primitives.h"

#include <stdexcept>

namespace kaustik::scenes {
namespace {

/// The six faces of a cube: normal, and the directions of u and v with u x v = normal.
constexpr int face_axes[6][2] = {{0, 1}, {0, -1}, {1, 1}, {1, -1}, {2, 1}, {2, -1}};

struct FaceFrame {
  Vec3d normal, u, v;
};

FaceFrame face_frame(int face) {
  const int axis = face_axes[face][0];
  const double sign = face_axes[face][1];
  FaceFrame f{Vec3d(0.0), Vec3d(0.0), Vec3d(0.0)};
  f.normal[axis] = sign;
  f.u[(axis + 1) % 3] = sign;
  f.v[(axis + 2) % 3] = 1;
  return f;
}

void check_profile(const Curve& profile, bool loop) {
  for (const Vec2d& p : profile)
    if (p.x < 0) throw std::invalid_argument("revolved: negative radius");
  if (!loop && (profile.size() < 2 || profile.front().x != 0 || profile.back().x != 0))
    throw std::invalid_argument("revolved: the profile must begin and end on the axis");
}

/// Length of the curve up to each point (and once around, for a loop) over the whole length.
std::vector<double> shares_of_length(const Curve& points) {
  std::vector<double> at = {0.0};
  for (size_t i = 1; i < points.size(); ++i)
    at.push_back(at.back() + (points[i] - points[i - 1]).length());
  const double whole = at.back();
  for (double& a : at) a /= whole;
  return at;
}

template <typename Point>
Point catmull_rom(const Point& a, const Point& b, const Point& c, const Point& d, double t) {
  return (b * 2.0 + (c - a) * t + (a * 2.0 - b * 5.0 + c * 4.0 - d) * (t * t) +
          (b * 3.0 - a - c * 3.0 + d) * (t * t * t)) *
         0.5;
}

template <typename Point>
std::vector<Point> smooth(const std::vector<Point>& points, int steps) {
  std::vector<Point> out;
  const size_t last = points.size() - 1;
  for (size_t i = 0; i < last; ++i) {
    const Point before = i > 0 ? points[i - 1] : points[i] * 2.0 - points[i + 1];
    const Point after = i + 2 <= last ? points[i + 2] : points[i + 1] * 2.0 - points[i];
    for (int s = 0; s < steps; ++s)
      out.push_back(catmull_rom(before, points[i], points[i + 1], after, double(s) / steps));
  }
  out.push_back(points.back());
  return out;
}

}  // namespace

Mesh box(const Vec3d& low, const Vec3d& high) {
  Mesh mesh;
  const Vec3d middle = (low + high) * 0.5, half = (high - low) * 0.5;
  for (int face = 0; face < 6; ++face) {
    const FaceFrame f = face_frame(face);
    uint32_t index[4];
    const double corners[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    for (int k = 0; k < 4; ++k) {
      const Vec3d side = f.normal + f.u * corners[k][0] + f.v * corners[k][1];
      index[k] =
          mesh.add(middle + half * side, {0.5 * (corners[k][0] + 1), 0.5 * (corners[k][1] + 1)});
      mesh.vertices.back().normal = f.normal;
    }
    mesh.quad(index[0], index[1], index[2], index[3]);
  }
  return mesh;
}

Mesh bevelled_box(const Vec3d& low, const Vec3d& high, double bevel, int steps) {
  // Along each direction of a face: from the low edge's middle to its inner end, and the high one.
  std::vector<std::pair<double, double>> places;  // side, slope of the normal
  // Both faces at an edge must find the slope 1, which tan() misses by a bit.
  const auto slope = [&](int s) { return s == steps ? 1.0 : std::tan(pi_d / 4 * s / steps); };
  for (int s = steps; s >= 0; --s) places.emplace_back(-1, -slope(s));
  for (int s = 0; s <= steps; ++s) places.emplace_back(1, slope(s));
  const Vec3d middle = (low + high) * 0.5, half = (high - low) * 0.5 - Vec3d(bevel);
  const Vec3d size = high - low;
  Mesh mesh;
  for (int face = 0; face < 6; ++face) {
    const FaceFrame f = face_frame(face);
    const auto first = uint32_t(mesh.vertices.size());
    for (const auto& [v_side, v_slope] : places)
      for (const auto& [u_side, u_slope] : places) {
        const Vec3d inner = middle + half * (f.normal + f.u * u_side + f.v * v_side);
        // Summed axis by axis, so that neighbouring faces find the same bits.
        const Vec3d slopes = f.normal + f.u * u_slope + f.v * v_slope;
        const Vec3d n = slopes / std::sqrt(1 + (u_slope * u_slope + v_slope * v_slope));
        const Vec3d p = inner + n * bevel;
        const Vec3d share = (p - low) / size;
        const double u = share.dot(Vec3d(std::fabs(f.u.x), std::fabs(f.u.y), std::fabs(f.u.z)));
        mesh.vertices.push_back(
            {p, n, {std::clamp(u, 0.0, 1.0), std::clamp(share.dot(f.v), 0.0, 1.0)}});
      }
    const auto count = uint32_t(places.size());
    for (uint32_t j = 0; j + 1 < count; ++j)
      for (uint32_t i = 0; i + 1 < count; ++i) {
        const uint32_t a = first + j * count + i;
        mesh.quad(a, a + 1, a + count + 1, a + count);
      }
  }
  return mesh;
}

Mesh revolved(const Curve& profile, int segments, bool loop, double crease_degrees) {
  check_profile(profile, loop);
  Curve points = profile;
  if (loop) points.push_back(profile.front());
  const std::vector<double> v = shares_of_length(points);
  Mesh mesh;
  for (size_t i = 0; i < points.size(); ++i)
    for (int s = 0; s <= segments; ++s) {
      const double angle = 2 * pi_d * (s % segments) / segments;
      mesh.add({points[i].x * std::cos(angle), points[i].x * std::sin(angle), points[i].y},
               {double(s) / segments, v[i]});
    }
  const auto row = uint32_t(segments + 1);
  for (uint32_t i = 0; i + 1 < points.size(); ++i)
    for (uint32_t s = 0; s < uint32_t(segments); ++s) {
      const uint32_t a = i * row + s;
      if (points[i].x > 0) mesh.triangle(a, a + 1, a + row + 1);
      if (points[i + 1].x > 0) mesh.triangle(a, a + row + 1, a + row);
    }
  return shaded(mesh, crease_degrees);
}

Mesh cylinder(double radius, double z0, double z1, int segments) {
  return revolved({{0, z0}, {radius, z0}, {radius, z1}, {0, z1}}, segments);
}

Mesh cone(double radius0, double radius1, double z0, double z1, int segments) {
  Curve profile = {{0, z0}};
  if (radius0 > 0) profile.emplace_back(radius0, z0);
  if (radius1 > 0) profile.emplace_back(radius1, z1);
  profile.emplace_back(0, z1);
  return revolved(profile, segments);
}

Mesh ball(const Vec3d& center, double radius, int segments) {
  Curve profile = {{0, -radius}};
  const int rings = std::max(2, segments / 2);
  for (int i = 1; i < rings; ++i) {
    const double angle = pi_d * i / rings;
    profile.emplace_back(radius * std::sin(angle), -radius * std::cos(angle));
  }
  profile.emplace_back(0, radius);
  return moved(revolved(profile, segments, false, 180), center);
}

Mesh torus(double radius, double tube_radius, int segments, int tube_segments) {
  Curve profile;
  for (const Vec2d& p : circle(tube_radius, tube_segments)) profile.emplace_back(radius + p.x, p.y);
  return revolved(profile, segments, true, 180);
}

Mesh crystal(double radius, double top, double bottom, int sides) {
  return revolved({{0, -bottom},
                   {0.55 * radius, -0.62 * bottom},
                   {radius, 0},
                   {0.6 * radius, 0.6 * top},
                   {0, top}},
                  sides, false, 0);
}

std::vector<Vec3d> smooth_path(const std::vector<Vec3d>& points, int steps) {
  return smooth(points, steps);
}

Curve smooth_curve(const Curve& points, int steps) { return smooth(points, steps); }

Curve circle(double radius, int segments) {
  Curve points;
  for (int i = 0; i < segments; ++i) {
    const double angle = 2 * pi_d * i / segments;
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return points;
}

Curve rectangle(double width, double height) {
  const double x = 0.5 * width, y = 0.5 * height;
  return {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
}

}  // namespace kaustik::scenes
