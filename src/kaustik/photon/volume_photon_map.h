#pragma once
#include <vector>

#include "kaustik/photon/disc_hierarchy.h"
#include "kaustik/photon/photon.h"
#include "kaustik/scene/scene.h"
#include "kaustik/transport/volume_light.h"

namespace kaustik {

/// Flux that a medium scatters at a point.
struct VolumePhoton {
  Vec3f position{0, 0, 0};
  float radius = 0;           ///< of its disc, m; set by the map
  Spectrum flux;              ///< W, what is not scattered already taken off
  PackedDirection direction;  ///< toward where it came from
  const Medium* medium = nullptr;
};

/// Volume photons in a hierarchy of discs, and the beam radiance estimate (Jarosz, Zwicker and
/// Jensen 2008): all photons whose disc, facing the ray, is met by a segment count at once, without
/// steps along it. The radius of a disc is the distance of the photon's k-th nearest neighbour, so
/// light that is focused stays sharp. Immutable; deterministic; estimates are thread-safe.
class VolumePhotonMap final : public VolumeLight {
 public:
  VolumePhotonMap() = default;
  /// `neighbors` ≥ 1; all radii are multiplied by `shrinkage`. Photons that the surfaces of
  /// `scene`, if there is one, hide from a segment do not count there.
  VolumePhotonMap(std::vector<VolumePhoton> photons, int neighbors, float shrinkage = 1,
                  const Scene* scene = nullptr);

  size_t size() const { return photons_.size(); }
  bool empty() const { return photons_.empty(); }
  /// In the map's order.
  const std::vector<VolumePhoton>& photons() const { return photons_; }

  /// Σ Φ p(θ) T(s) K(d/r)/r² over the photons of `medium` whose foot on the ray lies within the
  /// segment, with the biweight kernel K = 3/π (1 − d²/r²)² (eq. 12 of the paper; Φ is scattered
  /// flux here, which holds its σ_s/σ_t).
  Spectrum radiance(const Ray& ray, float length, const Medium& medium,
                    const Wavelengths& wavelengths, const Sampler& sampler,
                    const Work& work) const override;

 private:
  void order_photons(std::vector<VolumePhoton> photons, int neighbors, float shrinkage);

  std::vector<VolumePhoton> photons_;
  DiscHierarchy discs_;
  const Scene* scene_ = nullptr;
};

}  // namespace kaustik
