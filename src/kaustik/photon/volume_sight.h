#pragma once
#include <vector>

#include "kaustik/photon/disc_hierarchy.h"
#include "kaustik/scene/scene.h"

namespace kaustik {

/// What one disc in a medium sends along a segment that meets it.
struct VolumePart {
  size_t disc;     ///< of the hierarchy
  Vec3f position;  ///< of the segment, in the disc
  Spectrum light;
};

/// Leaves of `sum`, the light of these parts, what nothing hides from the segment: by `u` in [0, 1)
/// one disc's centre is drawn, which tells for all (LaneDraw). Counts rays.
Spectrum visible_from_segment(const Scene& scene, const DiscHierarchy& discs,
                              const std::vector<VolumePart>& parts, const Spectrum& sum, float u,
                              uint64_t& rays);

}  // namespace kaustik
