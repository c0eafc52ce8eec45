#pragma once
// Scenes out of the parameter tables: whatever has a table appears, with usual and with extreme
// values, nested as scenes may be nested. A scene is a function of its seed.

#include <cstdint>
#include <string>
#include <vector>

namespace kaustik::fuzz {

/// A scene and an integrator object of every type for it.
struct GeneratedScene {
  struct OfIntegrator {
    std::string type;
    std::string xml;
  };
  std::string begin, end;  ///< of the file, around the integrator
  std::vector<OfIntegrator> integrators;

  std::string with(const std::string& integrator_xml) const { return begin + integrator_xml + end; }
};

/// `files_folder`: where write_files() has put the meshes and pictures that scenes name.
GeneratedScene generate_scene(uint64_t seed, const std::string& files_folder);

/// Small files for scenes to name: sound ones, and odd ones that a reader may refuse.
void write_files(const std::string& folder);

}  // namespace kaustik::fuzz
