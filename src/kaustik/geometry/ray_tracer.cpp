#include "kaustik/geometry/ray_tracer.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstring>
#include <limits>
#include <map>

#include "kaustik/base/prefetch.h"
#include "kaustik/geometry/embree_rays.h"
#include "kaustik/geometry/mesh_surface.h"
#include "kaustik/geometry/solid_bodies.h"

namespace kaustik {
namespace {

/// What a hit is looked up in: the mesh beside the shape, so that meshes need no virtual call.
struct ShapeRecord {
  const TriangleMesh* mesh = nullptr;
  const Shape* shape = nullptr;
};

struct InstanceRecord {
  uint32_t first_shape = 0;  ///< of its group
  Vec3f columns[3];          ///< world_from_group
  Vec3f translation;
  Vec3f normal_columns[3];  ///< its inverse transpose
  Transform group_from_world;
  float norm = 0;       ///< ‖world_from_group‖∞
  float condition = 0;  ///< its condition number
};

/// Embree asserts that a ray's origin and direction stay within this (its FLT_LARGE), in the world
/// and in every instance; it leaves out primitives that do not.
constexpr float embree_limit = 1.8e18f;

Vec3f combine(const Vec3f (&columns)[3], const Vec3f& v) {
  return columns[0] * v.x + columns[1] * v.y + columns[2] * v.z;
}

float row_sum_norm(const Transform& t) {
  double norm = 0;
  for (int i = 0; i < 3; ++i)
    norm = std::max(norm, std::fabs(t.at(i, 0)) + std::fabs(t.at(i, 1)) + std::fabs(t.at(i, 2)));
  return float(norm);
}

InstanceRecord make_instance(const Transform& world_from_group, uint32_t first_shape) {
  InstanceRecord record;
  record.first_shape = first_shape;
  record.group_from_world = world_from_group.inverse();
  const Transform& inverse = record.group_from_world;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      record.columns[j][i] = float(world_from_group.at(i, j));
      record.normal_columns[j][i] = float(inverse.at(j, i));
    }
  for (int i = 0; i < 3; ++i) record.translation[i] = float(world_from_group.at(i, 3));
  record.norm = row_sum_norm(world_from_group);
  record.condition = record.norm * row_sum_norm(inverse);
  return record;
}

/// The largest coordinate in the world that is within Embree's limit in the instance's group, too.
float largest_coordinate_for(const InstanceRecord& instance) {
  const Transform& t = instance.group_from_world;
  double largest = double(embree_limit);
  for (int i = 0; i < 3; ++i) {
    const double factor = std::fabs(t.at(i, 0)) + std::fabs(t.at(i, 1)) + std::fabs(t.at(i, 2));
    const double room = 0.99 * double(embree_limit) - std::fabs(t.at(i, 3));
    largest = std::min(largest, room / std::max(factor, 1e-300));
  }
  return float(std::max(0.0, largest));
}

/// Where a mesh is read at a hit of it; asked for early, for several hits at once, since in large
/// meshes each is a cache miss.
inline void prefetch_triangle(const ShapeRecord& record, const Hit& hit) {
  if (record.mesh) prefetch(&record.mesh->triangles[hit.primitive]);
}
inline void prefetch_corners(const ShapeRecord& record, const Hit& hit) {
  if (!record.mesh) return;
  for (const uint32_t corner : record.mesh->triangles[hit.primitive]) {
    prefetch(&record.mesh->positions[corner]);
    if (!record.mesh->normals.empty()) prefetch(&record.mesh->normals[corner]);
  }
}

/// A point of a group's space brought to the world.
SurfacePoint placed(const InstanceRecord& instance, const SurfacePoint& local) {
  SurfacePoint point = local;
  point.position = combine(instance.columns, local.position) + instance.translation;
  point.ng = normalize(combine(instance.normal_columns, local.ng));
  point.ns = normalize(combine(instance.normal_columns, local.ns));
  if (dot(point.ng, point.ns) < 0) point.ns = -point.ns;
  // Embree brings the ray to the group's space with a matrix that it inverts in floats.
  point.error =
      instance.norm * local.error + 16 * float_rounding * instance.condition *
                                        (max_abs(point.position) + max_abs(instance.translation));
  return point;
}

/// A degenerate triangle that is hit all the same gets the normal that the hit test saw.
inline SurfacePoint mesh_point(const TriangleMesh& mesh, const Hit& hit) {
  SurfacePoint point = triangle_surface_point(mesh, hit.primitive, hit.u, hit.v);
  point.shape = hit.shape;
  if (point.ng == Vec3f(0, 0, 0)) [[unlikely]] {
    float scale = 0;
    point.ng = point.ns = vec3(unit_and_scale(lanes(hit.ng), scale));
  }
  return point;
}

SurfacePiece piece_of(const ShapeRecord& record, uint32_t primitive) {
  SurfacePiece piece;
  if (record.mesh) {
    for (size_t i = 0; i < 3; ++i)
      piece.corners[i] = record.mesh->positions[record.mesh->triangles[primitive][i]];
    return piece;
  }
  const Bounds3f box = record.shape->bounds();
  piece.is_box = true;
  for (size_t i = 0; i < 8; ++i)
    piece.corners[i] = {(i & 1) != 0 ? box.max.x : box.min.x, (i & 2) != 0 ? box.max.y : box.min.y,
                        (i & 4) != 0 ? box.max.z : box.min.z};
  return piece;
}

constexpr size_t packet_size = 8;

void fill(RTCRayHit8& out, size_t i, const Ray& ray) {
  out.ray.org_x[i] = ray.origin.x, out.ray.org_y[i] = ray.origin.y;
  out.ray.org_z[i] = ray.origin.z;
  out.ray.tnear[i] = std::numeric_limits<float>::min();
  out.ray.dir_x[i] = ray.direction.x, out.ray.dir_y[i] = ray.direction.y;
  out.ray.dir_z[i] = ray.direction.z;
  out.ray.time[i] = 0;
  out.ray.tfar[i] = ray.t_max;
  out.ray.mask[i] = 0xffffffffu;
  out.ray.id[i] = 0;
  out.ray.flags[i] = 0;
  out.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
  out.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
}

inline void trace_closest(RTCScene scene, const int* valid, RTCRayHit8& rayhits) {
#if RTC_VERSION_MAJOR >= 4
  rtcIntersect8(valid, scene, &rayhits, nullptr);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect8(valid, scene, &context, &rayhits);
#endif
}

inline void trace_any(RTCScene scene, RTCRay& ray) {
#if RTC_VERSION_MAJOR >= 4
  rtcOccluded1(scene, &ray, nullptr);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
#endif
}

}  // namespace

