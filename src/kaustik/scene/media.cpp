#include "kaustik/scene/media.h"

#include <fmt/format.h>

#include <map>

#include "kaustik/base/warp.h"
#include "kaustik/scene/look_through.h"

namespace kaustik {
namespace {

/// Surfaces that one probing ray may pass.
constexpr int longest_probe = 256;

/// Follows a straight ray through all that transmits light and calls `visit(surface, outside)` at
/// every boundary of media (outside: the ray comes from the side of the normal) until that answers
/// false.
template <typename Visit>
void probe(const Scene& scene, const Ray& ray, const Visit& visit) {
  probe_through(
      scene, ray, longest_probe, [&](const SurfacePoint& point, const Hit&, const Ray& segment) {
        const Surface& surface = scene.surface(point.shape);
        const bool goes_on =
            !surface.separates_media() || visit(surface, dot(point.ng, segment.direction) < 0);
        return !goes_on || !surface.traits.transmits;
      });
}

}  // namespace

const Medium* find_medium(const Scene& scene, const SurfacePoint& point, const Medium* otherwise) {
  constexpr int directions = 32;
  std::map<const Medium*, int> votes;
  const Medium* best = otherwise;
  int most = 0;
  for (int i = 0; i < directions; ++i) {
    // Spirals over the sphere: even enough, and never along the axes.
    Vec3f direction = square_to_sphere(
        {(float(i) + 0.5f) / directions, std::fmod(float(i) * 0.61803399f + 0.1f, 1.0f)});
    if (dot(direction, point.ng) < 0) direction = -direction;
    probe(scene, spawn_ray(point, direction), [&](const Surface& surface, bool outside) {
      const Medium* medium = outside ? surface.exterior.get() : surface.interior.get();
      if (++votes[medium] > most) most = votes[medium], best = medium;
      return false;
    });
  }
  return best;
}

std::string contradicting_media(const Scene& scene) {
  if (!scene.has_media()) return {};
  constexpr int grid = 16;
  const Vec2i size = scene.film().crop_size;
  int contradictions = 0;
  std::string first;
  for (int y = 0; y < grid; ++y)
    for (int x = 0; x < grid; ++x) {
      const Vec2f raster((float(x) + 0.5f) / grid * float(size.x),
                         (float(y) + 0.5f) / grid * float(size.y));
      const Medium* medium = scene.camera_medium();
      bool crossed = false, wrong = false;
      const CameraRay ray = scene.camera().sample_ray(
          raster, scene.camera().numbers_to_look_around(uint32_t(y * grid + x)));
      if (ray.is_none()) continue;
      probe(scene, ray, [&](const Surface& surface, bool outside) {
        const Medium* expected = outside ? surface.exterior.get() : surface.interior.get();
        if (expected != medium && !wrong) {
          wrong = true;
          if (first.empty())
            first = fmt::format(
                "{} of '{}', {}", outside ? "the exterior" : "the interior", surface.name,
                crossed ? "though the ray did not come that way: is a mesh not closed?"
                        : "but that is not the sensor's medium: does the sensor lack a "
                          "medium, or is the mesh around it not closed?");
        }
        crossed = true;
        medium = outside ? surface.interior.get() : surface.exterior.get();
        return true;
      });
      if (wrong) ++contradictions;
    }
  if (contradictions == 0) return {};
  return fmt::format(
      "media contradict one another along {} of {} rays of the camera: one arrives in {}",
      contradictions, grid * grid, first);
}

}  // namespace kaustik
