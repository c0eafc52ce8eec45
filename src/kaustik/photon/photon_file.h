#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "kaustik/base/file.h"
#include "kaustik/photon/light_pass.h"
#include "kaustik/photon/photon_tree_builder.h"
#include "kaustik/photon/scene_fingerprint.h"

namespace kaustik {

/// A light pass's maps as they are kept in a file (.kpm), for other views of the same scene.
struct StoredPhotons {
  std::string scene;  ///< the scene file that they come from, for people
  SceneFingerprint fingerprint;
  uint64_t seed = 0;
  Wavelengths wavelengths;     ///< that the maps were traced at
  LightPassSettings settings;  ///< that the maps were traced with
  PhotonMaps maps;
};

/// Writes atomically; throws as write_file_atomically() does. The times are left out, so that equal
/// maps are equal files.
void write_photon_file(const std::string& path, const StoredPhotons& photons);

/// Writes such a file whose maps would not fit into memory: atomically, piece by piece.
class PhotonFileWriter {
 public:
  /// `photons`: all but the maps themselves, which have so many photons, global and caustic. Throws
  /// as AtomicFile does, here and later.
  PhotonFileWriter(const std::string& path, const StoredPhotons& photons,
                   const std::array<size_t, 2>& counts);
  /// Items of map 0, global, or 1, caustic; see build_photon_tree().
  void put(size_t map, TreePart part, uint64_t first, std::span<const uint8_t> items);
  void set_mean_flux(size_t map, float mean_flux) { mean_fluxes_[map] = mean_flux; }
  /// When all was put.
  void finish();

 private:
  std::vector<uint8_t> head() const;

  AtomicFile file_;
  const StoredPhotons& photons_;
  std::array<size_t, 2> counts_;
  std::array<float, 2> mean_fluxes_{};
  std::array<uint64_t, 2> begins_{};  ///< of the maps
};

/// The maps stay in the file, which is mapped into memory: what is asked of them is read by the
/// system, and dropped when it needs the memory. The file may be replaced or removed, but nobody
/// may write to it. Throws Error(input) if the file is missing, of another version or byte order,
/// truncated, or damaged (a checksum covers every byte).
StoredPhotons read_photon_file(const std::string& path);

/// Whether the file starts as photon maps do. Throws Error(input) if it cannot be read.
bool is_photon_file(const std::string& path);

}  // namespace kaustik