struct RayTracer::Impl {
  Impl(Geometry g, const Impl* previous);

  void build(const Impl* previous);
  std::shared_ptr<const EmbreeScene> group_scene(const EmbreeScene::Shapes& shapes,
                                                 const Impl* previous);
  EmbreeScene::Placement place(const Instance& instance);
  void place_hit(uint32_t geometry_id, uint32_t instance_id, Hit& hit) const;
  bool takes(const Ray& ray) const;
  void intersect_packet(std::span<const Ray> rays, std::span<Hit> hits) const;
  SurfacePoint point_of_others(const ShapeRecord& record, const Ray& ray, const Hit& hit) const;
  void find_part(SurfacePoint& point) const;

  Geometry geometry;
  std::vector<ShapeRecord> records;  ///< of shapes, then of parts of bodies
  size_t shape_count = 0;
  std::unique_ptr<const SolidBodies> bodies;  ///< null: none
  std::vector<InstanceRecord> instances;
  std::vector<uint32_t> first_shape_of_group;
  Bounds3f bounds;
  std::shared_ptr<EmbreeDevice> device;
  std::vector<std::shared_ptr<const EmbreeScene>> groups;
  std::map<const Shape*, size_t> group_of_first_shape;
  std::shared_ptr<const EmbreeScene> top;
  RTCScene scene = nullptr;  ///< of `top`
  StructuresBuilt built;
  float largest_coordinate = embree_limit;
  mutable std::atomic<uint64_t> refused_rays{0};
};

