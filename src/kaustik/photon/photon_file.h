#pragma once
#include <string>

#include "kaustik/photon/light_pass.h"

namespace kaustik {

/// A light pass's maps as they are kept in a file (.kpm), for other views of the same scene.
struct StoredPhotons {
  std::string scene;        ///< the scene file that they come from, for people
  std::string fingerprint;  ///< scene_fingerprint() of that scene
  uint64_t seed = 0;
  LightPassSettings settings;  ///< that the maps were traced with
  PhotonMaps maps;
};

/// A text that differs between scenes whose photons differ in all likelihood: counts, and a digest
/// of all shapes' places and colours and of the lights. The camera makes no difference, nor do last
/// bits, in which programs from different compilers differ.
std::string scene_fingerprint(const Scene& scene);

/// Writes atomically; throws as write_file_atomically() does. The times are left out, so that equal
/// maps are equal files.
void write_photon_file(const std::string& path, const StoredPhotons& photons);

/// Throws Error(input) if the file is missing, of another version or byte order, truncated, or
/// damaged (a checksum covers every byte). Allocates no more than in proportion to the file's size.
StoredPhotons read_photon_file(const std::string& path);

/// Whether the file starts as photon maps do. Throws Error(input) if it cannot be read.
bool is_photon_file(const std::string& path);

}  // namespace kaustik
