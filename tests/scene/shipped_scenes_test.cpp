// Every scene that ships loads and builds, and has the thesis's size of picture where it is one of
// its scenes.

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "kaustik/loader/scene_format.h"
#include "kaustik/scene/scene.h"

namespace kaustik {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> shipped_scenes() {
  std::vector<fs::path> scenes;
  for (const fs::directory_entry& entry : fs::directory_iterator(KAUSTIK_SOURCE_DIR "/scenes")) {
    const fs::path file = entry.path() / (entry.path().filename().string() + ".xml");
    if (fs::exists(file)) scenes.push_back(file);
  }
  return scenes;
}

TEST(ShippedScenes, Build) {
  const std::map<std::string, std::pair<int, int>> sizes = {{"point_spotlight", {800, 800}},
                                                            {"museum", {800, 800}},
                                                            {"gallery_1", {800, 600}},
                                                            {"gallery_2", {800, 600}},
                                                            {"maze", {800, 800}}};
  size_t known = 0;
  for (const fs::path& file : shipped_scenes()) {
    SCOPED_TRACE(file.string());
    const auto scene = build_scene(load_scene(file.string()));
    EXPECT_FALSE(scene->lights().empty());
    const auto size = sizes.find(file.stem().string());
    if (size == sizes.end()) continue;
    ++known;
    EXPECT_EQ(scene->film().size.x, size->second.first);
    EXPECT_EQ(scene->film().size.y, size->second.second);
  }
  EXPECT_EQ(known, sizes.size());
}

}  // namespace
}  // namespace kaustik
