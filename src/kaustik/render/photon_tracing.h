#pragma once
#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "kaustik/photon/photon_parts.h"
#include "kaustik/scene/description.h"

namespace kaustik {

/// Photon maps for a file, and what is to be said about them.
struct TracedPhotons {
  StoredPhotons photons;  ///< `scene` is left to the caller
  std::vector<std::string> warnings;
};

/// Traces the maps that the description's photonmap integrator asks for (without one: its default
/// parameters) in pass 0 of `seed`, on `threads` threads (0: all), or a part of them. Throws
/// Error(input) for wrong parameters, Error(system) if stopped: half a map is of no use.
TracedPhotons trace_photon_maps(const Description& description, const Scene& scene, uint64_t seed,
                                int threads, std::stop_token stop = {},
                                const ProgressFunction& progress = {}, PhotonPart part = {});

/// Index into Scene::lights() of the lamp of each photon of a map, in the order of its tree; of
/// maps of a whole pass, not of a part of one. PhotonLamps::unknown where a damaged file has
/// numbers of no light path.
std::vector<uint32_t> lamps_of(const StoredPhotons& photons, const PhotonMap& map);

/// Some of the photons of the maps that trace_photon_maps() traces, and of those in media that its
/// files have no place for: LightPass::draw(). None if stopped, or if the scene has no light.
DrawnPhotons draw_photons(const Description& description, const Scene& scene, uint64_t seed,
                          int threads, size_t most, std::stop_token stop = {});

/// Whatever draw_photons() depends on but the number that is wanted: the camera makes no
/// difference.
uint64_t drawn_photons_key(const Description& description, const Scene& scene, uint64_t seed);

}  // namespace kaustik
