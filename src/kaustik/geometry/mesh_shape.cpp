#include "kaustik/geometry/mesh_shape.h"
#include "kaustik/base/memory.h"

#include <algorithm>
#include <atomic>

#include "kaustik/base/parallel.h"
#include "kaustik/base/prefetch.h"
#include "kaustik/base/warp.h"
#include "kaustik/geometry/mesh_surface.h"
#include "kaustik/geometry/shape_support.h"

namespace kaustik {
namespace {

/// Triangles or vertices that a thread goes through at a time.
constexpr size_t block_size = size_t{1} << 16;
/// So that they are in a cache when they are gone through again.
constexpr size_t small_block_size = size_t{1} << 13;

double triangle_area(const TriangleMesh& mesh, const std::array<uint32_t, 3>& corner) {
  const Vec3d p0(mesh.positions[corner[0]]);
  return 0.5 * (Vec3d(mesh.positions[corner[1]]) - p0)
                   .cross(Vec3d(mesh.positions[corner[2]]) - p0)
                   .length();
}

/// Calls `body` with each of them, in parallel.
template <typename Items, typename Body>
void for_each_in_parallel(Items& items, const Body& body) {
  parallel_blocks(items.size(), block_size, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i) body(items[i]);
  });
}

void turn_round(TriangleMesh& mesh) {
  for_each_in_parallel(mesh.triangles, [](auto& corner) { std::swap(corner[1], corner[2]); });
}

/// Of some of its triangles.
double area_of(const TriangleMesh& mesh, size_t begin, size_t end) {
  double area = 0;
  for (size_t i = begin; i < end; ++i) area += triangle_area(mesh, mesh.triangles[i]);
  return area;
}

/// Turns a triangle round if its vertex normals point to its back.
void wind_by_normals(const TriangleMesh& mesh, std::array<uint32_t, 3>& corner) {
  const Lanes n = lanes(mesh.normals[corner[0]]) + lanes(mesh.normals[corner[1]]) +
                  lanes(mesh.normals[corner[2]]);
  const Lanes p0 = lanes(mesh.positions[corner[0]]), p1 = lanes(mesh.positions[corner[1]]),
              p2 = lanes(mesh.positions[corner[2]]);
  // Mostly the sign is clear, whatever the roundings, before the length is known.
  const Lanes products = n * triangle_cross(p0, p1, p2).normal;
  if (sum_of(products) > 1e-6f * sum_of(lane_abs(products)) + 1e-30f) [[likely]]
    return;
  if (dot(vec3(n), vec3(triangle_normal(p0, p1, p2).unit)) < 0) std::swap(corner[1], corner[2]);
}

/// Of the corners of some of its triangles.
Bounds3f bounds_of(const TriangleMesh& mesh, size_t begin, size_t end) {
  Bounds3f box;
  Lanes low = lanes(box.min), high = lanes(box.max);
  for (size_t i = begin; i < end; ++i)
    for (const uint32_t vertex : mesh.triangles[i]) {
      const Lanes p = lanes(mesh.positions[vertex]);
      low = p < low ? p : low;
      high = p > high ? p : high;
    }
  box.min = vec3(low), box.max = vec3(high);
  return box;
}

/// Moves the normals to the world and makes their length one; those that have no direction become
/// zero. Whether any are.
bool place_normals(std::vector<Vec3f>& normals, const Transform& to_world) {
  const bool is_moved = !(to_world == Transform());
  std::atomic<bool> any_missing{false};
  parallel_blocks(normals.size(), block_size, [&](size_t begin, size_t end, size_t) {
    bool missing = false;
    for (size_t i = begin; i < end; ++i) {
      Vec3f& n = normals[i];
      if (is_moved) n = to_world.normal(n);
      const float n_length = length(n);
      const bool is_sound = n_length > 0 && std::isfinite(n_length);
      n = is_sound ? n * (1.0f / n_length) : Vec3f(0, 0, 0);
      missing |= n == Vec3f(0, 0, 0);
    }
    if (missing) any_missing = true;
  });
  return any_missing;
}

