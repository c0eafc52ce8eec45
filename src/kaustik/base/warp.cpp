#include "kaustik/base/warp.h"

namespace kaustik {

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
