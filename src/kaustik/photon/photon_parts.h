#pragma once
#include <array>
#include <span>
#include <string>

#include "kaustik/photon/photon_file.h"

namespace kaustik {

/// The photons of both maps in an order that depends on nothing but the photons, so that parts put
/// together give the same maps as a whole pass.
void sort_photons(PhotonMaps& maps);

/// The maps of a whole pass from all of its parts, in any order. Throws Error(input) if a part is
/// missing or comes twice, parts are of different scenes, wavelengths, seeds or settings, or a map
/// would have more than 2^31 photons.
StoredPhotons merged_photons(std::span<const StoredPhotons> parts);

/// Of each map, global and caustic.
using PhotonCounts = std::array<size_t, 2>;

/// The same in a file, with the same bits. No more than `photons_in_memory` photons are in memory
/// at a time, 60 bytes each, and 50 MB; what the parts have is not copied. The folder needs room
/// for 44 bytes of each photon, beside those of the file. Throws as merged_photons() and
/// PhotonFileWriter do. Returns how many photons there are.
PhotonCounts write_merged_photons(const std::string& path, std::span<const StoredPhotons> parts,
                                  const ProgressFunction& progress = {},
                                  size_t photons_in_memory = size_t{1} << 22);

}  // namespace kaustik
