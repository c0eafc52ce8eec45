#pragma once
#include <span>

#include "kaustik/photon/photon_file.h"

namespace kaustik {

/// The photons of both maps in an order that depends on nothing but the photons, so that parts put
/// together give the same maps as a whole pass.
void sort_photons(PhotonMaps& maps);

/// The maps of a whole pass from all of its parts, in any order. Throws Error(input) if a part is
/// missing or comes twice, or parts are of different scenes, wavelengths, seeds or settings.
StoredPhotons merged_photons(std::span<const StoredPhotons> parts);

}  // namespace kaustik
