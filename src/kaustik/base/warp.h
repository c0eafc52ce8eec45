#pragma once
// Maps from the unit square to other domains, each with its density.

#include "kaustik/base/vec.h"

namespace kaustik {

/// Uniform on the unit disk (Shirley and Chiu 1997, concentric); density 1/π per area.
Vec2f square_to_disk(const Vec2f& u);
/// Inverse of square_to_disk.
Vec2f disk_to_square(const Vec2f& p);

/// About +z with density cosθ/π per solid angle.
inline Vec3f square_to_cosine_hemisphere(const Vec2f& u) {
  const Vec2f d = square_to_disk(u);
  return {d.x, d.y, safe_sqrt(1.0f - d.x * d.x - d.y * d.y)};
}
inline float cosine_hemisphere_pdf(float cos_theta) { return std::max(0.0f, cos_theta) * inv_pi; }

/// Uniform on the unit sphere; density 1/(4π).
Vec3f square_to_sphere(const Vec2f& u);
inline constexpr float sphere_pdf = 0.25f * inv_pi;

/// Uniform in the cone about +z given by 1 − cos of its half angle (exact for tiny cones);
/// density 1/(2π one_minus_cos) inside.
Vec3f square_to_cone(const Vec2f& u, float one_minus_cos);
inline float cone_pdf(float one_minus_cos) { return 1.0f / (2.0f * pi * one_minus_cos); }

/// Uniform barycentric coordinates (of the second and third corner).
inline Vec2f square_to_triangle(const Vec2f& u) {
  const float s = std::sqrt(u.x);
  return {s * (1.0f - u.y), s * u.y};
}

/// Position in [−1, 1] with density 1 − |x|.
inline float unit_to_tent(float u) {
  return u < 0.5f ? std::sqrt(2.0f * u) - 1.0f : 1.0f - std::sqrt(2.0f - 2.0f * u);
}

}  // namespace kaustik
