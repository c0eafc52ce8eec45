#pragma once
#include <stop_token>

#include "kaustik/base/scratch.h"
#include "kaustik/vcm/light_vertices.h"

namespace kaustik {

/// Irradiance by light that has been scattered diffusely before it arrives, at places all over the
/// surfaces: what gather rays look up where they end (Christensen, "Faster Photon Map Global
/// Illumination", JGT 1999). Places are light vertices of some paths; those of the others tell the
/// irradiance there. Were they the same, places in sparse surroundings would be looked up more
/// often than others, and the light be too dark. Immutable.
class ScatteredLight {
 public:
  ScatteredLight() = default;
  /// In parallel, the same for any number of threads. Disks hold as many vertices as in the first
  /// pass times `shrinkage`, by which their areas shrink. Where `stop` is requested it is left
  /// empty.
  ScatteredLight(const LightVertices& light, float shrinkage, const std::stop_token& stop = {});

  bool empty() const { return tree_.empty(); }
  /// Irradiance, W/m², at a place near `position` on the side `normal` (geometric, unit) of the
  /// surface; false if that does not tell enough for who looks from so far away, m: the disk in
  /// which its light was found is to be small beside that.
  bool lookup(const Vec3f& position, const Vec3f& normal, float distance, Scratch& scratch,
              Spectrum& irradiance) const;

 private:
  struct Place {
    StoredSpectrum irradiance;
    float radius = 0;  ///< of the disk, m
    CoarseNormal side;
    uint8_t on_front = 1;  ///< places ask for their own side alone
  };
  SidedTree<Place> tree_;
  float reach_ = 0;  ///< places farther off are not looked for, m
};

}  // namespace kaustik
