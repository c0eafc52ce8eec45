// Spheres, cylinders and disks; parts of them as meshes. Their front stays the front where they are
// mirrored: so pbrt samples them as lamps (its intersections say the opposite of that).

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "kaustik/loader/pbrt/shapes.h"

namespace kaustik::pbrt {
namespace {

constexpr double full_turn = 2 * std::numbers::pi;

double radius_of(const ShapeTools& tools) {
  const double radius = tools.list.number("radius", 1);
  if (radius > 0) return radius;
  throw Error(ErrorKind::input, "the radius is not above zero", "give one above zero",
              tools.list.place_of("radius"));
}

}  // namespace

double turn_of(const ShapeTools& tools) {
  return std::clamp(tools.list.number("phimax", 360), 0.01, 360.0) / 360 * full_turn;
}

int steps_for(double turn) {
  return std::clamp(int(std::ceil(steps_around * turn / full_turn)), 3, steps_around);
}

void append_cells(std::vector<int32_t>& faces, int32_t first, int32_t across, int32_t up) {
  for (int32_t j = 0; j < up; ++j)
    for (int32_t i = 0; i < across; ++i) {
      const int32_t a = first + j * (across + 1) + i, b = a + 1, c = a + across + 2, d = c - 1;
      faces.insert(faces.end(), {a, b, c, a, c, d});
    }
}

std::shared_ptr<Object> meshed(const ShapeTools& tools, const SurfacePart& part) {
  MeshParts mesh;
  for (int j = 0; j <= part.along_v; ++j)
    for (int i = 0; i <= part.along_u; ++i) {
      const double u = double(i) / part.along_u, v = double(j) / part.along_v;
      append(mesh.positions, part.point(u, v));
      append(mesh.normals, part.normal(u, v));
      mesh.uv.insert(mesh.uv.end(), {float(u), float(v)});
    }
  append_cells(mesh.faces, 0, part.along_u, part.along_v);
  tools.files.spend(mesh.bytes(), tools.place());
  return placed(shape_of(std::move(mesh), tools.place()), tools);
}

std::shared_ptr<Object> make_sphere(const ShapeTools& tools) {
  const double radius = radius_of(tools), turn = turn_of(tools);
  double low = tools.list.number("zmin", -radius), high = tools.list.number("zmax", radius);
  if (low > high) std::swap(low, high);
  low = std::clamp(low, -radius, radius);
  high = std::clamp(high, -radius, radius);
  if (turn == full_turn && low == -radius && high == radius) {
    auto sphere = described("shape", "sphere", tools.place());
    if (radius != 1) set(*sphere, "radius", radius);
    // v is 1 at +z here, and 0 in Kaustik's own sphere.
    if (tools.is_textured) set(*sphere, "to_world", Transform::scale({1, 1, -1}));
    return placed(sphere, tools);
  }
  const double theta_low = std::acos(low / radius), theta_high = std::acos(high / radius);
  const auto unit = [=](double u, double v) {
    const double phi = turn * u, theta = theta_low + v * (theta_high - theta_low);
    return Vec3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
  };
  return meshed(tools, {[=](double u, double v) { return unit(u, v) * radius; }, unit,
                        steps_for(turn), steps_along});
}

std::shared_ptr<Object> make_cylinder(const ShapeTools& tools) {
  const double radius = radius_of(tools), turn = turn_of(tools);
  double low = tools.list.number("zmin", -1), high = tools.list.number("zmax", 1);
  if (low > high) std::swap(low, high);
  if (!(high > low))
    throw Error(ErrorKind::input, "the cylinder has no length", "let zmax lie above zmin",
                tools.list.place_of("zmax"));
  if (turn == full_turn) {
    auto cylinder = described("shape", "cylinder", tools.place());
    set(*cylinder, "radius", radius);
    set(*cylinder, "p0", Vec3d(0, 0, low));
    set(*cylinder, "p1", Vec3d(0, 0, high));
    return placed(cylinder, tools);
  }
  const auto unit = [=](double u, double) {
    return Vec3d(std::cos(turn * u), std::sin(turn * u), 0);
  };
  return meshed(tools, {[=](double u, double v) {
                          return unit(u, v) * radius + Vec3d(0, 0, low + v * (high - low));
                        },
                        unit, steps_for(turn), 1});
}

std::shared_ptr<Object> make_disk(const ShapeTools& tools) {
  const double radius = radius_of(tools), turn = turn_of(tools);
  const double inner = std::clamp(tools.list.number("innerradius", 0), 0.0, radius);
  const double height = tools.list.number("height", 0);
  if (turn == full_turn && inner == 0 && !tools.is_textured) {
    auto disk = described("shape", "disk", tools.place());
    set(*disk, "to_world",
        Transform::translate({0, 0, height}) * Transform::scale({radius, radius, 1}));
    return placed(disk, tools);
  }
  // v is 0 at the rim.
  return meshed(tools, {[=](double u, double v) {
                          const double r = radius + v * (inner - radius);
                          return Vec3d(r * std::cos(turn * u), r * std::sin(turn * u), height);
                        },
                        [](double, double) { return Vec3d(0, 0, 1); }, steps_for(turn), 1});
}

}  // namespace kaustik::pbrt
