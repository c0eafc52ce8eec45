#pragma once
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "kaustik/base/progress.h"
#include "kaustik/photon/drawn_photons.h"
#include "kaustik/photon/emission/emission.h"
#include "kaustik/photon/irradiance_map.h"
#include "kaustik/photon/photon_map.h"
#include "kaustik/photon/volume_photon_map.h"
#include "kaustik/transport/light_path.h"

namespace kaustik {

/// A share of the photons of a pass, for several machines: part `index` of `count`. Each part holds
/// photons of its own; all together are those of the whole pass.
struct PhotonPart {
  static constexpr uint32_t maximum_count = 65536;
  uint32_t index = 0, count = 1;
  bool is_whole() const { return count == 1; }
};

/// What a light pass is asked for.
struct LightPassSettings {
  uint32_t global_photons = 0;     ///< to emit; 0: no global map
  uint32_t caustic_photons = 0;    ///< to emit; 0: no caustic map
  uint32_t volume_photons = 0;     ///< to emit for the light in media; 0: none
  int maximum_events = 1 << 20;    ///< scattering events of a light path
  Lobes traced = Lobes::specular;  ///< lobes whose events count as specular (G)
  bool reradiate = false;          ///< caustic photons go on as global ones
  Aim aim = default_aim;           ///< how caustic photons are aimed at specular objects
  /// One place where global photons land, for looking up irradiance, for so many global photons;
  /// 0: none.
  uint32_t place_stride = 0;
  int target_budget = default_target_budget;  ///< boxes that these are divided into for aiming
  PhotonPart part;  ///< that is traced; the flux is that of the whole, so a part alone is dark
};

/// What became of the photons of one light.
struct LightCounts {
  uint64_t emitted = 0;  ///< tries, those that carry nothing included
  uint64_t stored = 0;   ///< photons in the map
  uint64_t nothing = 0;  ///< emitted rays without flux (aimed below the horizon)
  uint64_t arrived = 0;  ///< of those for the global map: came to a surface
  uint64_t escaped = 0;  ///< left the scene
  uint64_t absorbed = 0;
  uint64_t too_long = 0;   ///< reached the limit of events
  uint64_t stopped = 0;    ///< came to a surface that does not send them on: caustic photons to one
                           ///< without specular lobes
  double stored_flux = 0;  ///< W over all stored photons
  void add(const LightCounts& other);
};

/// How a map came about.
struct MapReport {
  std::vector<LightCounts> lights;  ///< parallel to the scene's lights
  uint64_t rays = 0;
  size_t target_count = 0;  ///< objects' boxes that were aimed at
  LightCounts total() const;
};

/// Whether the global map is empty because light comes to surfaces, but from none to another: as in
/// the open, where there is no indirect light.
bool nothing_lit_twice(const MapReport& global);

/// The maps of one pass.
struct PhotonMaps {
  PhotonMap global, caustic;
  std::vector<SurfaceSide> places;  ///< where other global photons landed
  /// Where media scatter light, for every segment of the light paths made for that; not in a map
  /// yet: their radii are the integrator's.
  std::vector<VolumePhoton> volume;
  /// What caustic photons bring to the camera's gauges on their way, W/m² for each; empty: nobody
  /// asked.
  std::vector<Spectrum> gauges;
  MapReport global_report, caustic_report, volume_report;
  double trace_seconds = 0, build_seconds = 0;
};

/// Traces photons from the lights into the maps of a pass: global photons (stored only after a
/// diffuse event or one in a medium) by power, caustic photons (all events specular) aimed at
/// specular objects, volume photons (where media scatter, whatever came before) by power. What
/// each light emits follows what arrived in a training pass, so that lights elsewhere can't starve
/// the one that makes the caustic. Immutable.
class LightPass {
 public:
  /// Trains the budgets with photons of `seed`. The scene must outlive this. Worth nothing if it
  /// was stopped.
  LightPass(const Scene& scene, const LightPassSettings& settings, uint64_t seed,
            const std::stop_token& stop = {});

  /// The maps of pass `index`: the same for any number of threads. `progress` is told of photons,
  /// not of the building of the trees. `wavelengths`: of all photons, since any of them may meet.
  /// `gauges`: through whose disks caustic photons pass; null: through none. `stage`: the pass
  /// whose largest weight photons have, Pass::stage(); absent: `index`. Worth nothing if it was
  /// stopped.
  PhotonMaps trace(uint64_t seed, uint32_t index, std::stop_token stop = {},
                   const ProgressFunction& progress = {}, const Wavelengths& wavelengths = {},
                   const GaugeDisks* gauges = nullptr, std::optional<uint32_t> stage = {}) const;

  /// At most `most` photons of the maps of that pass, drawn at random: each as likely as any other,
  /// always the same ones, and the first of those that are drawn if more are asked for.
  DrawnPhotons draw(uint64_t seed, uint32_t index, size_t most, std::stop_token stop = {},
                    const Wavelengths& wavelengths = {}) const;

  /// Why a map that was asked for is empty. (A scene without specular objects has no caustics:
  /// that is no warning.)
  std::vector<std::string> warnings(const PhotonMaps& maps) const;

 private:
  struct Deposits;
  class Tracer;
  enum class Kind { global, caustic, volume };
  /// What tells the photons of a pass.
  struct Address {
    uint64_t seed;
    uint32_t index, stage;
    Wavelengths wavelengths;
    const GaugeDisks* gauges = nullptr;  ///< that caustic photons are shown to
  };
  /// Paths that are traced together.
  struct Block {
    int light;
    uint32_t first_path, begin, end;
  };
  std::vector<Block> blocks_of(Kind kind, const std::vector<uint32_t>& shares) const;
  std::unique_ptr<Tracer> traced(const Block& block, Kind kind, uint32_t share,
                                 const Address& address, Stream stream, bool notes_origins) const;
  void trace_kind(Kind kind, const std::vector<uint32_t>& shares, const Address& address,
                  Stream stream, std::stop_token stop, WorkCounter& counter,
                  Deposits& deposits) const;
  std::vector<uint32_t> place_shares() const;
  std::vector<SurfaceSide> trace_places(const Address& address, std::stop_token stop,
                                        WorkCounter& counter) const;
  std::vector<uint32_t> train(Kind kind, uint32_t total, uint64_t seed,
                              const std::stop_token& stop) const;

  const Scene& scene_;
  LightPassSettings settings_;
  size_t target_count_ = 0;
  std::unique_ptr<EmissionSampler> global_emission_, caustic_emission_;
  std::vector<uint32_t> global_shares_, caustic_shares_, volume_shares_;
};

}  // namespace kaustik
