#pragma once
// Vectors, bounds and frames. The types are Imath's, the platform's own; this file adds the
// free functions that transport code reads best with.

#include <Imath/ImathBox.h>
#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace kaustik {

using Vec2f = Imath::V2f;
using Vec2i = Imath::V2i;
using Vec3f = Imath::V3f;
using Vec3d = Imath::V3d;
using Bounds3f = Imath::Box3f;  ///< empty until extended

inline constexpr float pi = std::numbers::pi_v<float>;
inline constexpr float inv_pi = std::numbers::inv_pi_v<float>;
inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline constexpr float one_minus_epsilon = 0x1.fffffep-1f;  ///< largest float below 1

inline float dot(const Vec3f& a, const Vec3f& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline float abs_dot(const Vec3f& a, const Vec3f& b) { return std::fabs(dot(a, b)); }
inline Vec3f cross(const Vec3f& a, const Vec3f& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float length_sq(const Vec3f& v) { return dot(v, v); }
inline float length(const Vec3f& v) { return std::sqrt(length_sq(v)); }
/// `v` must not be zero.
inline Vec3f normalize(const Vec3f& v) { return v * (1.0f / length(v)); }
template <typename T>
constexpr T sqr(T x) {
  return x * x;
}
inline float safe_sqrt(float x) { return std::sqrt(std::max(0.0f, x)); }
inline float max_abs(const Vec3f& v) {
  return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
}
inline bool is_finite(const Vec3f& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
/// The mirror image of `w` about `n`, both pointing away from the surface.
inline Vec3f reflect(const Vec3f& w, const Vec3f& n) { return n * (2.0f * dot(w, n)) - w; }

inline Vec3f center(const Bounds3f& b) { return (b.min + b.max) * 0.5f; }
/// Radius of the sphere around the centre that holds the box.
inline float bounding_radius(const Bounds3f& b) { return 0.5f * length(b.max - b.min); }
inline float surface_area(const Bounds3f& b) {
  const Vec3f d = b.max - b.min;
  return 2.0f * (d.x * d.y + d.y * d.z + d.z * d.x);
}

/// Right-handed orthonormal frame whose z axis is a given unit vector.
struct Frame {
  Vec3f x, y, z;

  Frame() : x(1, 0, 0), y(0, 1, 0), z(0, 0, 1) {}
  /// Branchless basis of Duff et al., "Building an Orthonormal Basis, Revisited" (JCGT 2017).
  explicit Frame(const Vec3f& normal) : z(normal) {
    const float sign = std::copysign(1.0f, normal.z);
    const float a = -1.0f / (sign + normal.z);
    const float b = normal.x * normal.y * a;
    x = {1.0f + sign * normal.x * normal.x * a, sign * b, -sign * normal.x};
    y = {b, sign + normal.y * normal.y * a, -normal.y};
  }
  Vec3f to_local(const Vec3f& v) const { return {dot(v, x), dot(v, y), dot(v, z)}; }
  Vec3f to_world(const Vec3f& v) const { return x * v.x + y * v.y + z * v.z; }
};

}  // namespace kaustik
