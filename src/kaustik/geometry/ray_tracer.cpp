// The only file that sees Embree (3.13, or 4 where that is installed).

#include "kaustik/geometry/ray_tracer.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstring>
#include <limits>
#include <mutex>

#include "kaustik/base/prefetch.h"
#include "kaustik/geometry/mesh_surface.h"

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

/// Lane `i` of a packet of `n` rays.
Ray ray_of(RTCRayN* rays, unsigned n, unsigned i) {
  return {{RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)},
          {RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)},
          RTCRayN_tfar(rays, n, i)};
}

void shape_bounds(const RTCBoundsFunctionArguments* arguments) {
  const Bounds3f b = static_cast<const Shape*>(arguments->geometryUserPtr)->bounds();
  RTCBounds& out = *arguments->bounds_o;
  out.lower_x = b.min.x, out.lower_y = b.min.y, out.lower_z = b.min.z;
  out.upper_x = b.max.x, out.upper_y = b.max.y, out.upper_z = b.max.z;
}

void intersect_shape(const RTCIntersectFunctionNArguments* arguments) {
  const Shape& shape = *static_cast<const Shape*>(arguments->geometryUserPtr);
  const unsigned n = arguments->N;
  RTCRayN* rays = RTCRayHitN_RayN(arguments->rayhit, n);
  RTCHitN* hits = RTCRayHitN_HitN(arguments->rayhit, n);
  for (unsigned i = 0; i < n; ++i) {
    if (!arguments->valid[i]) continue;
    const auto hit = shape.intersect(ray_of(rays, n, i));
    if (!hit) continue;
    RTCRayN_tfar(rays, n, i) = hit->t;
    RTCHitN_Ng_x(hits, n, i) = hit->ng.x, RTCHitN_Ng_y(hits, n, i) = hit->ng.y;
    RTCHitN_Ng_z(hits, n, i) = hit->ng.z;
    RTCHitN_u(hits, n, i) = hit->u, RTCHitN_v(hits, n, i) = hit->v;
    RTCHitN_primID(hits, n, i) = arguments->primID;
    RTCHitN_geomID(hits, n, i) = arguments->geomID;
    RTCHitN_instID(hits, n, i, 0) = arguments->context->instID[0];
  }
}

void occluded_by_shape(const RTCOccludedFunctionNArguments* arguments) {
  const Shape& shape = *static_cast<const Shape*>(arguments->geometryUserPtr);
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i)
    if (arguments->valid[i] && shape.intersect(ray_of(arguments->ray, n, i)))
      RTCRayN_tfar(arguments->ray, n, i) = -infinity;
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

