#include "kaustik/photon/coverage/disk_kernel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace kaustik {
namespace {

/// What edges leave less than this of, over the squared radius, is nothing: three lines through the
/// center may leave nothing at all.
constexpr double least_left = 1e-9;

/// ∫ shape(r) rⁿ⁺¹ dr over the radius, n = 0, 1, 2.
struct RadialMoments {
  double zeroth, first, second;
};
RadialMoments radial_moments(KernelShape shape) {
  if (shape == KernelShape::flat) return {1.0 / 2, 1.0 / 3, 1.0 / 4};
  return {1.0 / 4, 2.0 / 15, 1.0 / 12};
}

/// Of the disk between two angles.
void add_sector(double from, double to, KernelShape shape, DiskMoments& sum) {
  const RadialMoments radial = radial_moments(shape);
  const double half = (to - from) / 2, turned = (std::sin(2 * to) - std::sin(2 * from)) / 4;
  sum.one += radial.zeroth * (to - from);
  sum.x += radial.first * (std::sin(to) - std::sin(from));
  sum.y += radial.first * (std::cos(from) - std::cos(to));
  sum.xx += radial.second * (half + turned);
  sum.yy += radial.second * (half - turned);
  sum.xy += radial.second * (sqr(std::sin(to)) - sqr(std::sin(from))) / 2;
}

struct Point {
  double x, y;
};

/// Of the triangle between the center and two points, from the first to the second: all is of the
/// fourth degree, for which six points are exact (Dunavant 1985).
void add_triangle(const Point& p, const Point& q, KernelShape shape, DiskMoments& sum) {
  struct Rule {
    double weight, near, far;
  };
  constexpr Rule rules[2] = {{0.223381589678011, 0.108103018168070, 0.445948490915965},
                             {0.109951743655322, 0.816847572980459, 0.091576213509771}};
  const double area = (p.x * q.y - p.y * q.x) / 2;
  const auto add = [&](double weight, double of_p, double of_q) {
    const double x = of_p * p.x + of_q * q.x, y = of_p * p.y + of_q * q.y;
    const double value = weight * area * (shape == KernelShape::flat ? 1 : 1 - x * x - y * y);
    sum.one += value;
    sum.x += value * x;
    sum.y += value * y;
    sum.xx += value * x * x;
    sum.xy += value * x * y;
    sum.yy += value * y * y;
  };
  for (const Rule& rule : rules) {
    add(rule.weight, rule.near, rule.far);
    add(rule.weight, rule.far, rule.near);
    add(rule.weight, rule.far, rule.far);
  }
}

/// A line that cuts the unit disk: the angle of its nearest point, and how near.
struct Line {
  double angle, distance;

  /// How far it lies from the center in the direction `at`; infinite: nowhere.
  double reach(double at) const {
    const double cosine = std::cos(at - angle);
    return cosine > 0 ? distance / cosine : std::numeric_limits<double>::infinity();
  }
};

/// The angles between which one line, or the circle, bounds what is left of the disk.
class Corners {
 public:
  void add(double angle) { angles_[count_++] = angle - two_pi * std::floor(angle / two_pi); }
  /// visit(from, to) between each and the next.
  template <typename Visit>
  void each(const Visit& visit) {
    std::sort(angles_.begin(), angles_.begin() + std::ptrdiff_t(count_));
    for (size_t i = 0; i < count_; ++i)
      visit(angles_[i], i + 1 < count_ ? angles_[i + 1] : angles_[0] + two_pi);
  }

 private:
  static constexpr double two_pi = 2 * std::numbers::pi;
  static constexpr size_t most = 2 * DiskEdges::most + DiskEdges::most * (DiskEdges::most - 1) / 2;
  std::array<double, most> angles_{};
  size_t count_ = 0;
};

}  // namespace

DiskMoments disk_moments(const Frame& frame, float radius, const DiskEdges& edges,
                         KernelShape shape) {
  std::array<Line, DiskEdges::most> lines{};
  size_t count = 0;
  Corners corners;
  for (size_t i = 0; i < edges.count; ++i) {
    const DiskEdges::Edge& edge = edges.edges[i];
    if (!(edge.distance < radius)) continue;
    const Line line{double(std::atan2(-dot(edge.inward, frame.y), -dot(edge.inward, frame.x))),
                    double(edge.distance) / double(radius)};
    const double half = std::acos(line.distance);
    corners.add(line.angle - half);
    corners.add(line.angle + half);
    for (size_t other = 0; other < count; ++other) {
      // Where both meet.
      const Line& l = lines[other];
      const double sine = std::sin(line.angle - l.angle);
      if (sine == 0) continue;
      const Point meeting{
          (l.distance * std::sin(line.angle) - line.distance * std::sin(l.angle)) / sine,
          (line.distance * std::cos(l.angle) - l.distance * std::cos(line.angle)) / sine};
      if (sqr(meeting.x) + sqr(meeting.y) < 1) corners.add(std::atan2(meeting.y, meeting.x));
    }
    lines[count++] = line;
  }
  DiskMoments result;
  if (count == 0) {
    add_sector(0, 2 * std::numbers::pi, shape, result);
    return result;
  }
  corners.each([&](double from, double to) {
    const double middle = (from + to) / 2;
    const Line* nearest = nullptr;
    for (size_t i = 0; i < count; ++i)
      if (lines[i].reach(middle) < (nearest ? nearest->reach(middle) : 1)) nearest = &lines[i];
    if (!nearest) {
      add_sector(from, to, shape, result);
      return;
    }
    const auto end = [&](double at) {
      const double reach = std::min(1.0, nearest->reach(at));
      return Point{reach * std::cos(at), reach * std::sin(at)};
    };
    add_triangle(end(from), end(to), shape, result);
  });
  return result;
}

DiskKernel::DiskKernel(const Frame& frame, float radius, const DiskEdges& edges,
                       KernelShape shape) {
  const DiskMoments m = disk_moments(frame, radius, edges, shape);
  if (!(m.one > least_left)) return;
  even_scale_ = scale = float(1 / (m.one * double(radius) * double(radius)));
  if (!edges.cut(radius)) return;
  // a + b · p with ∫ (a + b · p) = 1 and ∫ p (a + b · p) = 0.
  const double determinant = m.xx * m.yy - m.xy * m.xy;
  if (!(determinant > 0)) return;
  const double bx = -(m.yy * m.x - m.xy * m.y) / determinant;
  const double by = -(m.xx * m.y - m.xy * m.x) / determinant;
  scale = float(1 / ((m.one + bx * m.x + by * m.y) * double(radius) * double(radius)));
  slope = (frame.x * float(bx) + frame.y * float(by)) * (1 / radius);
}

void DiskKernel::level() {
  scale = even_scale_;
  slope = {0, 0, 0};
}

}  // namespace kaustik
