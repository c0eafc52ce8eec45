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

/// ∫ (1 − u²)ⁿ⸍² du from `distance` to 1, n = 1, 3, 5: of the disk's segment beyond a line.
struct SegmentIntegrals {
  double first, third, fifth;
};
SegmentIntegrals segment_integrals(double distance) {
  const double sine_sq = 1 - distance * distance;
  const double angle = std::acos(distance), product = distance * std::sqrt(sine_sq);
  return {(angle - product) / 2, (3 * angle - product * (3 + 2 * sine_sq)) / 8,
          (15 * angle - product * (15 + sine_sq * (10 + 8 * sine_sq))) / 48};
}

/// Takes the segment beyond a line off: `x`, `y` point at it.
void take_segment(double x, double y, double distance, KernelShape shape, DiskMoments& sum) {
  const SegmentIntegrals of = segment_integrals(distance);
  const double sine_sq = 1 - distance * distance, cube = sine_sq * std::sqrt(sine_sq);
  // One, u, u², v², where u runs across the line and v along it.
  double one = 2 * of.first, u = cube * 2 / 3, uu = 2 * (of.first - of.third),
         vv = of.third * 2 / 3;
  if (shape == KernelShape::parabolic) {
    one = of.third * 4 / 3;
    u = cube * sine_sq * 4 / 15;
    uu = (of.third - of.fifth) * 4 / 3;
    vv = of.fifth * 4 / 15;
  }
  sum.one -= one;
  sum.x -= u * x;
  sum.y -= u * y;
  sum.xx -= uu * x * x + vv * y * y;
  sum.yy -= uu * y * y + vv * x * x;
  sum.xy -= (uu - vv) * x * y;
}

void add_disk(KernelShape shape, DiskMoments& sum) {
  const RadialMoments radial = radial_moments(shape);
  sum.one += radial.zeroth * 2 * std::numbers::pi;
  sum.xx += radial.second * std::numbers::pi;
  sum.yy += radial.second * std::numbers::pi;
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

/// A line that cuts the unit disk: the direction of its nearest point, and how near.
struct Line {
  double x, y, distance;
  double angle = 0;  ///< of the direction; only for corners

  /// Whether nothing of the disk lies beyond both.
  bool is_apart_from(const Line& other) const {
    return x * other.x + y * other.y <=
           distance * other.distance -
               std::sqrt((1 - distance * distance) * (1 - other.distance * other.distance));
  }
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

/// The lines that cut a disk.
struct Lines {
  std::array<Line, DiskEdges::most> lines{};
  size_t count = 0;

  Lines(const Frame& frame, float radius, const DiskEdges& edges) {
    for (size_t i = 0; i < edges.count; ++i) {
      const DiskEdges::Edge& edge = edges.edges[i];
      if (edge.distance < radius)
        lines[count++] = {-double(dot(edge.inward, frame.x)), -double(dot(edge.inward, frame.y)),
                          double(edge.distance) / double(radius)};
    }
  }
  bool are_apart() const {
    for (size_t i = 1; i < count; ++i)
      for (size_t j = 0; j < i; ++j)
        if (!lines[i].is_apart_from(lines[j])) return false;
    return true;
  }
};

/// Of the disk without the segments beyond lines that are apart.
DiskMoments moments_without_segments(const Lines& of, KernelShape shape) {
  DiskMoments result;
  add_disk(shape, result);
  for (size_t i = 0; i < of.count; ++i)
    take_segment(of.lines[i].x, of.lines[i].y, of.lines[i].distance, shape, result);
  return result;
}

/// Whatever lies beyond several lines: sector by sector.
DiskMoments moments_by_sectors(Lines of, KernelShape shape) {
  Corners corners;
  for (size_t i = 0; i < of.count; ++i) {
    Line& line = of.lines[i];
    line.angle = std::atan2(line.y, line.x);
    const double half = std::acos(line.distance);
    corners.add(line.angle - half);
    corners.add(line.angle + half);
    for (size_t other = 0; other < i; ++other) {
      // Where both meet.
      const Line& l = of.lines[other];
      const double sine = l.x * line.y - l.y * line.x;
      if (sine == 0) continue;
      const Point meeting{(l.distance * line.y - line.distance * l.y) / sine,
                          (line.distance * l.x - l.distance * line.x) / sine};
      if (sqr(meeting.x) + sqr(meeting.y) < 1) corners.add(std::atan2(meeting.y, meeting.x));
    }
  }
  DiskMoments result;
  corners.each([&](double from, double to) {
    const double middle = (from + to) / 2;
    const Line* nearest = nullptr;
    for (size_t i = 0; i < of.count; ++i)
      if (of.lines[i].reach(middle) < (nearest ? nearest->reach(middle) : 1))
        nearest = &of.lines[i];
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

}  // namespace

DiskMoments disk_moments(const Frame& frame, float radius, const DiskEdges& edges,
                         KernelShape shape) {
  const Lines lines(frame, radius, edges);
  return lines.are_apart() ? moments_without_segments(lines, shape)
                           : moments_by_sectors(lines, shape);
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
