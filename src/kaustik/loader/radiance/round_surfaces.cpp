// Spheres, rings, cylinders and cones.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kaustik/loader/radiance/placement.h"
#include "kaustik/loader/radiance/surface_parts.h"
#include "kaustik/loader/radiance/surfaces.h"

namespace kaustik::radiance {
namespace {

/// Around circles that are cut into facets.
constexpr int facets_around = 96;

}  // namespace

void SurfaceMaker::add_sphere(const PlacedSurface& surface) {
  const Primitive& primitive = *surface.primitive;
  need_reals(primitive, 4);
  const Vec3d centre = placed_point(surface.placed, vector_at(primitive, 0));
  const double radius = primitive.reals[3] * scale_of(surface.placed);
  if (radius == 0 || !is_usable(centre) || std::fabs(radius) > 1e11 || std::fabs(radius) < 1e-11) {
    deviations_.ignored(name_of(primitive), "it has no size, and is left out", primitive.place);
    return;
  }
  std::vector<PatternPoint> samples;
  for (int i = 0; i < 6; ++i) {
    Vec3d normal(0, 0, 0);
    normal[i / 2] = i % 2 == 0 ? 1 : -1;
    samples.push_back({centre + normal * std::fabs(radius), normal});
  }
  const auto appearance =
      look_at(surface, false, samples,
              LampSurface{centre, std::numbers::pi * radius * radius, std::nullopt});
  if (!appearance) return;
  for (const PatternPoint& sample : samples) {
    extend(centre + sample.normal * std::fabs(radius), sample.normal, appearance.get());
    if (appearance->grid)  // its box is that of the sphere
      appearance->grid->extend(sample.position, sample.normal);
  }
  const ObjectPointer shape = make_object("shape", "sphere", primitive.place);
  give(*shape, "center", centre);
  give(*shape, "radius", std::fabs(radius));
  if (((primitive.type == "bubble") != (radius < 0)) != surface.is_inverted)
    give(*shape, "flip_normals", true);
  add_shape(shape, *appearance);
  if (appearance->beam)
    add_beam(*appearance->beam, centre, std::numbers::pi * radius * radius, appearance->beam->axis,
             primitive.place);
}

void SurfaceMaker::add_ring(const PlacedSurface& surface) {
  const Primitive& primitive = *surface.primitive;
  need_reals(primitive, 8);
  const Vec3d centre = placed_point(surface.placed, vector_at(primitive, 0));
  Vec3d normal = placed_vector(surface.placed, vector_at(primitive, 3));
  const double scale = scale_of(surface.placed);
  const double a = std::fabs(primitive.reals[6]) * scale, b = std::fabs(primitive.reals[7]) * scale;
  const double inner = std::min(a, b), outer = std::max(a, b);
  if (!(normal.length() > 0) || !(outer > inner) || outer > 1e11 || outer < 1e-11 ||
      !is_usable(centre)) {
    deviations_.ignored(name_of(primitive), "it has no area, and is left out", primitive.place);
    return;
  }
  normal = normal.normalized() * (surface.is_inverted ? -1.0 : 1.0);
  const auto [u, v] = across(normal);
  if (inner > 0) {
    PlacedSurface turned = surface;
    turned.is_inverted = false;
    return add_band(turned, centre, centre, normal, inner, outer, false);
  }
  const std::vector<PatternPoint> samples = {{centre, normal},
                                             {centre + u * (0.7 * outer), normal},
                                             {centre - u * (0.7 * outer), normal},
                                             {centre + v * (0.7 * outer), normal},
                                             {centre - v * (0.7 * outer), normal}};
  const auto appearance = look_at(surface, false, samples,
                                  LampSurface{centre, std::numbers::pi * outer * outer, normal});
  if (!appearance) return;
  for (const int sign : {1, -1}) {
    extend(centre + (u + v) * (sign * outer), normal, appearance.get());
    extend(centre + (u - v) * (sign * outer), normal, appearance.get());
  }
  const double rows[4][4] = {{u.x * outer, v.x * outer, normal.x * outer, centre.x},
                             {u.y * outer, v.y * outer, normal.y * outer, centre.y},
                             {u.z * outer, v.z * outer, normal.z * outer, centre.z},
                             {0, 0, 0, 1}};
  const ObjectPointer shape = make_object("shape", "disk", primitive.place);
  give(*shape, "to_world", Transform(rows));
  add_shape(shape, *appearance);
  if (appearance->beam)
    add_beam(*appearance->beam, centre, std::numbers::pi * outer * outer, normal, primitive.place);
}

void SurfaceMaker::add_cylinder(const PlacedSurface& surface) {
  const Primitive& primitive = *surface.primitive;
  need_reals(primitive, 7);
  const Vec3d from = placed_point(surface.placed, vector_at(primitive, 0));
  const Vec3d to = placed_point(surface.placed, vector_at(primitive, 3));
  const double radius = primitive.reals[6] * scale_of(surface.placed);
  if (!((to - from).length() > 1e-11) || std::fabs(radius) < 1e-11 || std::fabs(radius) > 1e11 ||
      !is_usable(from) || !is_usable(to)) {
    deviations_.ignored(name_of(primitive), "it has no area, and is left out", primitive.place);
    return;
  }
  const auto [u, v] = across((to - from).normalized());
  std::vector<PatternPoint> samples;
  for (const Vec3d& normal : {u, v, -u, -v})
    for (const double along : {0.2, 0.8})
      samples.push_back({from + (to - from) * along + normal * std::fabs(radius), normal});
  const auto appearance = look_at(surface, false, samples);
  if (!appearance) return;
  for (const Vec3d& end : {from, to})
    for (int axis = 0; axis < 3; ++axis)
      for (const int sign : {1, -1}) {
        Vec3d normal(0, 0, 0);
        normal[axis] = sign;
        extend(end + normal * std::fabs(radius), normal, appearance.get());
      }
  const ObjectPointer shape = make_object("shape", "cylinder", primitive.place);
  give(*shape, "p0", from);
  give(*shape, "p1", to);
  give(*shape, "radius", std::fabs(radius));
  if (((primitive.type == "tube") != (radius < 0)) != surface.is_inverted)
    give(*shape, "flip_normals", true);
  add_shape(shape, *appearance);
}

void SurfaceMaker::add_cone(const PlacedSurface& surface) {
  const Primitive& primitive = *surface.primitive;
  need_reals(primitive, 8);
  const Vec3d from = placed_point(surface.placed, vector_at(primitive, 0));
  const Vec3d to = placed_point(surface.placed, vector_at(primitive, 3));
  const double scale = scale_of(surface.placed);
  const double a = primitive.reals[6] * scale, b = primitive.reals[7] * scale;
  if (!((to - from).length() > 1e-11) || std::max(std::fabs(a), std::fabs(b)) < 1e-11 ||
      std::max(std::fabs(a), std::fabs(b)) > 1e11 || !is_usable(from) || !is_usable(to)) {
    deviations_.ignored(name_of(primitive), "it has no area, and is left out", primitive.place);
    return;
  }
  PlacedSurface turned = surface;
  turned.is_inverted = ((primitive.type == "cup") != (a < 0 || b < 0)) != surface.is_inverted;
  add_band(turned, from, to, (to - from).normalized(), std::fabs(a), std::fabs(b), true);
}

void SurfaceMaker::add_band(const PlacedSurface& surface, const Vec3d& from, const Vec3d& to,
                            const Vec3d& axis, double from_radius, double to_radius,
                            bool is_smooth) {
  const Primitive& primitive = *surface.primitive;
  const std::pair<Vec3d, Vec3d> sides = across(axis);
  const double length = (to - from).length(), slope = from_radius - to_radius;
  const double side = surface.is_inverted ? -1 : 1;
  const auto outward_at = [&](double phi) {
    return sides.first * std::cos(phi) + sides.second * std::sin(phi);
  };
  // Of a cone: across its side. Of a ring: its axis.
  const auto normal_at = [&](double phi) {
    return is_smooth ? (outward_at(phi) * length + axis * slope).normalized() * side : axis;
  };
  std::vector<PatternPoint> samples;
  for (int i = 0; i < 4; ++i) {
    const double phi = i * std::numbers::pi / 2;
    samples.push_back(
        {(from + to) * 0.5 + outward_at(phi) * (0.5 * (from_radius + to_radius)), normal_at(phi)});
  }
  const auto appearance = look_at(surface, false, samples);
  if (!appearance) return;
  deviations_.approximated(is_smooth ? "cones" : "rings",
                           fmt::format("they are cut into {} facets{}", facets_around,
                                       is_smooth ? " with smooth normals" : " of the same area"),
                           primitive.place);
  Mesh own;
  const bool is_lamp = appearance->emitter != nullptr || appearance->beam.has_value();
  if (is_lamp) {
    own.appearance = appearance;
    own.place = primitive.place;
  }
  Mesh& mesh = is_lamp ? own : mesh_of(surface, appearance, is_smooth, false);
  const auto first = uint32_t(mesh.positions.size() / 3);
  // Corners lie as far out as makes up for the area that chords cut off.
  const double step = 2 * std::numbers::pi / facets_around;
  const double wider = std::sqrt(step / std::sin(step));
  for (int i = 0; i < facets_around; ++i) {
    const double phi = step * i;
    for (const bool is_far : {false, true}) {
      const Vec3d p =
          (is_far ? to : from) + outward_at(phi) * (wider * (is_far ? to_radius : from_radius));
      extend(p, normal_at(phi), appearance.get());
      for (int axis_of = 0; axis_of < 3; ++axis_of) mesh.positions.push_back(float(p[axis_of]));
      if (!is_smooth) continue;
      const Vec3d normal = normal_at(phi);
      for (int axis_of = 0; axis_of < 3; ++axis_of) mesh.normals.push_back(float(normal[axis_of]));
    }
  }
  // Seen from outside a, b, c run anticlockwise; of a ring that is from above, for its second
  // circle is the wider one.
  const auto add_triangle = [&](uint32_t a, uint32_t b, uint32_t c) {
    if (surface.is_inverted) std::swap(b, c);
    for (const uint32_t corner : {a, b, c}) mesh.faces.push_back(first + corner);
  };
  for (uint32_t i = 0; i < facets_around; ++i) {
    const uint32_t a = 2 * i, b = 2 * ((i + 1) % facets_around);
    if (is_smooth) {
      if (from_radius > 0) add_triangle(a, b, a + 1);
      if (to_radius > 0) add_triangle(b, b + 1, a + 1);
    } else {
      add_triangle(a, a + 1, b);
      add_triangle(b, a + 1, b + 1);
    }
  }
  if (is_lamp) add_mesh(own);
}

}  // namespace kaustik::radiance
