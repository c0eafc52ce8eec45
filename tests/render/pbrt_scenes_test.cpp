// What is seen in scenes of pbrt, where a closed form tells it.

#include <cmath>
#include <numbers>

#include "tests/loader/pbrt_support.h"
#include "tests/support/measure.h"

namespace kaustik::pbrt {
namespace {

using std::numbers::pi;
using test::expect_mean;

constexpr const char* camera =
    "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\n"
    "Camera \"perspective\" \"float fov\" .5\nWorldBegin\n";

/// Of a picture that looks from the origin along +z.
RunningStatistics seen(const std::string& world, const std::string& folder = "",
                       double samples = 4) {
  const test::TestScene scene(parse_scene_of_pbrt(camera + world, false, folder));
  return test::render(scene, "path", "<integer name=\"max_depth\" value=\"4\"/>",
                      {.samples = samples})
      .mean({""});
}

/// A square of side 2 at z = 5 whose winding faces the camera, or not, with those normals.
std::string square(bool faces_camera, const std::string& normal) {
  std::string normals;
  for (int i = 0; i < 4; ++i) normals += normal + " ";
  return "Shape \"trianglemesh\" \"point3 P\" [-1 -1 5 -1 1 5 1 1 5 1 -1 5] \"integer indices\" " +
         std::string(faces_camera ? "[0 1 2 0 2 3]" : "[0 2 1 0 3 2]") +
         (normal.empty() ? "" : " \"normal N\" [" + normals + "]") + "\n";
}

constexpr const char* lamp = "AreaLightSource \"diffuse\" \"rgb L\" [3 3 3] ";

TEST(PbrtTraced, LampsShineToTheSideOfTheirNormals) {
  EXPECT_FLOAT_EQ(float(seen(lamp + square(true, "")).mean()), 3);
  EXPECT_EQ(seen(lamp + square(false, "")).mean(), 0);
  for (const bool faces_camera : {true, false}) {
    EXPECT_FLOAT_EQ(float(seen(lamp + square(faces_camera, "0 0 -1")).mean()), 3) << faces_camera;
    EXPECT_EQ(seen(lamp + square(faces_camera, "0 0 1")).mean(), 0) << faces_camera;
  }
  EXPECT_EQ(seen(lamp + ("ReverseOrientation " + square(false, "0 0 -1"))).mean(), 0);
  EXPECT_FLOAT_EQ(float(seen(lamp + ("Scale -1 1 1 " + square(false, "0 0 -1"))).mean()), 3);
}

TEST(PbrtTraced, PatchesAndPlyFilesDoSo) {
  const std::string normals = "\"normal N\" [0 0 -1 0 0 -1 0 0 -1 0 0 -1]";
  EXPECT_FLOAT_EQ(float(seen(std::string(lamp) +
                             "Shape \"bilinearmesh\" \"point3 P\" "
                             "[-1 -1 5 1 -1 5 -1 1 5 1 1 5] " +
                             normals)
                            .mean()),
                  3);
  const TemporaryFolder folder;
  folder.write("lamp.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
               "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
               "-2 -2 5 0 0 -1\n4 -2 5 0 0 -1\n-2 4 5 0 0 -1\n3 0 1 2\n");
  EXPECT_FLOAT_EQ(
      float(seen(std::string(lamp) + "Shape \"plymesh\" \"string filename\" \"lamp.ply\"",
                 folder / "")
                .mean()),
      3);
}

TEST(PbrtTraced, MirroredBodiesKeepTheirFront) {
  // pbrt's disk faces +z of its space; turned, it faces the camera, mirrored or not.
  for (const char* mirror : {"", "Scale -1 1 1 "}) {
    const std::string turned = std::string("Translate 0 0 5 Rotate 180 1 0 0 ") + mirror;
    EXPECT_FLOAT_EQ(float(seen(lamp + turned + "Shape \"disk\"").mean()), 3) << mirror;
    EXPECT_FLOAT_EQ(float(seen(lamp + turned + "Shape \"sphere\"").mean()), 3) << mirror;
    EXPECT_EQ(seen(lamp + turned + "ReverseOrientation Shape \"disk\"").mean(), 0) << mirror;
  }
}

TEST(PbrtTraced, LampsWithAlphaZeroShineUnseen) {
  const std::string ball = "AttributeBegin " + std::string(lamp) +
                           "Translate 0 0 2 Shape \"sphere\" \"float radius\" .2 \"float alpha\" 0 "
                           "AttributeEnd\n";
  EXPECT_EQ(seen(ball).mean(), 0);
  // On a wall at a distance of 3, E = π L r²/d²; it reflects ρ E / π = .5 · 3 · (.2 / 3)².
  expect_mean("unseen ball",
              seen(ball + "Material \"diffuse\" Shape \"trianglemesh\" \"point3 P\" "
                          "[-9 -9 5 -9 9 5 9 9 5 9 -9 5] \"integer indices\" [0 1 2 0 2 3]",
                   "", 64),
              .5 * 3 * (.2 / 3) * (.2 / 3));
}

/// A picture of floats.
std::string pfm(int width, int height, const std::vector<float>& values) {
  std::string text = "Pf\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n";
  text.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
  return text;
}

TEST(PbrtTraced, PicturesShine) {
  const TemporaryFolder folder;
  folder.write("grey.pfm", pfm(2, 2, {.5, .5, .5, .5}));
  EXPECT_FLOAT_EQ(float(seen("AreaLightSource \"diffuse\" \"string filename\" \"grey.pfm\" "
                             "\"float scale\" 4 " +
                                 square(true, ""),
                             folder / "")
                            .mean()),
                  2);
}

TEST(PbrtTraced, SkiesOfEqualAreaShineFromTheirHalf) {
  // In the square's middle diamond z is above 0: 5 there, 0 below.
  constexpr int size = 64;
  std::vector<float> values;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      values.push_back(
          std::fabs(2 * (x + .5) / size - 1) + std::fabs(2 * (y + .5) / size - 1) < 1 ? 5.f : 0.f);
  const TemporaryFolder folder;
  folder.write("sky.pfm", pfm(size, size, values));
  const std::string sky = "LightSource \"infinite\" \"string filename\" \"sky.pfm\"\n";
  EXPECT_FLOAT_EQ(float(seen(sky, folder / "").mean()), 5);
  EXPECT_NEAR(seen("Scale 1 1 -1 " + sky, folder / "").mean(), 0, 1e-6);
  // A wall that faces it reflects ρ E / π = .5 · 5, but for the pixels on the horizon.
  const std::string wall = "Scale 1 1 -1 " + sky + square(true, "");
  const RunningStatistics lit = seen(wall, folder / "", 64);
  EXPECT_NEAR(lit.mean(), 2.5, .02 + 4 * lit.standard_error());
}

}  // namespace
}  // namespace kaustik::pbrt