/// What a failure of Embree means.
Error error_of(RTCError code, const std::string& text) {
  if (code == RTC_ERROR_OUT_OF_MEMORY)
    return {ErrorKind::system, "out of memory while building the ray tracing structure",
            "use smaller meshes, or instances of one shape group"};
  if (code == RTC_ERROR_UNSUPPORTED_CPU)
    return {ErrorKind::system, "Embree cannot run on this processor",
            "use one with SSE4.2 or newer"};
  return {ErrorKind::system, "Embree failed: " + text,
          "give the program more memory or threads (ulimit -v, ulimit -u)"};
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

void fill(RTCRay& out, const Ray& ray) {
  out.org_x = ray.origin.x, out.org_y = ray.origin.y, out.org_z = ray.origin.z;
  out.tnear = std::numeric_limits<float>::min();  // Embree's range includes its ends
  out.dir_x = ray.direction.x, out.dir_y = ray.direction.y, out.dir_z = ray.direction.z;
  out.time = 0;
  out.tfar = ray.t_max;
  out.mask = 0xffffffffu;
  out.id = 0;
  out.flags = 0;
}

// Single rays and packets come from anywhere: the default of both versions is to expect incoherent
// ones.
inline void trace_closest(RTCScene scene, RTCRayHit& rayhit) {
#if RTC_VERSION_MAJOR >= 4
  rtcIntersect1(scene, &rayhit, nullptr);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &rayhit);
#endif
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
  explicit Impl(Geometry g) : geometry(std::move(g)) {
    device = rtcNewDevice(nullptr);
    if (!device) throw error_of(rtcGetDeviceError(nullptr), "no device");
    try {
      rtcSetDeviceErrorFunction(device, on_error, this);
      rtcSetDeviceMemoryMonitorFunction(device, on_memory, this);
      build();
    } catch (...) {
      error_code == RTC_ERROR_NONE ? release() : abandon();
      throw;
    }
  }
  ~Impl() { release(); }

  void build();
  RTCScene build_scene(const std::vector<std::shared_ptr<const Shape>>& shapes);
  void attach(RTCScene target, RTCGeometry part);
  RTCGeometry mesh_geometry(const TriangleMesh& mesh);
  RTCGeometry user_geometry(const Shape& shape);
  void attach_instance(const Instance& instance);
  void commit(RTCScene target);
  void check();
  void release();
  void abandon();
  void place_hit(uint32_t geometry_id, uint32_t instance_id, Hit& hit) const;
  bool takes(const Ray& ray) const;
  void intersect_packet(std::span<const Ray> rays, std::span<Hit> hits) const;
  SurfacePoint point_of_others(const ShapeRecord& record, const Ray& ray, const Hit& hit) const;

  static void on_error(void* self, RTCError code, const char* text);
  static bool on_memory(void* self, ssize_t bytes, bool) {
    static_cast<Impl*>(self)->bytes += int64_t(bytes);
    return true;
  }

  Geometry geometry;
  std::vector<ShapeRecord> records;
  std::vector<InstanceRecord> instances;
  std::vector<uint32_t> first_shape_of_group;
  Bounds3f bounds;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<RTCScene> group_scenes;
  std::atomic<int64_t> bytes{0};
  float largest_coordinate = embree_limit;
  mutable std::atomic<uint64_t> refused_rays{0};
  std::mutex error_mutex;
  RTCError error_code = RTC_ERROR_NONE;
  std::string error_text;
};

void RayTracer::Impl::on_error(void* self, RTCError code, const char* text) {
  auto& impl = *static_cast<Impl*>(self);
  const std::lock_guard lock(impl.error_mutex);
  if (impl.error_code != RTC_ERROR_NONE) return;
  impl.error_code = code;
  impl.error_text = text ? text : "";
}

void RayTracer::Impl::check() {
  const std::lock_guard lock(error_mutex);
  if (error_code == RTC_ERROR_NONE) return;
  throw error_of(error_code, error_text);
}

/// Taking Embree down where it could not start all its threads ends the program, and whether it
/// could is not told: after a failure it is left behind.
void RayTracer::Impl::abandon() {
  rtcSetDeviceErrorFunction(device, nullptr, nullptr);
  rtcSetDeviceMemoryMonitorFunction(device, nullptr, nullptr);
}

void RayTracer::Impl::release() {
  if (scene) rtcReleaseScene(scene);
  for (RTCScene group : group_scenes)
    if (group) rtcReleaseScene(group);
  if (device) rtcReleaseDevice(device);
}

void RayTracer::Impl::build() {
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
    group_scenes.push_back(build_scene(group));
    commit(group_scenes.back());
    group_bounds.emplace_back();
    for (const auto& shape : group) {
      record(shape);
      group_bounds.back().extendBy(shape->bounds());
    }
  }
  scene = build_scene(geometry.shapes);
  for (const Instance& instance : geometry.instances) {
    attach_instance(instance);
    bounds.extendBy(instance.world_from_group.bounds(group_bounds[instance.group]));
  }
  if (bounds.isEmpty()) bounds = {Vec3f(-1, -1, -1), Vec3f(1, 1, 1)};
  commit(scene);
}

