#pragma once
#include "kaustik/base/sampler.h"
#include "kaustik/photon/photon_map.h"

namespace kaustik {

/// Around a vertex, on the side from which it is seen, the places where photons may lie.
struct PhotonSurroundings {
  const Scene& scene;
  const SurfaceVertex& vertex;
  /// Surfaces keep photons if they have any of these lobes.
  Lobes keeping;
};

/// One point less than this is tried at most: more would cost more than small shares are worth.
inline constexpr int most_covering_tries = 16;

/// An estimate of one over the share of a disk around the vertex, by the weights of the kernel,
/// where a surface that keeps photons is seen from over the vertex, as far below its plane as the
/// radius. Times it an estimate of density does not lose what would lie beyond the end of the
/// surface or behind a wall. A step that is less deep counts as covered: some of its photons do not
/// count, the more the deeper it is. In the mean it is (1 − (1 − p)^16)/p of a share p: 1 % too
/// little at a quarter, a corner, and 19 % at a tenth.
///
/// `asked`, in (0, 1]: the chance of looking at all, for disks that are likely to be whole. Without
/// a look the answer is 1; what a look finds above 1 is divided by `asked`, so the mean stays.
/// Counts its rays, of which a disk that is whole takes one at most.
float inverse_covered_share(const PhotonSurroundings& around, const EstimateSettings& kernel,
                            float radius, float asked, Sampler numbers, uint64_t& rays);

}  // namespace kaustik
