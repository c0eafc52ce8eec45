#include "kaustik/loader/radiance/surfaces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kaustik/base/array.h"
#include "kaustik/base/error.h"
#include "kaustik/base/polygon_cutter.h"
#include "kaustik/loader/radiance/placement.h"
#include "kaustik/loader/radiance/smooth_facets.h"
#include "kaustik/loader/radiance/surface_parts.h"
#include "kaustik/loader/radiance/texture_coordinates.h"

namespace kaustik::radiance {
namespace {

Vec3d mean_of(const std::vector<Vec3d>& corners) {
  Vec3d sum(0, 0, 0);
  for (const Vec3d& corner : corners) sum += corner;
  return sum * (1.0 / double(corners.size()));
}

/// Takes them.
std::shared_ptr<const Array> floats_of(std::vector<float>& values, size_t columns) {
  const size_t rows = values.size() / columns;
  return Array::of<float>({rows, columns}, std::move(values));
}

/// Each asks its pattern at some thousand directions.
constexpr int most_luminaires = 1000;

}  // namespace

void SurfaceMaker::add(const PlacedSurface& surface) {
  const Primitive& primitive = *surface.primitive;
  const std::string& type = primitive.type;
  if (type == "polygon") return add_polygon(surface);
  if (type == "sphere" || type == "bubble") return add_sphere(surface);
  if (type == "ring") return add_ring(surface);
  if (type == "cylinder" || type == "tube") return add_cylinder(surface);
  if (type == "cone" || type == "cup") return add_cone(surface);
}

std::shared_ptr<const Appearance> SurfaceMaker::look_at(const PlacedSurface& surface, bool is_mesh,
                                                        const std::vector<PatternPoint>& samples,
                                                        const std::optional<LampSurface>& lamp) {
  if (!surface.modifier) {
    deviations_.ignored(name_of(*surface.primitive),
                        "it has the modifier void, and is left out: nothing is seen of it",
                        surface.primitive->place);
    return nullptr;
  }
  // Normals at corners are no part of the look.
  const Modifier* modifier = surface.modifier;
  while (is_smoothing(modifier)) modifier = modifier->below.get();
  auto appearance = materials_.appearance(modifier, is_mesh, samples);
  if (!appearance->bsdf && !appearance->emitter) return nullptr;
  return appearance->directed ? with_luminaire(appearance, lamp, surface.primitive->place)
                              : appearance;
}

std::shared_ptr<const Appearance> SurfaceMaker::with_luminaire(
    const std::shared_ptr<const Appearance>& appearance, const std::optional<LampSurface>& lamp,
    const Place& place) {
  const Modifier& pattern = *appearance->directed->patterns.front().second;
  const auto luminaire = lamp && luminaires_ < most_luminaires
                             ? luminaire_of(*appearance->directed, *lamp, place)
                             : std::nullopt;
  if (!luminaire) {
    deviations_.approximated(name_of(*pattern.primitive),
                             "the pattern depends on the direction of view, and counts by its mean",
                             pattern.place());
    return appearance;
  }
  ++luminaires_;
  if (*luminaire) nest(scene_, *luminaire);
  auto& dark = dark_[appearance.get()];
  if (dark) return dark;
  deviations_.approximated(name_of(*pattern.primitive),
                           "its light comes from a point in the middle of each surface, which "
                           "itself is dark",
                           pattern.place());
  auto made = std::make_shared<Appearance>(*appearance);
  made->emitter = nullptr;
  // A sphere would be around its light.
  if (!lamp->normal) made->bsdf = make_object("bsdf", "null", place);
  return dark = made;
}

void SurfaceMaker::extend(const Vec3d& point, const Vec3d& normal, const Appearance* appearance) {
  if (appearance && appearance->grid) appearance->grid->extend(point, normal);
}

SurfaceMaker::Mesh& SurfaceMaker::mesh_of(const PlacedSurface& surface,
                                          const std::shared_ptr<const Appearance>& appearance,
                                          bool is_smooth, bool has_uvs) {
  const std::tuple key(appearance.get(), is_smooth, has_uvs);
  const auto [entry, is_new] = meshes_.try_emplace(key);
  if (is_new) {
    entry->second.appearance = appearance;
    entry->second.place = surface.primitive->place;
    order_.push_back(key);
  }
  return entry->second;
}

void SurfaceMaker::add_polygon(const PlacedSurface& surface) {
  const Primitive& primitive = *surface.primitive;
  const size_t n = primitive.reals.size() / 3;
  if (primitive.reals.size() % 3 != 0 || n < 3)
    throw Error(ErrorKind::input,
                fmt::format("{} has {} numbers, which are no corners", name_of(primitive),
                            primitive.reals.size()),
                "give three numbers for each of at least three corners", primitive.place);
  std::vector<Vec3d> corners;
  corners.reserve(n);
  for (size_t i = 0; i < n; ++i)
    corners.push_back(placed_point(surface.placed, vector_at(primitive, 3 * i)));
  auto normals = corner_normals_of(surface.modifier, primitive, surface.placed);
  if (is_mirrored(surface.placed) != surface.is_inverted) {
    std::reverse(corners.begin(), corners.end());
    if (normals) std::reverse(normals->begin(), normals->end());
  }
  if (normals && surface.is_inverted)
    for (Vec3d& normal : *normals) normal = -normal;
  const Vec3d area = area_vector_of(corners);
  if (!(area.length() > 0) || !std::all_of(corners.begin(), corners.end(), is_usable)) {
    deviations_.ignored(name_of(primitive), "it has no area, and is left out", primitive.place);
    return;
  }
  const Vec3d normal = area.normalized();
  std::vector<PatternPoint> samples = {{mean_of(corners), normal}};
  for (size_t i = 0; i < std::min<size_t>(n, 8); ++i)
    samples.push_back({corners[i] * 0.7 + samples[0].position * 0.3, normal});
  const auto appearance = look_at(surface, true, samples,
                                  LampSurface{samples[0].position, 0.5 * area.length(), normal});
  if (!appearance) return;

  const auto uvs = texture_coordinates(*appearance, corners, normal, primitive, deviations_);
  std::vector<Vec3f> flat(corners.begin(), corners.end());
  std::vector<uint32_t> names(n);
  for (size_t i = 0; i < n; ++i) names[i] = uint32_t(i);
  PolygonCutter::Triangles triangles;
  if (!PolygonCutter(64 * n).cut(flat, names, names, triangles))
    deviations_.approximated(name_of(primitive), "it is too entangled to be cut: parts are missing",
                             primitive.place);

  Mesh own;
  const bool is_lamp = appearance->emitter || appearance->beam;
  if (is_lamp) {
    own.appearance = appearance;
    own.place = primitive.place;
  }
  Mesh& mesh = is_lamp ? own : mesh_of(surface, appearance, normals.has_value(), !uvs.empty());
  const auto first = uint32_t(mesh.positions.size() / 3);
  for (size_t i = 0; i < n; ++i) {
    extend(corners[i], normal, appearance.get());
    for (int axis = 0; axis < 3; ++axis) mesh.positions.push_back(flat[i][axis]);
    if (normals)
      for (int axis = 0; axis < 3; ++axis) mesh.normals.push_back(float((*normals)[i][axis]));
    if (!uvs.empty()) mesh.uvs.insert(mesh.uvs.end(), {float(uvs[i].first), float(uvs[i].second)});
  }
  for (const auto& triangle : triangles)
    for (const uint32_t corner : triangle) mesh.faces.push_back(first + corner);
  if (is_lamp && !own.faces.empty()) add_mesh(own);
  if (appearance->beam)
    add_beam(*appearance->beam, mean_of(corners), 0.5 * area.length(), normal, primitive.place);
}

void SurfaceMaker::add_shape(const ObjectPointer& shape, const Appearance& appearance) {
  if (appearance.bsdf) nest(*shape, appearance.bsdf);
  if (appearance.emitter) nest(*shape, appearance.emitter);
  if (appearance.interior) nest(*shape, appearance.interior, "interior");
  if (appearance.exterior) nest(*shape, appearance.exterior, "exterior");
  nest(scene_, shape);
}

void SurfaceMaker::add_mesh(Mesh& mesh) {
  if (mesh.faces.empty()) return;
  const ObjectPointer shape = make_object("shape", "mesh", mesh.place);
  const bool is_smooth = !mesh.normals.empty();
  const size_t triangles = mesh.faces.size() / 3;
  give(*shape, "positions", floats_of(mesh.positions, 3));
  give(*shape, "faces", Array::of<uint32_t>({triangles, 3}, std::move(mesh.faces)));
  if (is_smooth) give(*shape, "normals", floats_of(mesh.normals, 3));
  if (!mesh.uvs.empty()) give(*shape, "uv", floats_of(mesh.uvs, 2));
  give(*shape, "face_normals", !is_smooth);
  add_shape(shape, *mesh.appearance);
}

/// A point that shines as the surface does along its axis: radiance times its area seen from there.
void SurfaceMaker::add_beam(const Appearance::Beam& beam, const Vec3d& middle, double area,
                            const Vec3d& normal, const Place& place) {
  const double cosine = normal.dot(beam.axis);
  if (!(cosine > 1e-6)) {
    deviations_.ignored("spotlight", "it points behind its surface, and gives no light", place);
    return;
  }
  const ObjectPointer spot = make_object("emitter", "spot", place);
  give(*spot, "intensity", times(beam.radiance, area * cosine));
  // Not beyond the plane of the surface.
  const double half = std::min(beam.degrees / 2, 90.0);
  give(*spot, "cutoff_angle", half);
  give(*spot, "falloff", std::string("none"));
  const Vec3d origin = middle + normal * (1e-3 * std::sqrt(area));
  give(*spot, "to_world", Transform::look_at(origin, origin + beam.axis, across(beam.axis).first));
  nest(scene_, spot);
}

void SurfaceMaker::finish() {
  for (const auto& key : order_) {
    add_mesh(meshes_.at(key));
    meshes_.erase(key);
  }
  order_.clear();
}

}  // namespace kaustik::radiance
