#pragma once
// Single rays in Embree's form.

#include <limits>

#include "kaustik/geometry/embree_scene.h"

namespace kaustik {

inline void fill(RTCRay& out, const Ray& ray) {
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

}  // namespace kaustik
