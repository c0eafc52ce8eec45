#include "kaustik/photonmap/covered_disk.h"

#include <cmath>

#include "kaustik/photon/coverage/covered_share.h"
#include "kaustik/photon/coverage/look_through.h"

namespace kaustik {
namespace {

/// Share of the radius: height over the vertex from which its surroundings are seen.
constexpr float height_share = 0.5f;
/// Cosine between the vertex's normal and those of surfaces whose photons count.
constexpr float least_cosine = 0.05f;

/// Whether the first surface that the ray meets, but for those that light passes through, keeps
/// photons on that side.
bool finds_photons(const PhotonSurroundings& around, const Vec3f& side, const Ray& ray,
                   uint64_t& rays) {
  bool found = false;
  look_through(around.scene, ray, rays, [&](const SurfacePoint& point, const Hit&) {
    const Surface& surface = around.scene.surface(point.shape);
    const bool keeps = any(surface.traits.lobes & around.keeping);
    const float cosine =
        dot(point.ng, ray.direction) < 0 ? dot(point.ng, side) : -dot(point.ng, side);
    found = keeps && cosine > least_cosine;
    return keeps || !surface.traits.transmits;
  });
  return found;
}

}  // namespace

float inverse_covered_share(const PhotonSurroundings& around, const EstimateSettings& kernel,
                            float radius, float asked, Sampler numbers, uint64_t& rays) {
  if (asked < 1 && !(numbers.next_1d() < asked)) return 1;
  const SurfaceVertex& vertex = around.vertex;
  const Frame frame(vertex.on_front() ? vertex.point().ng : -vertex.point().ng);
  const Vec3f over = spawn_ray(vertex.point(), frame.z).origin + frame.z * (height_share * radius);
  const int tries = tries_until_held(most_covering_tries, most_covering_tries, [&] {
    const Vec2f u = numbers.next_2d();
    const float distance = radius * kernel_distance(kernel, u.x), angle = 2 * pi * u.y;
    const Vec3f aim = vertex.position() + frame.x * (distance * std::cos(angle)) +
                      frame.y * (distance * std::sin(angle));
    const float way = length(aim - over);
    // As deep below the plane as photons may count.
    const Ray ray{over, (aim - over) * (1 / way), way * (1 + 1 / height_share)};
    return finds_photons(around, frame.z, ray, rays) ? CoveredPoint::held : CoveredPoint::covered;
  });
  return 1 + float(tries - 1) / asked;
}

}  // namespace kaustik
