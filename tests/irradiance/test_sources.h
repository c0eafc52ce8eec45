#pragma once
// Sources of radiance in closed form.

#include "kaustik/irradiance/hemisphere.h"

namespace kaustik::test {

inline SurfacePoint surface_point(const Vec3f& position, const Vec3f& normal) {
  SurfacePoint p{};
  p.position = position;
  p.ng = p.ns = normal;
  return p;
}

/// The same radiance from everywhere, at one distance.
class UniformSource : public RadianceSource {
 public:
  explicit UniformSource(const Spectrum& radiance, float distance = infinity)
      : radiance_(radiance), distance_(distance) {}
  Incoming incoming(const SurfacePoint&, const Vec3f&, Sampler&) const override {
    return {radiance_, distance_};
  }

 private:
  Spectrum radiance_;
  float distance_;
};

/// The inside of the box [0, 1]³ whose walls glow in smooth coloured patterns, with a dark ball in
/// it that casts shadows.
class RoomSource : public RadianceSource {
 public:
  Vec3f ball_center{0.6f, 0.45f, 0.35f};
  float ball_radius = 0.15f;

  Incoming incoming(const SurfacePoint& from, const Vec3f& d, Sampler&) const override {
    const Vec3f& o = from.position;
    float t = infinity;
    int axis = 0;
    for (int i = 0; i < 3; ++i) {
      if (d[i] == 0) continue;
      const float wall = ((d[i] > 0 ? 1.0f : 0.0f) - o[i]) / d[i];
      if (wall > 1e-6f && wall < t) t = wall, axis = i;
    }
    const Vec3f to_ball = ball_center - o;
    const float along = dot(to_ball, d);
    const float root = sqr(along) - length_sq(to_ball) + sqr(ball_radius);
    if (root > 0 && along > std::sqrt(root) + 1e-5f && along - std::sqrt(root) < t)
      return {Spectrum(0.02f, 0.02f, 0.02f, 0), along - std::sqrt(root)};
    if (t == infinity) return {};
    return {wall_radiance(o + d * t, axis, d[axis] > 0), t};
  }

  static Spectrum wall_radiance(const Vec3f& p, int axis, bool far) {
    const float wave = std::sin(5 * p.x + 1) * std::sin(4 * p.y) * std::cos(3 * p.z);
    Spectrum s(0.3f + 0.2f * wave, 0.3f + 0.1f * float(axis), 0.2f, 0);
    if (axis == 2 && far && std::fabs(p.x - 0.4f) < 0.2f && std::fabs(p.y - 0.5f) < 0.2f)
      s += Spectrum(8, 6, 4, 0);  // a window in the ceiling
    return s;
  }
};

/// Black but for a Lambertian rectangle in the plane z = height, which shines on what lies below.
class RectangleSource : public RadianceSource {
 public:
  Vec2f low{0.1f, -0.3f}, high{0.7f, 0.4f};
  float height = 0.5f;

  Incoming incoming(const SurfacePoint& from, const Vec3f& d, Sampler&) const override {
    const float t = (height - from.position.z) / d.z;
    if (!(t > 0)) return {};
    const Vec3f p = from.position + d * t;
    const bool lit = p.x > low.x && p.x < high.x && p.y > low.y && p.y < high.y;
    return {lit ? Spectrum(1, 2, 0.5f, 0) : Spectrum(), t};
  }

  /// ∫ cosθ dω over the rectangle by Lambert's formula for polygons (1760), exact while the whole
  /// rectangle is above the horizon.
  double form_integral(const Vec3d& at, const Vec3d& normal) const {
    const Vec3d corners[4] = {{low.x, low.y, height},
                              {low.x, high.y, height},
                              {high.x, high.y, height},
                              {high.x, low.y, height}};
    Vec3d sum(0, 0, 0);
    for (int i = 0; i < 4; ++i) {
      const Vec3d a = (corners[i] - at).normalized();
      const Vec3d b = (corners[(i + 1) % 4] - at).normalized();
      const Vec3d c = a.cross(b);
      sum += c * (std::atan2(c.length(), a.dot(b)) / c.length());
    }
    return std::fabs(0.5 * sum.dot(normal));
  }
};

/// A plane that glows evenly high above, half hidden by a black rectangle in front of it.
class HiddenSkySource : public RadianceSource {
 public:
  RectangleSource screen;
  float sky_height = 3;

  Incoming incoming(const SurfacePoint& from, const Vec3f& d, Sampler& sampler) const override {
    const Incoming hit = screen.incoming(from, d, sampler);
    if (!hit.radiance.is_zero()) return {Spectrum(), hit.distance};
    return {Spectrum(1), (sky_height - from.position.z) / d.z};
  }

  /// Irradiance while the normal looks straight at the plane.
  double irradiance(const Vec3d& at, const Vec3d& normal) const {
    return double(pi) - screen.form_integral(at, normal);
  }
};

}  // namespace kaustik::test