/// Gives normals to those vertices that have none.
void add_missing_normals(TriangleMesh& mesh) {
  const Vec3f nothing(0, 0, 0);
  const std::vector<Vec3f> smooth = smooth_normals(mesh);
  for (size_t i = 0; i < mesh.normals.size(); ++i)
    if (mesh.normals[i] == nothing) mesh.normals[i] = smooth[i];
}

/// See MeshShape::rectangle_.
std::optional<SphericalRectangle> rectangle_of(const TriangleMesh& mesh) {
  if (mesh.positions.size() != 4 || mesh.triangles.size() != 2) return std::nullopt;
  const auto is_half = [&](size_t triangle, uint32_t third) {
    const auto& corner = mesh.triangles[triangle];
    return corner[0] == 0 && (corner[1] == 2 || corner[2] == 2) &&
           (corner[1] == third || corner[2] == third);
  };
  if (!is_half(0, 1) || !is_half(1, 3)) return std::nullopt;
  const Vec3d p0(mesh.positions[0]), p1(mesh.positions[1]), p2(mesh.positions[2]),
      p3(mesh.positions[3]);
  if ((p0 + p2 - p1 - p3).length() > 1e-6 * (p2 - p0).length()) return std::nullopt;
  return SphericalRectangle::make((p0 + p2) * 0.5, (p1 - p0) * 0.5, (p3 - p0) * 0.5);
}

}  // namespace

MeshShape::MeshShape(TriangleMesh mesh, std::vector<std::string> remarks)
    : mesh_(std::move(mesh)), remarks_(std::move(remarks)) {
  // Embree reads vertices by 16 bytes: room behind the last one.
  mesh_.positions.reserve(mesh_.positions.size() + 1);
  const size_t count = mesh_.triangles.size();
  std::vector<Bounds3f> boxes((count + small_block_size - 1) / small_block_size);
  parallel_blocks(count, small_block_size, [&](size_t begin, size_t end, size_t block) {
    boxes[block] = bounds_of(mesh_, begin, end);
    if (mesh_.normals.empty()) return;
    for (size_t i = begin; i < end; ++i) wind_by_normals(mesh_, mesh_.triangles[i]);
  });
  for (const Bounds3f& box : boxes) bounds_.extendBy(box);
  rectangle_ = rectangle_of(mesh_);
}

float MeshShape::area() const {
  float area = area_.load(std::memory_order_relaxed);
  if (area < 0) {
    area = float(sum_over_blocks(mesh_.triangles.size(), block_size, [&](size_t begin, size_t end) {
      return area_of(mesh_, begin, end);
    }));
    area_.store(area, std::memory_order_relaxed);  // whoever else finds it out finds the same
  }
  return area;
}

SurfacePoint MeshShape::surface_point(const Ray&, const Hit& hit) const {
  return triangle_surface_point(mesh_, hit.primitive, hit.u, hit.v);
}

UvDerivatives MeshShape::uv_derivatives(const SurfacePoint& at) const {
  return triangle_uv_derivatives(mesh_, at.primitive);
}

void MeshShape::build_distribution() const {
  reserve_large(cumulative_area_, mesh_.triangles.size());
  double sum = 0;
  for (const auto& corner : mesh_.triangles)
    cumulative_area_.push_back(sum += triangle_area(mesh_, corner));
}

ShapeSample MeshShape::sample_area(const Vec2f& u) const {
  std::call_once(distribution_once_, [this] { build_distribution(); });
  if (!(area() > 0)) return {};
  const double target = double(u.x) * cumulative_area_.back();
  auto it = std::upper_bound(cumulative_area_.begin(), cumulative_area_.end(), target);
  if (it == cumulative_area_.end()) --it;
  const double before = it == cumulative_area_.begin() ? 0.0 : *(it - 1);
  const double rest = *it > before ? (target - before) / (*it - before) : 0.0;
  const Vec2f b = square_to_triangle({std::min(float(rest), one_minus_epsilon), u.y});
  const auto triangle = uint32_t(it - cumulative_area_.begin());
  ShapeSample sample{triangle_surface_point(mesh_, triangle, b.x, b.y), 1.0f / area()};
  if (sample.point.ng == Vec3f(0, 0, 0)) sample.pdf_area = 0;
  return sample;
}

