#pragma once
#include <string>

#include "kaustik/photon/light_pass.h"
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

/// Throws Error(input) if the file is missing, of another version or byte order, truncated, or
/// damaged (a checksum covers every byte). Allocates no more than in proportion to the file's size.
StoredPhotons read_photon_file(const std::string& path);

/// Whether the file starts as photon maps do. Throws Error(input) if it cannot be read.
bool is_photon_file(const std::string& path);

}  // namespace kaustik
