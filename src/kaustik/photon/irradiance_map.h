#pragma once
#include "kaustik/photon/photon_map.h"

namespace kaustik {

/// A place on a surface, and on which side of it.
struct SurfaceSide {
  Vec3f position;
  CoarseNormal side;
};

/// Irradiance computed once at many places and looked up at the nearest of them (Christensen,
/// "Faster Photon Map Global Illumination", JGT 1999): what gather rays need, at a small part of
/// the cost of an estimate at every hit. The places must not be the map's own photons: the nearest
/// of those to a given point tend to be those in sparse surroundings, which made the light 2 % too
/// dark. Immutable.
class IrradianceMap {
 public:
  IrradianceMap() = default;
  /// In parallel, the same for any number of threads. Photons that the surfaces of `scene`, if
  /// there is one, hide from a place do not count there. Where `stop` is requested the map is left
  /// empty.
  IrradianceMap(const PhotonMap& map, const std::vector<SurfaceSide>& places,
                const EstimateSettings& settings, const Scene* scene = nullptr,
                const std::stop_token& stop = {});

  bool empty() const { return tree_.empty(); }
  /// That told what is hidden.
  uint64_t rays() const { return rays_; }
  size_t size_in_bytes() const { return tree_.size_in_bytes(); }
  /// Irradiance W/m² at the nearest place on the side `side` (geometric normal); false if there is
  /// none within the maximum radius of the estimates. (Not within the radius of that place's own
  /// estimate: bright places have small ones, so that would favour dark places.) With `sight`, of
  /// the position, the nearest of the next few that it sees.
  bool lookup(const Vec3f& position, const Vec3f& side, Spectrum& irradiance, Scratch& scratch,
              const SurfaceSight* sight = nullptr) const;

 private:
  struct Entry {
    StoredSpectrum irradiance;
    CoarseNormal side;
    uint8_t on_front = 1;  ///< places ask for their own side alone
  };
  SidedTree<Entry> tree_;
  float maximum_radius_ = 0;
  uint64_t rays_ = 0;
};

}  // namespace kaustik
