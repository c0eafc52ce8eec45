#pragma once
#include <stop_token>

#include "kaustik/base/scratch.h"
#include "kaustik/vcm/light_vertices.h"

namespace kaustik {

/// Irradiance by light that has been scattered diffusely before it arrives, at places all over the
/// surfaces: what gather rays look up where they end (Christensen, "Faster Photon Map Global
/// Illumination", JGT 1999). Places are light vertices of some paths; those of the others tell the
/// irradiance there. Were they the same, places in sparse surroundings would be looked up more
/// often than others, and the light be too dark. For the same reason all disks are alike.
/// Immutable.
class ScatteredLight {
 public:
  ScatteredLight() = default;
  /// In parallel, the same for any number of threads. The area of disks has shrunk to `shrinkage`
  /// of that in the first pass. Where `stop` is requested it is left empty.
  ScatteredLight(const LightVertices& light, float shrinkage, const std::stop_token& stop = {});

  bool empty() const { return tree_.empty(); }
  /// Irradiance, W/m², at a place near `position` on the side `normal` (geometric, unit) of the
  /// surface; false if none is near, or who looks is, m: from nearby one sees how disks blur.
  bool lookup(const Vec3f& position, const Vec3f& normal, float distance, Scratch& scratch,
              Spectrum& irradiance) const;

 private:
  struct Place {
    StoredSpectrum irradiance;
    CoarseNormal side;
    uint8_t on_front = 1;   ///< places ask for their own side alone
    bool is_whole = false;  ///< the disk is all surface
  };
  class Builder;
  SidedTree<Place> tree_;
  float radius_ = 0;          ///< of disks, m
  float least_distance_ = 0;  ///< of who looks, m: it grows as disks shrink, so all bias vanishes
};

}  // namespace kaustik
