#include "kaustik/transport/visible_normal.h"

namespace kaustik {
namespace {

/// No bent normal leans over by more, in radians.
constexpr float largest_lean = 1.5f;

}  // namespace

Vec3f visible_normal(const Vec3f& bent, const Vec3f& ng, const Vec3f& wo, bool mirrors) {
  const float side = dot(wo, ng) < 0 ? -1.0f : 1.0f;
  const Vec3f z = ng * side, n = bent * side;
  const Vec3f across = n - z * dot(n, z);
  const float across_length = length(across);
  if (!(across_length > 1e-6f)) return ng;
  const Vec3f x = across * (1 / across_length);
  // In the plane of the two normals: n leans from z toward x by the angle a, wo's part in it by φ.
  const float a = std::atan2(across_length, dot(n, z));
  const float wo_z = dot(wo, z), wo_x = dot(wo, x);
  const float rho = std::hypot(wo_x, wo_z);
  if (!(rho > 0)) return ng;
  const float phi = std::atan2(wo_x, wo_z);
  // dot(wo, n) is ρ cos(a − φ), and the mirror direction rises by ρ cos(2a − φ) over the surface;
  // both have to stay over a little.
  const float least = std::min(0.5f * wo_z, 0.01f);
  const float reach = std::acos(std::min(least / rho, 1.0f)) + phi;
  const float limit = std::min(mirrors ? 0.5f * reach : reach, largest_lean);
  if (a <= limit) return bent;
  return (z * std::cos(limit) + x * std::sin(limit)) * side;
}

}  // namespace kaustik