RTCScene RayTracer::Impl::build_scene(const std::vector<std::shared_ptr<const Shape>>& shapes) {
  RTCScene target = rtcNewScene(device);
  check();
  rtcSetSceneFlags(target, RTC_SCENE_FLAG_ROBUST);
  // HIGH is the one quality whose result depends on the order of threads.
  rtcSetSceneBuildQuality(target, RTC_BUILD_QUALITY_MEDIUM);
  for (const auto& shape : shapes) {
    const TriangleMesh* mesh = shape->mesh();
    attach(target, mesh ? mesh_geometry(*mesh) : user_geometry(*shape));
  }
  return target;
}

void RayTracer::Impl::attach(RTCScene target, RTCGeometry part) {
  rtcCommitGeometry(part);
  rtcAttachGeometry(target, part);
  rtcReleaseGeometry(part);
  check();
}

RTCGeometry RayTracer::Impl::mesh_geometry(const TriangleMesh& mesh) {
  RTCGeometry part = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  const size_t vertices = mesh.positions.size();
  // Embree reads 16 bytes per vertex: a buffer without room behind its end is copied.
  if (mesh.positions.capacity() > vertices) {
    rtcSetSharedGeometryBuffer(part, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               mesh.positions.data(), 0, sizeof(Vec3f), vertices);
  } else if (void* copy = rtcSetNewGeometryBuffer(part, RTC_BUFFER_TYPE_VERTEX, 0,
                                                  RTC_FORMAT_FLOAT3, sizeof(Vec3f), vertices)) {
    std::copy(mesh.positions.begin(), mesh.positions.end(), static_cast<Vec3f*>(copy));
  }
  rtcSetSharedGeometryBuffer(part, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             mesh.triangles.data(), 0, sizeof(mesh.triangles[0]),
                             mesh.triangles.size());
  return part;
}

RTCGeometry RayTracer::Impl::user_geometry(const Shape& shape) {
  RTCGeometry part = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(part, 1);
  rtcSetGeometryUserData(part, const_cast<Shape*>(&shape));
  rtcSetGeometryBoundsFunction(part, shape_bounds, nullptr);
  rtcSetGeometryIntersectFunction(part, intersect_shape);
  rtcSetGeometryOccludedFunction(part, occluded_by_shape);
  return part;
}

void RayTracer::Impl::attach_instance(const Instance& instance) {
  instances.push_back(
      make_instance(instance.world_from_group, first_shape_of_group[instance.group]));
  RTCGeometry part = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(part, group_scenes[instance.group]);
  const InstanceRecord& record = instances.back();
  largest_coordinate = std::min(largest_coordinate, largest_coordinate_for(record));
  float matrix[12];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) matrix[3 * j + i] = record.columns[j][i];
    matrix[9 + i] = record.translation[i];
  }
  rtcSetGeometryTransform(part, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, matrix);
  attach(scene, part);
}

void RayTracer::Impl::commit(RTCScene target) {
  rtcCommitScene(target);
  check();
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

RayTracer::RayTracer(Geometry geometry) : impl_(std::make_unique<Impl>(std::move(geometry))) {}
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

SurfacePoint RayTracer::surface_point(const Ray& ray, const Hit& hit) const {
  const ShapeRecord& record = impl_->records[hit.shape];
  if (!record.mesh || hit.instance != no_instance) [[unlikely]]
    return impl_->point_of_others(record, ray, hit);
  return mesh_point(*record.mesh, hit);
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
size_t RayTracer::shape_count() const { return impl_->records.size(); }
const Geometry& RayTracer::geometry() const { return impl_->geometry; }
Bounds3f RayTracer::bounds() const { return impl_->bounds; }
uint64_t RayTracer::refused_rays() const { return impl_->refused_rays; }
float RayTracer::largest_coordinate() const { return impl_->largest_coordinate; }
size_t RayTracer::size_in_bytes() const { return size_t(std::max<int64_t>(0, impl_->bytes)); }
void* RayTracer::embree_scene() const { return impl_->scene; }

}  // namespace kaustik
