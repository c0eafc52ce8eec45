#pragma once
#include <mutex>

#include "kaustik/photon/coverage/seen_surfaces.h"
#include "kaustik/photonmap/kept.h"
#include "kaustik/photonmap/photon_light.h"
#include "kaustik/transport/illumination_model.h"

namespace kaustik {

/// Two-pass photon mapping (Jensen 1996, Schregle 1998). Every pass has maps and an irradiance
/// cache of its own and shrinking search radii, so that the mean of the passes converges.
class PhotonMapIntegrator final : public IlluminationModel {
 public:
  PhotonMapIntegrator(const Arguments& arguments, const Scene& scene);

  std::unique_ptr<PassState> prepare(const Pass& pass, SplatBuffer& splats, std::stop_token stop,
                                     const ProgressFunction& progress) const override;
  /// Through media that take their share, with the beam radiance estimate of what they scatter.
  bool advance(const PassState& state, CameraWalk& walk) const override;
  bool reflect(const PassState& state, CameraWalk& walk,
               const RadianceTracer& tracer) const override;
  Lobes traced() const override { return settings_.traced(); }
  /// The maps of pass 0, and what gather rays look up, where no medium scatters light.
  void keep_light(const std::shared_ptr<const KeptLight>& light) override;
  std::shared_ptr<const KeptLight> kept_light() const override;

 private:
  struct State;
  struct Light;
  /// What a pass has of photons: traced, or kept.
  std::shared_ptr<const Light> light_of(const Pass& pass, PassReport& report, std::stop_token stop,
                                        const ProgressFunction& progress) const;
  /// The maps of a pass: traced, or the stored ones.
  std::shared_ptr<const PhotonMaps> maps_of(const Pass& pass, PassReport& report,
                                            std::stop_token stop,
                                            const ProgressFunction& progress) const;
  /// Throws Error(input) unless the stored maps were traced at these.
  void check_stored_wavelengths(const Wavelengths& wavelengths) const;
  /// Around the camera's gauges. Counts rays.
  GaugeDisks gauge_disks(const Pass& pass, uint64_t& rays) const;
  GatherRadii pass_radii(const PhotonMaps& maps, uint32_t index) const;
  void add_shadow_photons(State& state, const Pass& pass, std::stop_token stop) const;
  void add_warnings(State& state) const;
  void fill_cache(State& state, const Pass& pass, std::stop_token stop,
                  const ProgressFunction& progress) const;
  /// The diffuse surfaces that a camera path through the square of `stride` pixels from `pixel` on
  /// meets, for the cache. Pixels are those of the whole picture: in a crop window the cache is
  /// filled from the same points, but for those outside, so what it holds agrees in the mean.
  void collect_cache_points(const Vec2i& pixel, int stride, const Pass& pass, uint32_t round,
                            std::vector<CachePoint>& points) const;
  /// How many specular rays leave the walk's vertex.
  int specular_rays(const CameraWalk& walk) const;
  bool scatter_specular(CameraWalk& walk, int rays) const;
  void add_photon_light(const State& state, CameraWalk& walk) const;
  void add_photon_light_at_gauge(const State& state, CameraWalk& walk) const;
  Spectrum diffuse_irradiance(const State& state, CameraWalk& walk, const Vec3f& normal) const;

  /// The light pass of a seed, its budgets trained when it is first asked for; null after a
  /// stop.
  std::shared_ptr<const LightPass> light_pass(uint64_t seed, const std::stop_token& stop) const;
  /// What the pixels show, with edges, found when it is first asked for; null after a stop. Counts
  /// the rays that look for edges.
  std::shared_ptr<const SeenSurfaces> seen_edges(uint64_t& rays, const std::stop_token& stop) const;

  PhotonMapSettings settings_;
  std::shared_ptr<const PhotonMaps> stored_maps_;  ///< null: every pass traces its own
  Wavelengths stored_wavelengths_;                 ///< of those
  mutable Kept<LightPass> light_pass_;             ///< by the seed
  mutable Kept<SeenSurfaces> seen_edges_;
  bool keeps_light_ = false;
  mutable std::mutex light_mutex_;
  mutable std::shared_ptr<const Light> first_light_;  ///< of pass 0, if it is kept; null: none yet
};

}  // namespace kaustik