std::optional<Vec2f> MeshShape::area_coordinates(const SurfacePoint& point) const {
  if (!(area() > 0) || point.primitive >= mesh_.triangles.size()) return std::nullopt;
  std::call_once(distribution_once_, [this] { build_distribution(); });
  const auto& corner = mesh_.triangles[point.primitive];
  const Vec3d p0(mesh_.positions[corner[0]]);
  const Vec3d a = Vec3d(mesh_.positions[corner[1]]) - p0,
              b = Vec3d(mesh_.positions[corner[2]]) - p0, p = Vec3d(point.position) - p0;
  const Vec3d normal = a.cross(b);
  const double normal_sq = normal.length2();
  if (!(normal_sq > 0)) return std::nullopt;
  // Barycentric coordinates of the second and the third corner.
  const double b1 = std::max(0.0, p.cross(b).dot(normal) / normal_sq);
  const double b2 = std::max(0.0, a.cross(p).dot(normal) / normal_sq);
  const double sum = std::min(b1 + b2, 1.0);
  const double before = point.primitive > 0 ? cumulative_area_[point.primitive - 1] : 0.0;
  const double of_triangle = cumulative_area_[point.primitive] - before;
  return Vec2f(float((before + sum * sum * of_triangle) / cumulative_area_.back()),
               sum > 0 ? float(std::min(b2 / (b1 + b2), 1.0)) : 0.0f);
}

ShapeSample MeshShape::sample_toward(const Vec3f& reference, const Vec2f& u,
                                     float& pdf_solid_angle) const {
  // Of thousands of small lamps none is in a cache: fetched together instead of one by one.
  prefetch(cumulative_area_.data());
  prefetch(mesh_.triangles.data());
  prefetch(mesh_.positions.data());
  const auto view = rectangle_ ? rectangle_->seen_near(reference) : std::nullopt;
  if (!view) return Shape::sample_toward(reference, u, pdf_solid_angle);
  pdf_solid_angle = view->pdf();
  return sample_of(rectangle_point(view->sample(u)), reference, pdf_solid_angle);
}

float MeshShape::pdf_toward(const Vec3f& reference, const SurfacePoint& point) const {
  const auto view = rectangle_ ? rectangle_->seen_near(reference) : std::nullopt;
  return view ? view->pdf() : Shape::pdf_toward(reference, point);
}

SurfacePoint MeshShape::rectangle_point(const Vec2f& at) const {
  const float s = std::clamp(0.5f + 0.5f * at.x, 0.0f, 1.0f);
  const float t = std::clamp(0.5f + 0.5f * at.y, 0.0f, 1.0f);
  // p0 + s (p1 − p0) + t (p3 − p0), by the triangle on whose side of the diagonal it lies.
  const uint32_t triangle = s >= t ? 0 : 1;
  const float of_diagonal = std::min(s, t), of_other = std::fabs(s - t);
  const bool diagonal_first = mesh_.triangles[triangle][1] == 2;
  return triangle_surface_point(mesh_, triangle, diagonal_first ? of_diagonal : of_other,
                                diagonal_first ? of_other : of_diagonal);
}

TriangleMesh MeshShape::tessellate(int) const { return mesh_; }

std::vector<Bounds3f> MeshShape::bounding_boxes(int budget) const {
  return triangle_boxes(mesh_, budget);
}

