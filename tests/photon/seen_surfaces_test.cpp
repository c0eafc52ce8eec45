// Blocks of pixels that have a probe each.

#include "kaustik/photon/coverage/seen_surfaces.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

int block_size_of(int width, int height, const std::string& crop = "") {
  const TestScene scene(R"(<sensor type="perspective"><film type="hdrfilm">)" +
                        set("width", width) + set("height", height) + crop + "</film></sensor>" +
                        flat("rectangle", translate("0, 0, -1"), diffuse("0.5")));
  return SeenSurfaces::block_size_of(scene.scene());
}

TEST(SeenSurfaces, LargePicturesHaveLargerBlocks) {
  EXPECT_EQ(block_size_of(8, 8), 4);
  EXPECT_EQ(block_size_of(449, 449), 4);
  EXPECT_EQ(block_size_of(451, 451), 5);
  EXPECT_EQ(block_size_of(600, 600), 6);
  EXPECT_EQ(block_size_of(900, 400), 6);
  EXPECT_EQ(block_size_of(800, 800), 8);
  EXPECT_EQ(block_size_of(4096, 2160), 8);
}

TEST(SeenSurfaces, CropWindowsHaveBlocksOfTheWholePicture) {
  const std::string crop = set("crop_width", 16) + set("crop_height", 16);
  EXPECT_EQ(block_size_of(800, 800, crop), 8);
}

}  // namespace
}  // namespace kaustik
