#pragma once
// Maps from the unit square to other domains, each with its density.

#include "kaustik/base/vec.h"

namespace kaustik {

/// Sine and cosine for |x| ≤ π/4 by Taylor's series, within 4e-7: all that the concentric map
/// needs.
struct SineCosine {
  float sine, cosine;
};
inline SineCosine sine_cosine_small(float x) {
  const float s = x * x;
  return {x * (1 + s * (-1.0f / 6 + s * (1.0f / 120 - s * (1.0f / 5040)))),
          1 + s * (-0.5f + s * (1.0f / 24 + s * (-1.0f / 720 + s * (1.0f / 40320))))};
}

/// Uniform on the unit disk (Shirley and Chiu 1997, concentric); density 1/π per area.
inline Vec2f square_to_disk(const Vec2f& u) {
  const float a = 2.0f * u.x - 1.0f, b = 2.0f * u.y - 1.0f;
  if (a == 0.0f && b == 0.0f) return {0.0f, 0.0f};
  // The angle is at most π/4 away from the axis of the larger coordinate.
  if (std::fabs(a) > std::fabs(b)) {
    const auto [sine, cosine] = sine_cosine_small(0.25f * pi * (b / a));
    return {a * cosine, a * sine};
  }
  const auto [sine, cosine] = sine_cosine_small(0.25f * pi * (a / b));
  return {b * sine, b * cosine};
}
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
