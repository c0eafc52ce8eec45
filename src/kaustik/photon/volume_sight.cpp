#include "kaustik/photon/volume_sight.h"

#include "kaustik/photon/lane_draw.h"
#include "kaustik/transport/visibility.h"

namespace kaustik {

Spectrum visible_from_segment(const Scene& scene, const DiscHierarchy& discs,
                              const std::vector<VolumePart>& parts, const Spectrum& sum, float u,
                              uint64_t& rays) {
  LaneDraw draw(sum, u);
  for (size_t i = 0; i < parts.size(); ++i) draw.offer(i, parts[i].light);
  return draw.remaining(sum, [&](size_t i) {
    const Vec3f to = discs.center(parts[i].disc) - parts[i].position;
    return !(length_sq(to) > 0) || is_unobstructed(scene, {parts[i].position, to, 1}, rays);
  });
}

}  // namespace kaustik
