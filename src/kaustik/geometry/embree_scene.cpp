#include "kaustik/geometry/embree_scene.h"

#include <algorithm>
#include <utility>

#include "kaustik/base/thread_order.h"

namespace kaustik {
namespace {

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

/// Lane `i` of a packet of `n` rays.
Ray ray_of(RTCRayN* rays, unsigned n, unsigned i) {
  return {{RTCRayN_org_x(rays, n, i), RTCRayN_org_y(rays, n, i), RTCRayN_org_z(rays, n, i)},
          {RTCRayN_dir_x(rays, n, i), RTCRayN_dir_y(rays, n, i), RTCRayN_dir_z(rays, n, i)},
          RTCRayN_tfar(rays, n, i)};
}

/// Embree's tasks call it, on any thread, while a structure is built.
void shape_bounds(const RTCBoundsFunctionArguments* arguments) {
  happens_after(arguments->geometryUserPtr);
  const Bounds3f b = static_cast<const Shape*>(arguments->geometryUserPtr)->bounds();
  happens_before(arguments->geometryUserPtr);
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

}  // namespace

EmbreeDevice::EmbreeDevice() : device_(rtcNewDevice(nullptr)) {
  if (!device_) throw error_of(rtcGetDeviceError(nullptr), "no device");
  happens_before(this);
  rtcSetDeviceErrorFunction(device_, on_error, this);
  rtcSetDeviceMemoryMonitorFunction(device_, on_memory, this);
}

EmbreeDevice::~EmbreeDevice() {
  if (!has_failed_) {
    rtcReleaseDevice(device_);
    return;
  }
  rtcSetDeviceErrorFunction(device_, nullptr, nullptr);
  rtcSetDeviceMemoryMonitorFunction(device_, nullptr, nullptr);
}

void EmbreeDevice::on_error(void* self, RTCError code, const char* text) {
  happens_after(self);
  auto& device = *static_cast<EmbreeDevice*>(self);
  const std::lock_guard lock(device.error_mutex_);
  if (device.error_code_ != RTC_ERROR_NONE) return;
  device.error_code_ = code;
  device.error_text_ = text ? text : "";
  device.has_failed_ = true;
}

bool EmbreeDevice::on_memory(void* self, ssize_t bytes, bool) {
  happens_after(self);
  static_cast<EmbreeDevice*>(self)->bytes_ += int64_t(bytes);
  return true;
}

void EmbreeDevice::check() {
  const std::lock_guard lock(error_mutex_);
  if (error_code_ == RTC_ERROR_NONE) return;
  throw error_of(error_code_, error_text_);
}

EmbreeScene::EmbreeScene(std::shared_ptr<EmbreeDevice> device, Shapes shapes,
                         std::vector<Placement> placements)
    : device_(std::move(device)), shapes_(std::move(shapes)), placements_(std::move(placements)) {
  const std::lock_guard lock(device_->mutex());
  const int64_t before = device_->bytes();
  try {
    build();
  } catch (...) {
    if (scene_ && !device_->has_failed()) rtcReleaseScene(scene_);
    throw;
  }
  bytes_ = device_->bytes() - before;
}

EmbreeScene::~EmbreeScene() {
  const std::lock_guard lock(device_->mutex());
  if (!device_->has_failed()) rtcReleaseScene(scene_);
}

void EmbreeScene::build() {
  scene_ = rtcNewScene(device_->get());
  device_->check();
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  // HIGH is the one quality whose result depends on the order of threads.
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_MEDIUM);
  for (const auto& shape : shapes_) {
    const TriangleMesh* mesh = shape->mesh();
    attach(mesh ? mesh_geometry(*mesh) : user_geometry(*shape));
  }
  for (const Placement& placement : placements_) attach(instance_geometry(placement));
  rtcCommitScene(scene_);
  for (const auto& shape : shapes_) happens_after(shape.get());
  device_->check();
}

void EmbreeScene::attach(RTCGeometry part) {
  rtcCommitGeometry(part);
  rtcAttachGeometry(scene_, part);
  rtcReleaseGeometry(part);
  device_->check();
}

RTCGeometry EmbreeScene::mesh_geometry(const TriangleMesh& mesh) {
  RTCGeometry part = rtcNewGeometry(device_->get(), RTC_GEOMETRY_TYPE_TRIANGLE);
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

RTCGeometry EmbreeScene::user_geometry(const Shape& shape) {
  happens_before(&shape);
  RTCGeometry part = rtcNewGeometry(device_->get(), RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(part, 1);
  rtcSetGeometryUserData(part, const_cast<Shape*>(&shape));
  rtcSetGeometryBoundsFunction(part, shape_bounds, nullptr);
  rtcSetGeometryIntersectFunction(part, intersect_shape);
  rtcSetGeometryOccludedFunction(part, occluded_by_shape);
  return part;
}

RTCGeometry EmbreeScene::instance_geometry(const Placement& placement) {
  RTCGeometry part = rtcNewGeometry(device_->get(), RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(part, placement.scene->get());
  rtcSetGeometryTransform(part, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, placement.columns.data());
  return part;
}

}  // namespace kaustik
