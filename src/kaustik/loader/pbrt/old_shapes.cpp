// Shapes of pbrt-v3 that v4 has no more, as meshes: cone, paraboloid, hyperboloid, heightfield.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "kaustik/loader/pbrt/shapes.h"

namespace kaustik::pbrt {
namespace {

double length_above_zero(const ShapeTools& tools, const char* name) {
  const double length = tools.list.number(name, 1);
  if (length > 0) return length;
  throw Error(ErrorKind::input, fmt::format("'{}' is not above zero", name),
              "give a number above zero", tools.list.place_of(name));
}

Vec3d turned(const Vec3d& p, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
}

}  // namespace

std::shared_ptr<Object> make_cone(const ShapeTools& tools) {
  const double radius = length_above_zero(tools, "radius");
  const double height = length_above_zero(tools, "height"), turn = turn_of(tools);
  const Vec3d normal = Vec3d(height, 0, radius).normalized();
  return meshed(tools,
                {[=](double u, double v) {
                   return turned({radius * (1 - v), 0, height * v}, turn * u);
                 },
                 [=](double u, double) { return turned(normal, turn * u); }, steps_for(turn), 1});
}

std::shared_ptr<Object> make_paraboloid(const ShapeTools& tools) {
  const double radius = length_above_zero(tools, "radius"), turn = turn_of(tools);
  const double end = length_above_zero(tools, "zmax");
  const double start = std::clamp(tools.list.number("zmin", 0), 0.0, end);
  const auto z = [=](double v) { return start + v * (end - start); };
  return meshed(tools, {[=](double u, double v) {
                          return turned({radius * std::sqrt(z(v) / end), 0, z(v)}, turn * u);
                        },
                        // Of z = zmax (r / radius)²: dz/dr = 2 zmax r / radius².
                        [=](double u, double v) {
                          const double slope = 2 * std::sqrt(z(v) * end) / radius;
                          return turned(Vec3d(slope, 0, -1).normalized(), turn * u);
                        },
                        steps_for(turn), steps_along});
}

std::shared_ptr<Object> make_hyperboloid(const ShapeTools& tools) {
  const Vec3d from = tools.list.point("p1").value_or(Vec3d(0, 0, 0));
  const Vec3d to = tools.list.point("p2").value_or(Vec3d(1, 1, 1));
  const double turn = turn_of(tools);
  const auto on_line = [=](double v) { return from + (to - from) * v; };
  return meshed(tools, {[=](double u, double v) { return turned(on_line(v), turn * u); },
                        [=](double u, double v) {
                          const Vec3d p = on_line(v);
                          const Vec3d n = Vec3d(-p.y, p.x, 0).cross(to - from);
                          const Vec3d unit = n.length() > 0 ? n.normalized() : Vec3d(0, 0, 1);
                          return turned(unit, turn * u);
                        },
                        steps_for(turn), steps_along});
}

std::shared_ptr<Object> make_heightfield(const ShapeTools& tools) {
  const Parameter* heights = tools.list.find("Pz", {"float"});
  const int columns = tools.list.integer("nu", 0), rows = tools.list.integer("nv", 0);
  const size_t count = heights ? heights->number_count() : 0;
  if (columns < 2 || rows < 2 || size_t(columns) * size_t(rows) != count)
    throw Error(ErrorKind::input,
                fmt::format("a field of {} × {} has {} heights", columns, rows, count),
                "give at least 2 × 2, nu times nv numbers in 'Pz'", tools.list.place_of("Pz"));
  MeshParts mesh;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const double u = double(i) / (columns - 1), v = double(j) / (rows - 1);
      append(mesh.positions, {u, v, heights->numbers[size_t(j) * size_t(columns) + size_t(i)]});
      mesh.uv.insert(mesh.uv.end(), {float(u), float(v)});
    }
  append_cells(mesh.faces, 0, columns - 1, rows - 1);
  tools.files.spend(mesh.bytes(), tools.place());
  return placed(shape_of(std::move(mesh), tools.place()), tools);
}

}  // namespace kaustik::pbrt