std::vector<Vec3f> smooth_normals(const TriangleMesh& mesh) {
  std::vector<Vec3f> normals(mesh.positions.size(), Vec3f(0, 0, 0));
  // What faces give is computed in parallel, and added in their order.
  constexpr size_t batch_size = 4 * block_size;
  std::vector<std::array<Vec3f, 3>> parts(std::min(batch_size, mesh.triangles.size()));
  for (size_t first = 0; first < mesh.triangles.size(); first += batch_size) {
    const size_t count = std::min(batch_size, mesh.triangles.size() - first);
    parallel_blocks(count, block_size / 4, [&](size_t begin, size_t end, size_t) {
      for (size_t i = begin; i < end; ++i)
        parts[i] = weighted_normals(mesh, mesh.triangles[first + i]);
    });
    for (size_t i = 0; i < count; ++i)
      for (size_t corner = 0; corner < 3; ++corner)
        normals[mesh.triangles[first + i][corner]] += parts[i][corner];
  }
  for_each_in_parallel(normals, [](Vec3f& n) {
    const float n_length = length(n);
    n = n_length > 0 ? n * (1.0f / n_length) : Vec3f(0, 0, 1);
  });
  return normals;
}

std::array<Vec3f, 3> weighted_normals(const TriangleMesh& mesh,
                                      const std::array<uint32_t, 3>& corner) {
  const Vec3f p[3] = {mesh.positions[corner[0]], mesh.positions[corner[1]],
                      mesh.positions[corner[2]]};
  const Vec3f n = triangle_normal(p[0], p[1], p[2]);
  std::array<Vec3f, 3> weighted;
  weighted.fill(Vec3f(0, 0, 0));
  if (n == Vec3f(0, 0, 0)) return weighted;
  for (int i = 0; i < 3; ++i) {
    const Vec3d a(p[(i + 1) % 3] - p[i]), b(p[(i + 2) % 3] - p[i]);
    weighted[size_t(i)] = n * float(std::atan2(a.cross(b).length(), a.dot(b)));
  }
  return weighted;
}

TriangleMesh prepare_mesh(TriangleMesh mesh, const MeshOptions& options, const Place& place) {
  constexpr float largest = 1e18f;  // what Embree can hold
  const bool is_moved = !(options.to_world == Transform());
  // The first vertex of each block that is too far away.
  std::vector<size_t> too_far((mesh.positions.size() + block_size - 1) / block_size,
                              mesh.positions.size());
  parallel_blocks(mesh.positions.size(), block_size, [&](size_t begin, size_t end, size_t block) {
    for (size_t i = end; i-- > begin;) {
      Vec3f& p = mesh.positions[i];
      if (is_moved) p = options.to_world.point(p);
      if (!is_finite(p) || max_abs(p) > largest) too_far[block] = i;
    }
  });
  for (const size_t vertex : too_far)
    if (vertex < mesh.positions.size())
      throw Error(ErrorKind::input,
                  "vertex " + std::to_string(vertex) + " is too far away once placed by 'to_world'",
                  "coordinates must stay below 1e18", place);
  // Mirrored, what ran anticlockwise round the front runs clockwise.
  if (options.to_world.determinant3() < 0) turn_round(mesh);
  if (options.face_normals || options.max_smooth_angle) mesh.normals = std::vector<Vec3f>();
  const bool any_missing = place_normals(mesh.normals, options.to_world);
  if (!options.face_normals) {
    if (options.max_smooth_angle)
      mesh = split_at_creases(std::move(mesh), *options.max_smooth_angle);
    else if (mesh.normals.empty())
      mesh.normals = smooth_normals(mesh);
    else if (any_missing)
      add_missing_normals(mesh);
  }
  if (options.flip_normals) {
    for_each_in_parallel(mesh.normals, [](Vec3f& n) { n = -n; });
    turn_round(mesh);
  }
  if (options.flip_tex_coords)
    for_each_in_parallel(mesh.uvs, [](Vec2f& uv) { uv.y = 1.0f - uv.y; });
  return mesh;
}

}  // namespace kaustik
