// Curves as tubes and ribbons.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "kaustik/loader/pbrt/shapes.h"

namespace kaustik::pbrt {
namespace {

constexpr int steps_of_segment = 6, sides_of_tube = 5;

/// A curve of segments, each of degree + 1 control points.
struct Spline {
  std::vector<Vec3d> points;
  size_t degree = 3;
  bool is_bspline = false;

  size_t segments() const {
    return is_bspline ? points.size() - degree : (points.size() - 1) / degree;
  }
  Vec3d at(size_t segment, double t) const;
};

/// By repeated interpolation: de Casteljau's of Bézier segments, de Boor's of uniform B-splines.
Vec3d Spline::at(size_t segment, double t) const {
  const size_t first = is_bspline ? segment : segment * degree;
  Vec3d p[4];
  for (size_t i = 0; i <= degree; ++i) p[i] = points[first + i];
  for (size_t level = 1; level <= degree; ++level)
    for (size_t i = 0; i + level <= degree; ++i) {
      // Of knots, which lie a unit apart.
      const double span = double(degree - level + 1);
      const double share = is_bspline ? (t + double(degree - level - i)) / span : t;
      p[i] = p[i] * (1 - share) + p[i + 1] * share;
    }
  return p[0];
}

Spline spline_of(const ShapeTools& tools) {
  const ParameterList& list = tools.list;
  Spline spline;
  spline.degree = list.integer("degree", 3) == 2 ? 2 : 3;
  spline.is_bspline = list.text("basis", "bezier") == "bspline";
  const auto numbers = vertices_of(list);
  for (size_t i = 0; i + 2 < numbers->size(); i += 3)
    spline.points.emplace_back((*numbers)[i], (*numbers)[i + 1], (*numbers)[i + 2]);
  const size_t count = spline.points.size(), d = spline.degree;
  if (count < d + 1 || (!spline.is_bspline && (count - 1) % d != 0))
    throw Error(ErrorKind::input, fmt::format("{} points are no curve of degree {}", count, d),
                spline.is_bspline ? fmt::format("give at least {}", d + 1)
                                  : fmt::format("give {} times the segments, and one", d),
                list.place_of("P"));
  return spline;
}

/// Points along the curve in the world, with directions and radii.
struct Station {
  Vec3d point, along;
  double radius = 0, v = 0;
};

std::vector<Station> stations_of(const ShapeTools& tools, const Spline& spline) {
  const double width = tools.list.number("width", 1);
  const double width0 = tools.list.number("width0", width);
  const double width1 = tools.list.number("width1", width);
  // Widths are scaled as volumes are.
  const double scale = std::cbrt(std::fabs(tools.to_world.determinant3()));
  const size_t steps = spline.segments() * steps_of_segment;
  std::vector<Station> stations;
  for (size_t i = 0; i <= steps; ++i) {
    const size_t segment = std::min(i / steps_of_segment, spline.segments() - 1);
    const double t = double(i - segment * steps_of_segment) / steps_of_segment;
    Station station;
    station.point = Vec3d(tools.to_world.point(Vec3f(spline.at(segment, t))));
    station.v = double(i) / double(steps);
    station.radius = 0.5 * scale * (width0 + station.v * (width1 - width0));
    stations.push_back(station);
  }
  for (size_t i = 0; i < stations.size(); ++i) {
    const Vec3d way =
        stations[std::min(i + 1, stations.size() - 1)].point - stations[i == 0 ? 0 : i - 1].point;
    const double size = way.length();
    stations[i].along = size > 0 ? way / size : i > 0 ? stations[i - 1].along : Vec3d(0, 0, 1);
  }
  return stations;
}

void put(std::vector<float>& numbers, const Vec3d& v) {
  numbers.insert(numbers.end(), {float(v.x), float(v.y), float(v.z)});
}

Vec3d across(const Vec3d& unit) {
  const Vec3d other = std::fabs(unit.x) > 0.5 ? Vec3d(0, 1, 0) : Vec3d(1, 0, 0);
  return unit.cross(other).normalized();
}

void add_tube(const std::vector<Station>& stations, MeshParts& mesh) {
  const auto first = int32_t(mesh.positions.size() / 3);
  Vec3d x = across(stations.front().along);
  for (const Station& station : stations) {
    // Carried along without twist.
    x = x - station.along * x.dot(station.along);
    x = x.length() > 1e-9 ? x.normalized() : across(station.along);
    const Vec3d y = station.along.cross(x);
    for (int side = 0; side <= sides_of_tube; ++side) {
      const double u = double(side) / sides_of_tube, angle = 2 * std::numbers::pi * u;
      const Vec3d normal = x * std::cos(angle) + y * std::sin(angle);
      put(mesh.positions, station.point + normal * station.radius);
      put(mesh.normals, normal);
      mesh.uv.insert(mesh.uv.end(), {float(u), float(station.v)});
    }
  }
  constexpr int32_t row = sides_of_tube + 1;
  for (int32_t i = 0; i + 1 < int32_t(stations.size()); ++i)
    for (int32_t side = 0; side < sides_of_tube; ++side) {
      const int32_t a = first + i * row + side, b = a + 1, c = b + row, d = a + row;
      mesh.faces.insert(mesh.faces.end(), {a, b, c, a, c, d});
    }
}

/// A strip that faces along normals, which turn from the first to the last.
void add_ribbon(const std::vector<Station>& stations, const std::vector<Vec3d>& normals,
                MeshParts& mesh) {
  const auto first = int32_t(mesh.positions.size() / 3);
  for (const Station& station : stations) {
    const double at = station.v * double(normals.size() - 1);
    const size_t index = std::min(size_t(at), normals.size() - 2);
    const double share = at - double(index);
    const Vec3d facing = normals[index] * (1 - share) + normals[index + 1] * share;
    Vec3d side = station.along.cross(facing);
    side = side.length() > 1e-9 ? side.normalized() : across(station.along);
    const Vec3d normal = side.cross(station.along).normalized();
    for (const double u : {0.0, 1.0}) {
      put(mesh.positions, station.point + side * (station.radius * (2 * u - 1)));
      put(mesh.normals, normal);
      mesh.uv.insert(mesh.uv.end(), {float(u), float(station.v)});
    }
  }
  for (int32_t i = 0; i + 1 < int32_t(stations.size()); ++i) {
    const int32_t a = first + 2 * i;
    mesh.faces.insert(mesh.faces.end(), {a, a + 1, a + 3, a, a + 3, a + 2});
  }
}

std::vector<Vec3d> normals_of(const ShapeTools& tools) {
  const std::vector<double> numbers = tools.list.numbers("N");
  std::vector<Vec3d> normals;
  for (size_t i = 0; i + 2 < numbers.size(); i += 3)
    normals.emplace_back(
        tools.to_world.normal({float(numbers[i]), float(numbers[i + 1]), float(numbers[i + 2])}));
  return normals;
}

}  // namespace

void add_curve(const ShapeTools& tools, MeshParts& mesh) {
  const Spline spline = spline_of(tools);
  const std::string type = tools.list.text("type", "flat");
  tools.list.accept({"splitdepth"});
  const std::vector<Vec3d> normals = normals_of(tools);
  const size_t before = mesh.bytes();
  const std::vector<Station> stations = stations_of(tools, spline);
  if (type == "ribbon" && normals.size() >= 2) {
    add_ribbon(stations, normals, mesh);
    tools.deviations.approximated("curves", "ribbons are strips of flat faces", tools.place());
  } else {
    add_tube(stations, mesh);
    tools.deviations.approximated(
        "curves", fmt::format("they are tubes of {} flat sides", sides_of_tube), tools.place());
  }
  tools.files.spend(mesh.bytes() - before, tools.place());
}

}  // namespace kaustik::pbrt
