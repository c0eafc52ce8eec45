// What is seen in scenes of pbrt, where a closed form tells it.

#include <cmath>
#include <fstream>
#include <numbers>

#include "kaustik/loader/pbrt_scene.h"
#include "tests/support/measure.h"
#include "tests/support/temporary_folder.h"

namespace kaustik::pbrt {
namespace {

constexpr const char* camera =
    "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\n"
    "Camera \"perspective\" \"float fov\" .5\nWorldBegin\n";

/// Of a picture that looks from the origin along +z.
RunningStatistics seen(const std::string& world, const std::string& folder = "",
                       double samples = 4) {
  const test::TestScene scene(parse_pbrt(camera + world, "test.pbrt", folder));
  return test::render(scene, "path", "<integer name=\"max_depth\" value=\"4\"/>",
                      {.samples = samples})
      .mean({""});
}

void write(const test::TemporaryFolder& folder, const char* name, const std::string& contents) {
  std::ofstream(folder.path(name), std::ios::binary) << contents;
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
  const test::TemporaryFolder folder;
  write(folder, "lamp.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "-2 -2 5 0 0 -1\n4 -2 5 0 0 -1\n-2 4 5 0 0 -1\n3 0 1 2\n");
  EXPECT_FLOAT_EQ(
      float(seen(std::string(lamp) + "Shape \"plymesh\" \"string filename\" \"lamp.ply\"",
                 folder.path(""))
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
  const double expected = .5 * 3 * (.2 / 3) * (.2 / 3);
  EXPECT_NEAR(seen(ball + "Material \"diffuse\" Shape \"trianglemesh\" \"point3 P\" "
                          "[-9 -9 5 -9 9 5 9 9 5 9 -9 5] \"integer indices\" [0 1 2 0 2 3]",
                   "", 64)
                  .mean(),
              expected, 1e-3 * expected);
}

/// A picture of floats.
std::string pfm(int width, int height, const std::vector<float>& values) {
  std::string text = "Pf\n" + std::to_string(width) + " " + std::to_string(height) + "\n-1.0\n";
  text.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
  return text;
}

TEST(PbrtTraced, PicturesShine) {
  const test::TemporaryFolder folder;
  write(folder, "grey.pfm", pfm(2, 2, {.5, .5, .5, .5}));
  EXPECT_FLOAT_EQ(float(seen("AreaLightSource \"diffuse\" \"string filename\" \"grey.pfm\" "
                             "\"float scale\" 4 " +
                                 square(true, ""),
                             folder.path(""))
                            .mean()),
                  2);
}

/// A picture of one colour with opacity.
std::string tga(int red, int green, int blue, int opacity) {
  std::string text(18, '\0');
  text[2] = 2;
  text[12] = text[14] = 1;
  text[16] = 32;
  text[17] = 8;
  for (const int part : {blue, green, red, opacity}) text += char(part);
  return text;
}

TEST(PbrtTraced, PicturesForNumbersAreOpacityOrMeans) {
  const test::TemporaryFolder folder;
  write(folder, "leaf.tga", tga(255, 255, 255, 51));
  write(folder, "solid.tga", tga(255, 255, 255, 255));
  std::string colours = pfm(1, 1, {.3f, .6f, 0});
  colours[1] = 'F';
  write(folder, "colours.pfm", colours);
  // A lamp behind a sheet that covers a part of it.
  const auto seen_behind = [&](const std::string& picture) {
    return seen(
        "Texture \"a\" \"float\" \"imagemap\" \"string filename\" " + picture +
            "\nAttributeBegin Translate 0 0 2 " + std::string(lamp) + square(true, "") +
            "AttributeEnd\nMaterial \"diffuse\" \"rgb reflectance\" [0 0 0] Translate 0 0 -1 "
            "Shape \"bilinearmesh\" \"point3 P\" [-1 -1 5 1 -1 5 -1 1 5 1 1 5] "
            "\"texture alpha\" \"a\"",
        folder.path(""), 400);
  };
  const auto expect_seen = [&](const std::string& picture, double expected) {
    const RunningStatistics measured = seen_behind(picture);
    EXPECT_NEAR(measured.mean(), expected, 1e-4 + 5 * measured.standard_error()) << picture;
    EXPECT_LT(measured.standard_error(), .02) << picture;
  };
  expect_seen("\"leaf.tga\"", 3 * .8);
  expect_seen("\"solid.tga\"", 0);
  expect_seen("\"colours.pfm\"", 3 * .7);
  expect_seen("\"colours.pfm\" \"bool invert\" true", 3 * .3);
}

/// A picture of equal areas: in the square's middle diamond z is above 0: 5 there, 0 below.
std::string half_of_all_directions() {
  constexpr int size = 64;
  std::vector<float> values;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      values.push_back(
          std::fabs(2 * (x + .5) / size - 1) + std::fabs(2 * (y + .5) / size - 1) < 1 ? 5.f : 0.f);
  return pfm(size, size, values);
}

TEST(PbrtTraced, SkiesOfEqualAreaShineFromTheirHalf) {
  const test::TemporaryFolder folder;
  write(folder, "sky.pfm", half_of_all_directions());
  const std::string sky = "LightSource \"infinite\" \"string filename\" \"sky.pfm\"\n";
  EXPECT_NEAR(seen(sky, folder.path("")).mean(), 5, .02);
  EXPECT_NEAR(seen("Scale 1 1 -1 " + sky, folder.path("")).mean(), 0, 1e-6);
  // A wall that faces it reflects ρ E / π = .5 · 5, but for the pixels on the horizon.
  const std::string wall =
      "AttributeBegin Scale 1 1 -1 " + sky + "AttributeEnd\n" + square(true, "");
  const RunningStatistics lit = seen(wall, folder.path(""), 64);
  EXPECT_NEAR(lit.mean(), 2.5, .02 + 4 * lit.standard_error());
}

const std::string wall_at_5 =
    "\nShape \"trianglemesh\" \"point3 P\" [-9 -9 5 -9 9 5 9 9 5 9 -9 5] "
    "\"integer indices\" [0 1 2 0 2 3]";

/// On a matt wall at z = 5, which faces the lamps, in its middle: E = π L / ρ.
void expect_lux(const std::string& lamps, double expected, const std::string& folder = "") {
  constexpr double lux_of_radiance = std::numbers::pi / .5;
  const RunningStatistics radiance = seen(lamps + wall_at_5, folder, 64);
  const double error = lux_of_radiance * radiance.standard_error();
  EXPECT_NEAR(lux_of_radiance * radiance.mean(), expected, 2e-3 * expected + 5 * error) << lamps;
  EXPECT_LT(error, .02 * expected) << lamps;
}

TEST(PbrtTraced, GoniometricLampsShineAsTheirPicture) {
  const test::TemporaryFolder folder;
  write(folder, "lamp.pfm", half_of_all_directions());
  const std::string lamp =
      "LightSource \"goniometric\" \"string filename\" \"lamp.pfm\" \"rgb I\" [3 3 3] ";
  expect_lux(lamp + "\"float scale\" 2", 30. / 25, folder.path(""));
  // Those pixels share the power: 1984 of 4096, for the diamond's own edge is dark.
  const RunningStatistics seen_with_power =
      seen(lamp + "\"float power\" 100" + wall_at_5, folder.path(""), 64);
  const double intensity = 25 * seen_with_power.mean() * std::numbers::pi / .5;
  const double expected = 100 / (4 * std::numbers::pi * 1984 / 4096);
  EXPECT_NEAR(intensity, expected, .01 * expected);
  EXPECT_EQ(seen("Scale 1 1 -1 " + lamp + wall_at_5, folder.path("")).mean(), 0);
}

/// Of lamps with a power (lm), an illuminance (lx), or their own light, times `scale`.
TEST(PbrtTraced, LampsHaveTheirIlluminance) {
  using std::numbers::pi;
  const auto cosine = [](double degrees) { return std::cos(degrees * pi / 180); };
  // E = I / d², with I = Φ / 4π.
  expect_lux("LightSource \"point\" \"rgb I\" [3 3 3] \"float scale\" 2", 6. / 25);
  expect_lux("LightSource \"point\" \"float power\" 100 \"float scale\" 2", 200 / (4 * pi) / 25);
  expect_lux("LightSource \"goniometric\" \"rgb I\" [3 3 3] \"float scale\" 2", 6. / 25);
  expect_lux("LightSource \"goniometric\" \"float power\" 100 \"float scale\" 2",
             200 / (4 * pi) / 25);
  // Of a cone that fades by the cosine from 20° to 30°.
  const double solid_angle = 2 * pi * ((1 - cosine(20)) + (cosine(20) - cosine(30)) / 2);
  const std::string cone = " \"float coneangle\" 30 \"float conedeltaangle\" 10 \"float scale\" 2";
  expect_lux("LightSource \"spot\" \"rgb I\" [3 3 3]" + cone, 6. / 25);
  expect_lux("LightSource \"spot\" \"float power\" 100" + cone, 200 / solid_angle / 25);
  expect_lux("LightSource \"distant\" \"rgb L\" [3 3 3] \"float scale\" 2", 6);
  expect_lux("LightSource \"distant\" \"float illuminance\" 700 \"float scale\" 2", 1400);
  // E = π L of a sky that is alike everywhere.
  expect_lux("LightSource \"infinite\" \"rgb L\" [3 3 3] \"float scale\" 2", 6 * pi);
  expect_lux("LightSource \"infinite\" \"float illuminance\" 700 \"float scale\" 2", 1400);
  // E = π L r² / (r² + d²) of a disk of radius 1 at a distance of 6, with L = Φ / (π · π r²).
  const std::string disk =
      " AttributeBegin Material \"diffuse\" \"rgb reflectance\" [0 0 0] Translate 0 0 -1 "
      "AreaLightSource \"diffuse\" \"float scale\" 2 ";
  const std::string end = " Shape \"disk\" AttributeEnd";
  expect_lux(disk + "\"rgb L\" [3 3 3]" + end, 6 * pi / 37);
  expect_lux(disk + "\"float power\" 100" + end, 200 / pi / 37);
  expect_lux(disk + "\"float power\" 100 \"bool twosided\" true" + end, 100 / pi / 37);
}

/// In the middle of the beam, a picture's number times `scale` is the intensity.
TEST(PbrtTraced, ProjectorsHaveTheirIlluminance) {
  const test::TemporaryFolder folder;
  write(folder, "grey.pfm", pfm(2, 2, {.5, .5, .5, .5}));
  for (const double fov : {30., 90.})
    expect_lux(
        "LightSource \"projection\" \"string filename\" \"grey.pfm\" \"float scale\" 12 "
        "\"float fov\" " +
            std::to_string(fov),
        6. / 25, folder.path(""));
}

}  // namespace
}  // namespace kaustik::pbrt