RayTracer::Impl::Impl(Geometry g, const Impl* previous) : geometry(std::move(g)) {
  if (previous && previous->device->has_failed()) previous = nullptr;
  device = previous ? previous->device : std::make_shared<EmbreeDevice>();
  build(previous);
  scene = top->get();
  shape_count = records.size();
  if (geometry.bodies.empty()) return;
  bodies = std::make_unique<const SolidBodies>(device, geometry.shapes, geometry.bodies);
  for (const BodyPart& part : bodies->parts()) records.push_back(records[part.shape]);
}

void RayTracer::Impl::build(const Impl* previous) {
  const auto record = [&](const std::shared_ptr<const Shape>& shape) {
    records.push_back({shape->mesh(), shape.get()});
  };
  for (const auto& shape : geometry.shapes) {
    record(shape);
    bounds.extendBy(shape->bounds());
  }
  std::vector<Bounds3f> group_bounds;
  for (const auto& group : geometry.groups) {
    first_shape_of_group.push_back(uint32_t(records.size()));
    if (!group.empty()) group_of_first_shape.emplace(group.front().get(), groups.size());
    groups.push_back(group_scene(group, previous));
    group_bounds.emplace_back();
    for (const auto& shape : group) {
      record(shape);
      group_bounds.back().extendBy(shape->bounds());
    }
  }
  std::vector<EmbreeScene::Placement> placements;
  for (const Instance& instance : geometry.instances) {
    placements.push_back(place(instance));
    bounds.extendBy(instance.world_from_group.bounds(group_bounds[instance.group]));
  }
  if (bounds.isEmpty()) bounds = {Vec3f(-1, -1, -1), Vec3f(1, 1, 1)};
  if (previous && previous->top->is_of(geometry.shapes, placements)) {
    top = previous->top;
    return;
  }
  top = std::make_shared<EmbreeScene>(device, geometry.shapes, std::move(placements));
  built.top_level = true;
}

std::shared_ptr<const EmbreeScene> RayTracer::Impl::group_scene(const EmbreeScene::Shapes& shapes,
                                                                const Impl* previous) {
  if (previous && !shapes.empty()) {
    const auto found = previous->group_of_first_shape.find(shapes.front().get());
    if (found != previous->group_of_first_shape.end() &&
        previous->groups[found->second]->is_of(shapes, {}))
      return previous->groups[found->second];
  }
  ++built.groups;
  return std::make_shared<EmbreeScene>(device, shapes, std::vector<EmbreeScene::Placement>());
}

EmbreeScene::Placement RayTracer::Impl::place(const Instance& instance) {
  instances.push_back(
      make_instance(instance.world_from_group, first_shape_of_group[instance.group]));
  const InstanceRecord& record = instances.back();
  largest_coordinate = std::min(largest_coordinate, largest_coordinate_for(record));
  EmbreeScene::Placement placement{groups[instance.group], {}};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) placement.columns[3 * j + i] = record.columns[j][int(i)];
    placement.columns[9 + i] = record.translation[int(i)];
  }
  return placement;
}

/// The point of a hit of what is instanced or no mesh.
SurfacePoint RayTracer::Impl::point_of_others(const ShapeRecord& record, const Ray& ray,
                                              const Hit& hit) const {
  SurfacePoint point;
  if (hit.instance == no_instance) {
    point = record.shape->surface_point(ray, hit);
  } else {
    const InstanceRecord& instance = instances[hit.instance];
    const Transform& group_from_world = instance.group_from_world;
    point = record.mesh
                ? mesh_point(*record.mesh, hit)
                : record.shape->surface_point({group_from_world.point(ray.origin),
                                               group_from_world.vector(ray.direction), ray.t_max},
                                              hit);
    point = placed(instance, point);
  }
  point.shape = hit.shape;
  point.primitive = hit.primitive;
  point.instance = hit.instance;
  return point;
}

RayTracer::RayTracer(Geometry geometry, const RayTracer* previous)
    : impl_(std::make_unique<Impl>(std::move(geometry),
                                   previous ? previous->impl_.get() : nullptr)) {}
RayTracer::~RayTracer() = default;

