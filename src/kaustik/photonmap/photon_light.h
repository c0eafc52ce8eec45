#pragma once
#include <atomic>

#include "kaustik/photon/coverage/surface_edges.h"
#include "kaustik/photon/irradiance_map.h"
#include "kaustik/photonmap/photon_map_settings.h"
#include "kaustik/transport/integrator.h"

namespace kaustik {

/// Radii of a pass, m.
struct GatherRadii {
  float caustic = infinity, global = infinity;
};

/// What gather rays look up: irradiance by global photons, at the places that `maps` has for it.
/// Empty where `stop` is requested.
IrradianceMap precomputed_irradiance(const Scene& scene, const PhotonMapSettings& settings,
                                     const PhotonMaps& maps, const GatherRadii& radii,
                                     const std::stop_token& stop = {});

/// What photons know of the light in a scene: estimates at surfaces, and the radiance that arrives
/// along gather rays. Immutable during the visualisation pass.
class PhotonLight final : public RadianceSource {
 public:
  /// `precomputed`: of the same. `shadows` may be null: shadow rays alone tell what light arrives.
  /// `pass`: whose wavelengths all light has; its index tells how far the discs of volume photons
  /// have shrunk. All but that must outlive this.
  PhotonLight(const Scene& scene, const PhotonMapSettings& settings, const PhotonMaps& maps,
              const GatherRadii& radii, const IrradianceMap& precomputed, const ShadowMap* shadows,
              const ShadowSettings& shadow_settings, const Pass& pass);

  /// Radiance by caustic photons [L G⁺ → x] that `lobes` send back at a recursion level.
  /// `sampler` tells where it is drawn what is visible; its numbers are not used up.
  Spectrum caustic(const SurfaceVertex& vertex, Lobes lobes, int recursion, const Sampler& sampler,
                   const Work& work) const {
    return caustic_estimate(vertex, lobes, recursion, sampler, {}, work).value;
  }
  /// The same where the camera looks: as if the disk were whole where the surface ends within it.
  /// `edges`: of the surface there; null: nothing is known.
  Spectrum seen_caustic(const SurfaceVertex& vertex, Lobes lobes, int recursion,
                        const Sampler& sampler, const SurfaceEdges* edges, const Work& work) const;
  /// The same by global photons: the approximate solution for diffuse indirect light.
  Spectrum global(const SurfaceVertex& vertex, Lobes lobes, int recursion, const Sampler& sampler,
                  const Work& work) const;

  /// Diffuse indirect light along a gather ray from a surface at level `at`: what the surface there
  /// sends back of direct, caustic and global light by lobes that are not traced; specular events
  /// on the way are followed. No emission: lamps are seen by direct light and caustics. `medium`,
  /// in which the surface lies, and others on the way take their share, and what they scatter into
  /// the ray counts too.
  Incoming gathered(const Medium* medium, const SurfacePoint& from, const Vec3f& direction,
                    Sampler& sampler, const EyeLevel& at, Scratch& scratch) const;
  /// The same from what the camera itself sees.
  Incoming incoming(const SurfacePoint& from, const Vec3f& direction,
                    Sampler& sampler) const override {
    Scratch scratch;
    return gathered(nullptr, from, direction, sampler, {}, scratch);
  }
  Incoming incoming_through(const Medium* medium, const SurfacePoint& from, const Vec3f& direction,
                            Sampler& sampler, Scratch& scratch) const override {
    return gathered(medium, from, direction, sampler, {}, scratch);
  }
  /// Flux of the global photons near the point, by cell.
  bool importance(const SurfacePoint& at, const Frame& frame, const HemisphereGrid& grid,
                  Scratch& scratch, std::vector<float>& cell_importance) const override;

  /// Diffuse indirect irradiance at `vertex` by gather rays drawn in proportion to the photons'
  /// flux over a grid of the hemisphere (Jensen 1995, Schregle 1998 corrected: density p relative
  /// to the uniform grid, E ≈ mean of π L/p). `normal`: the shading normal on the side that is
  /// meant; `medium`: on that side.
  Spectrum gather_irradiance(const SurfaceVertex& vertex, const Vec3f& normal, const Medium* medium,
                             Sampler& sampler, const EyeLevel& at, Scratch& scratch) const;

  /// Light that media scatter, for the camera's rays.
  const VolumeLight& volume() const { return volume_; }

  uint64_t rays() const { return rays_.load(std::memory_order_relaxed); }

 private:
  DensityEstimate caustic_estimate(const SurfaceVertex& vertex, Lobes lobes, int recursion,
                                   const Sampler& sampler, const ClearDisk& clear,
                                   const Work& work) const;
  /// What a gather ray finds at its end: all that is sent back by lobes that are not traced.
  Spectrum sent_by(const SurfaceVertex& vertex, const Medium* medium, Sampler& sampler,
                   const EyeLevel& level, const Work& work) const;
  /// Diffuse indirect light at the end of a gather ray: gathered once more, or from the map.
  Spectrum gathered_indirect(const SurfaceVertex& vertex, const Medium* medium, Lobes lobes,
                             Sampler& sampler, const EyeLevel& at, const Work& work) const;
  /// From the map: looked up where it was computed beforehand.
  Spectrum gathered_global(const SurfaceVertex& vertex, Lobes lobes, int recursion,
                           const Sampler& sampler, const Work& work) const;
  /// Radiance by the photons of a map.
  DensityEstimate estimate(const PhotonMap& map, const SurfaceVertex& vertex, Lobes lobes,
                           const EstimateSettings& settings, const Sampler& numbers,
                           const ClearDisk& clear, const Work& work) const;
  Spectrum reflected_direct_light(const SurfaceVertex& vertex, const Medium* medium, Lobes lobes,
                                  int recursion, Sampler& sampler, const Work& work) const;
  void make_volume_maps(uint32_t pass);
  /// Surfaces with any of these lobes keep photons.
  Lobes keeping() const;

  const Scene& scene_;
  Wavelengths wavelengths_;
  const PhotonMapSettings& settings_;
  const PhotonMaps& maps_;
  GatherRadii radii_;
  const IrradianceMap& precomputed_;
  const ShadowMap* shadows_;
  const ShadowSettings& shadow_settings_;
  /// Whether all surfaces keep photons beyond which SurfaceEdges sees no end.
  bool edges_tell_what_keeps_ = true;
  VolumePhotonMap volume_;                 ///< for the camera's rays …
  VolumePhotonMap coarse_volume_;          ///< … and with fewer photons for gather rays
  mutable std::atomic<uint64_t> rays_{0};  ///< counts only; changes no result
};

/// Whether indirect light on the far side of the surface counts.
inline bool gathers_through(const SurfaceVertex& vertex) {
  return vertex.transmits() && !vertex.diffuse_value_through().is_zero();
}

/// What the diffuse lobe of `vertex` sends to its wo of irradiance(normal), W/m², on its side and,
/// where the surface lets it through, on the far side.
template <typename Irradiance>
Spectrum diffuse_radiance(const SurfaceVertex& vertex, const Irradiance& irradiance) {
  const Vec3f normal = vertex.facing_normal();
  Spectrum radiance = vertex.diffuse_value() * irradiance(normal);
  if (gathers_through(vertex)) radiance += vertex.diffuse_value_through() * irradiance(-normal);
  return radiance;
}

}  // namespace kaustik
