#pragma once
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

}  // namespace kaustik