void RayTracer::Impl::place_hit(uint32_t geometry_id, uint32_t instance_id, Hit& hit) const {
  hit.shape = geometry_id;
  hit.instance = no_instance;
  if (instance_id == RTC_INVALID_GEOMETRY_ID) return;
  // Instances were attached behind the shapes that stand in the world.
  hit.instance = instance_id - uint32_t(geometry.shapes.size());
  hit.shape += instances[hit.instance].first_shape;
}

/// Whether Embree takes the ray; counts it if not. Every ray passes here, so its seven numbers are
/// compared in two registers.
inline bool RayTracer::Impl::takes(const Ray& ray) const {
  static_assert(offsetof(Ray, direction) == 12 && offsetof(Ray, t_max) == 24);
  Lanes first, second;
  std::memcpy(&first, &ray.origin, sizeof(first));
  std::memcpy(&second, &ray.direction, sizeof(second));
  const float most = largest_coordinate;
  // What is no number is not less than anything.
  const LaneMask fits = (lane_abs(first) <= Lanes{most, most, most, most}) &
                        (lane_abs(second) <= Lanes{most, most, most, infinity});
  using Halves = int64_t __attribute__((vector_size(16)));
  const auto halves = Halves(fits);
  if ((halves[0] & halves[1]) == -1) [[likely]]
    return true;
  refused_rays.fetch_add(1, std::memory_order_relaxed);
  return false;
}

