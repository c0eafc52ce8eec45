#include "kaustik/base/warp.h"

namespace kaustik {

namespace {

/// Sine and cosine for |x| ≤ π/4 by Taylor's series, within 4e-7: all that the concentric map
/// needs.
struct SineCosine {
  float sine, cosine;
};
SineCosine sine_cosine_small(float x) {
  const float s = x * x;
  return {x * (1 + s * (-1.0f / 6 + s * (1.0f / 120 - s * (1.0f / 5040)))),
          1 + s * (-0.5f + s * (1.0f / 24 + s * (-1.0f / 720 + s * (1.0f / 40320))))};
}

}  // namespace

Vec2f square_to_disk(const Vec2f& u) {
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

Vec2f disk_to_square(const Vec2f& p) {
  const float r = std::sqrt(p.x * p.x + p.y * p.y);
  float phi = std::atan2(p.y, p.x);
  if (phi < -0.25f * pi) phi += 2.0f * pi;
  float a, b;
  if (phi < 0.25f * pi) {
    a = r;
    b = phi * a / (0.25f * pi);
  } else if (phi < 0.75f * pi) {
    b = r;
    a = -(phi - 0.5f * pi) * b / (0.25f * pi);
  } else if (phi < 1.25f * pi) {
    a = -r;
    b = (phi - pi) * a / (0.25f * pi);
  } else {
    b = -r;
    a = -(phi - 1.5f * pi) * b / (0.25f * pi);
  }
  return {0.5f * (a + 1.0f), 0.5f * (b + 1.0f)};
}

Vec3f square_to_sphere(const Vec2f& u) {
  const float z = 1.0f - 2.0f * u.x;
  const float r = safe_sqrt(1.0f - z * z);
  const float phi = 2.0f * pi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

Vec3f square_to_cone(const Vec2f& u, float one_minus_cos) {
  const float h = u.x * one_minus_cos;  // 1 − cosθ
  const float r = safe_sqrt(h * (2.0f - h));
  const float phi = 2.0f * pi * u.y;
  return {r * std::cos(phi), r * std::sin(phi), 1.0f - h};
}

}  // namespace kaustik
