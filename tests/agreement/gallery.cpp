#include "tests/agreement/gallery.h"

#include <algorithm>
#include <filesystem>

namespace kaustik::agreement {
namespace {

namespace fs = std::filesystem;

constexpr const char* folder = "docs/gallery";

BlockRender by(const std::string& scene, const std::string& integrator, uint32_t samples,
               uint64_t first_seed) {
  BlockRender render;
  render.scene = std::string(folder) + "/" + scene + ".xml";
  render.size = 32;
  render.integrator = integrator;
  render.components = whole_picture;
  render.samples = samples;
  render.first_seed = first_seed;
  return render;
}

/// Of a pass: textures are filtered by how many samples share a pixel.
constexpr uint32_t samples_of_pass = 4;

}  // namespace

std::vector<std::string> gallery_scenes() {
  std::vector<std::string> scenes;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(std::string(KAUSTIK_SOURCE_DIR) + "/" + folder))
    if (entry.path().extension() == ".xml") scenes.push_back(entry.path().stem().string());
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

BlockRender gallery_reference(const std::string& scene) {
  BlockRender render = by(scene, "path", samples_of_pass, 3'000'000);
  render.passes = 16;
  return render;
}

BlockRender gallery_render(const std::string& scene, const std::string& integrator) {
  return by(scene, integrator, samples_of_pass, 1);
}

std::string gallery_path(const std::string& scene) {
  return std::string(KAUSTIK_SOURCE_DIR) + "/tests/agreement/references/gallery/" + scene + ".exr";
}

}  // namespace kaustik::agreement