bool RayTracer::intersect(const Ray& ray, Hit& hit) const {
  if (!impl_->takes(ray)) [[unlikely]]
    return false;
  RTCRayHit rayhit;
  fill(rayhit.ray, ray);
  rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  trace_closest(impl_->scene, rayhit);
  if (rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  hit.t = rayhit.ray.tfar;
  hit.u = rayhit.hit.u;
  hit.v = rayhit.hit.v;
  hit.ng = {rayhit.hit.Ng_x, rayhit.hit.Ng_y, rayhit.hit.Ng_z};
  hit.primitive = rayhit.hit.primID;
  impl_->place_hit(rayhit.hit.geomID, rayhit.hit.instID[0], hit);
  return true;
}

void RayTracer::Impl::intersect_packet(std::span<const Ray> rays, std::span<Hit> hits) const {
  alignas(32) int valid[packet_size];
  RTCRayHit8 packet;
  for (size_t i = 0; i < packet_size; ++i) {
    valid[i] = i < rays.size() && takes(rays[i]) ? -1 : 0;
    fill(packet, i, rays[std::min(i, rays.size() - 1)]);
  }
  trace_closest(scene, valid, packet);
  for (size_t i = 0; i < rays.size(); ++i) {
    Hit& hit = hits[i];
    if (packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) {
      hit.t = infinity;
      continue;
    }
    hit.t = packet.ray.tfar[i];
    hit.u = packet.hit.u[i];
    hit.v = packet.hit.v[i];
    hit.ng = {packet.hit.Ng_x[i], packet.hit.Ng_y[i], packet.hit.Ng_z[i]};
    hit.primitive = packet.hit.primID[i];
    place_hit(packet.hit.geomID[i], packet.hit.instID[0][i], hit);
    prefetch_triangle(records[hit.shape], hit);
  }
}

void RayTracer::intersect(std::span<const Ray> rays, std::span<Hit> hits) const {
  assert(hits.size() >= rays.size());
  for (size_t begin = 0; begin < rays.size(); begin += packet_size) {
    const size_t count = std::min(packet_size, rays.size() - begin);
    impl_->intersect_packet(rays.subspan(begin, count), hits.subspan(begin, count));
  }
  for (const Hit& hit : hits.first(rays.size()))
    if (hit.t < infinity) prefetch_corners(impl_->records[hit.shape], hit);
}

bool RayTracer::occluded(const Ray& ray) const {
  if (!impl_->takes(ray)) [[unlikely]]
    return false;
  RTCRay r;
  fill(r, ray);
  trace_any(impl_->scene, r);
  return r.tfar < 0;
}

void RayTracer::pieces_near(const Vec3f& center, float radius, const PieceSink& sink) const {
  struct Search {
    const Impl& impl;
    const PieceSink& sink;
    bool wants_more = true;
  } search{*impl_, sink};
  const auto visit = [](RTCPointQueryFunctionArguments* arguments) {
    Search& in = *static_cast<Search*>(arguments->userPtr);
    if (!in.wants_more) return false;
    const bool is_placed = arguments->context->instStackSize > 0;
    Hit at;
    in.impl.place_hit(arguments->geomID,
                      is_placed ? arguments->context->instID[0] : RTC_INVALID_GEOMETRY_ID, at);
    SurfacePiece piece = piece_of(in.impl.records[at.shape], arguments->primID);
    if (is_placed) {
      const InstanceRecord& instance = in.impl.instances[at.instance];
      for (Vec3f& corner : piece.corners)
        corner = combine(instance.columns, corner) + instance.translation;
    }
    in.wants_more = in.sink.take(in.sink.context, piece);
    if (in.wants_more) return false;
    arguments->query->radius = 0;  // nothing is near any more
    return true;
  };
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  RTCPointQuery query{center.x, center.y, center.z, 0, radius};
  rtcPointQuery(impl_->scene, &query, &context, visit, &search);
}

void RayTracer::Impl::find_part(SurfacePoint& point) const {
  const int part =
      point.instance == no_instance ? bodies->part_at(point.position, point.shape) : -1;
  if (part >= 0) point.shape = uint32_t(shape_count + size_t(part));
}

SurfacePoint RayTracer::surface_point(const Ray& ray, const Hit& hit) const {
  const ShapeRecord& record = impl_->records[hit.shape];
  const bool is_mesh = record.mesh && hit.instance == no_instance;
  if (is_mesh && !impl_->bodies) [[likely]]
    return mesh_point(*record.mesh, hit);
  SurfacePoint point =
      is_mesh ? mesh_point(*record.mesh, hit) : impl_->point_of_others(record, ray, hit);
  if (impl_->bodies) impl_->find_part(point);
  return point;
}

UvDerivatives RayTracer::uv_derivatives(const SurfacePoint& point) const {
  const Shape& shape = *impl_->records[point.shape].shape;
  if (point.instance == no_instance) return shape.uv_derivatives(point);
  const InstanceRecord& instance = impl_->instances[point.instance];
  SurfacePoint local = point;
  local.position = instance.group_from_world.point(point.position);
  local.ng = normalize(instance.group_from_world.normal(point.ng));
  const UvDerivatives d = shape.uv_derivatives(local);
  return {combine(instance.columns, d.dpdu), combine(instance.columns, d.dpdv)};
}

const Shape& RayTracer::shape(uint32_t index) const { return *impl_->records[index].shape; }
size_t RayTracer::shape_count() const { return impl_->shape_count; }
std::span<const BodyPart> RayTracer::body_parts() const {
  if (!impl_->bodies) return {};
  return impl_->bodies->parts();
}
const Geometry& RayTracer::geometry() const { return impl_->geometry; }
Bounds3f RayTracer::bounds() const { return impl_->bounds; }
uint64_t RayTracer::refused_rays() const { return impl_->refused_rays; }
float RayTracer::largest_coordinate() const { return impl_->largest_coordinate; }
StructuresBuilt RayTracer::structures_built() const { return impl_->built; }
bool RayTracer::traces_like(const RayTracer& other) const {
  const auto same_place = [](const Instance& a, const Instance& b) {
    return a.group == b.group && a.world_from_group == b.world_from_group;
  };
  const Geometry &ours = impl_->geometry, &theirs = other.impl_->geometry;
  return impl_->top == other.impl_->top && ours.groups == theirs.groups &&
         ours.bodies == theirs.bodies &&
         std::equal(ours.instances.begin(), ours.instances.end(), theirs.instances.begin(),
                    theirs.instances.end(), same_place);
}
size_t RayTracer::size_in_bytes() const {
  int64_t bytes = impl_->top->bytes();
  for (const auto& group : impl_->groups) bytes += group->bytes();
  return size_t(std::max<int64_t>(0, bytes));
}
void* RayTracer::embree_scene() const { return impl_->scene; }

}  // namespace kaustik
