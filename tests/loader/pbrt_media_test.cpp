// pbrt's media.

#include "kaustik/base/file.h"
#include "kaustik/loader/pbrt/cloud_density.h"
#include "tests/loader/nanovdb_bytes.h"
#include "tests/loader/pbrt_support.h"

namespace kaustik::pbrt {
namespace {

TEST(PbrtMedia, HomogeneousOnBothSides) {
  const Description scene = parse_scene_of_pbrt(R"(
    MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [1 2 3] "float scale" .5
      "float g" .4
    MediumInterface "" "fog"
    Camera "perspective"
    WorldBegin
    MakeNamedMedium "milk" "string type" "homogeneous" "string preset" "Wholemilk"
    MediumInterface "milk" "fog"
    Material "interface"
    Shape "sphere"
    LightSource "point"
    MediumInterface "fog"
    Shape "sphere"
    MediumInterface "gone" ""
    Shape "sphere")");
  const auto shapes = objects_of(scene, "shape");
  const Object& outside = child(*shapes[0], "exterior");
  expect_rgb(value<Rgb>(outside, "sigma_a"), 1, 2, 3);
  EXPECT_EQ(value<double>(outside, "sigma_s"), 1);
  EXPECT_EQ(value<double>(outside, "scale"), .5);
  EXPECT_EQ(value<double>(only(outside, "phase"), "g"), .4);
  EXPECT_EQ(value<std::string>(child(*shapes[0], "interior"), "material"), "wholemilk");
  EXPECT_EQ(&only(only(scene, "sensor"), "medium"), &outside);
  EXPECT_EQ(&only(only(scene, "emitter"), "medium"), &outside);
  EXPECT_EQ(shapes[1]->children.size(), 1u);  // no boundary
  EXPECT_TRUE(is_missing(scene, "'gone'", "not defined"));
}

TEST(PbrtMedia, GridsLieInTheirBox) {
  const Description scene = parse_scene_of_pbrt(R"(WorldBegin
    Translate 1 0 0
    MakeNamedMedium "smoke" "string type" "uniformgrid" "integer nx" 2 "integer ny" 1 "integer nz" 1
      "float density" [0 3] "point3 p0" [0 0 0] "point3 p1" [2 1 1] "rgb sigma_a" [1 1 1]
      "rgb sigma_s" [3 3 3] "float Le" 1
    MakeNamedMedium "rainbow" "string type" "rgbgrid" "integer nx" 1 "rgb sigma_s" [1 2 3]
      "rgb sigma_a" [1 0 1]
    MediumInterface "smoke" "" Shape "sphere"
    MediumInterface "rainbow" "" Shape "sphere")");
  const auto shapes = objects_of(scene, "shape");
  const Object& smoke = child(*shapes[0], "interior");
  EXPECT_EQ(smoke.type, "heterogeneous");
  expect_rgb(value<Rgb>(smoke, "albedo"), .75, .75, .75);
  const Object& grid = child(smoke, "sigma_t");
  EXPECT_EQ(numbers_in<float>(grid, "data"), (std::vector<float>{0, 12}));
  expect_same(value<Transform>(grid, "to_world"),
              Transform::translate({1, 0, 0}) * Transform::scale({2, 1, 1}));
  EXPECT_TRUE(is_ignored(scene, "'smoke'", "does not glow"));
  const Object& rainbow = child(*shapes[1], "interior");
  EXPECT_EQ(numbers_in<float>(child(rainbow, "sigma_t"), "data"), (std::vector<float>{2, 2, 4}));
  EXPECT_EQ(numbers_in<float>(child(rainbow, "albedo"), "data"), (std::vector<float>{.5, 1, .75}));
  const Description turned = parse_scene_of_pbrt(R"(WorldBegin
    MakeNamedMedium "a" "string type" "uniformgrid" "float density" [1] "point3 p0" [2 0 1]
      "point3 p1" [0 1 0]
    MediumInterface "a" "" Shape "sphere")");
  const Object& turned_grid = child(child(only(turned, "shape"), "interior"), "sigma_t");
  expect_same(value<Transform>(turned_grid, "to_world"), Transform::scale({2, 1, 1}));
  expect_problem(problems_of([] {
                   parse_scene_of_pbrt(
                       "WorldBegin MakeNamedMedium \"a\" \"string type\" "
                       "\"uniformgrid\" \"integer nx\" 3 \"float density\" [1]\n"
                       "MediumInterface \"a\" \"\" Shape \"sphere\"");
                 }),
                 "test.pbrt:1:75", "'density' has 1 numbers", "one for each cell");
}

/// The file's box of 8 × 8 × 16 voxels of 0.5 m with a margin of one, scaled by the scene.
TEST(PbrtMedia, FilesOfNanoVdbAreGrids) {
  const TemporaryFolder folder;
  write_file_atomically(folder / "smoke.nvdb", nano::file_of(nano::small_grid(), nano::Codec::zip));
  const Description scene = parse_scene_of_pbrt(R"(WorldBegin
    Scale 2 2 2
    MakeNamedMedium "smoke" "string type" "nanovdb" "string filename" "smoke.nvdb"
      "rgb sigma_a" [1 1 1] "rgb sigma_s" [3 3 3] "float scale" 2
    MediumInterface "smoke" "" Shape "sphere")",
                                                false, folder / "");
  const Object& smoke = child(only(scene, "shape"), "interior");
  EXPECT_EQ(value<double>(smoke, "scale"), 2);
  expect_rgb(value<Rgb>(smoke, "albedo"), .75, .75, .75);
  const Object& grid = child(smoke, "sigma_t");
  const std::vector<float> samples = numbers_in<float>(grid, "data");
  ASSERT_EQ(samples.size(), 10u * 10 * 18);
  // Voxel (1, 2, 3) is 321.
  EXPECT_EQ(samples[2 + 10 * (3 + 10 * 4)], 4 * 321);
  expect_same(value<Transform>(grid, "to_world"),
              Transform::scale({2, 2, 2}) * Transform::translate({1, 2, 3}) *
                  Transform::scale({.5, .5, .5}) * Transform::translate({-1.5, -1.5, -1.5}) *
                  Transform::scale({10, 10, 18}));
}

TEST(PbrtMedia, DamagedFilesOfNanoVdbAreMissing) {
  const TemporaryFolder folder;
  folder.write("smoke.nvdb", "hello");
  const Description scene = parse_scene_of_pbrt(R"(WorldBegin
    MakeNamedMedium "smoke" "string type" "nanovdb" "string filename" "smoke.nvdb"
    MediumInterface "smoke" "" Shape "sphere")",
                                                false, folder / "");
  EXPECT_TRUE(is_missing(scene, "'smoke'", "no file of NanoVDB"));
  EXPECT_TRUE(only(scene, "shape").children.empty() ||
              only(scene, "shape").children[0].name != "interior");
}

/// A remedy is told, whether the reader is strict or not.
TEST(PbrtMedia, DamagedFilesOfNanoVdbHaveARemedy) {
  const TemporaryFolder folder;
  std::vector<uint8_t> bytes = nano::file_of(nano::small_grid());
  bytes.resize(bytes.size() / 2);
  write_file_atomically(folder / "smoke.nvdb", bytes);
  const std::string text =
      "WorldBegin\nMakeNamedMedium \"smoke\" \"string type\" \"nanovdb\" "
      "\"string filename\" \"smoke.nvdb\"\n"
      "MediumInterface \"smoke\" \"\" Shape \"sphere\"";
  EXPECT_TRUE(is_missing(parse_scene_of_pbrt(text, false, folder / ""), "'smoke'",
                         "truncated: space is empty there; copy or write it again"));
  expect_problem(problems_of([&] { parse_scene_of_pbrt(text, true, folder / ""); }),
                 "test.pbrt:2:49", "truncated", "copy or write it again");
}

TEST(PbrtMedia, TheOthersAreTold) {
  const Description scene = parse_scene_of_pbrt(R"(WorldBegin
    MakeNamedMedium "a" "string type" "nanovdb" "string filename" "x.nvdb"
    MakeNamedMedium "b" "string type" "clowd"
    MediumInterface "a" "b" Shape "sphere")");
  EXPECT_TRUE(is_missing(scene, "'a'", "x.nvdb"));
  EXPECT_TRUE(is_ignored(scene, "'b'", "no medium 'clowd'"));
  EXPECT_EQ(only(scene, "shape").children.size(), 1u);
}

TEST(PbrtClouds, NoiseIsThatOfPbrt) {
  EXPECT_EQ(cloud_noise({0, 0, 0}), 0);
  EXPECT_EQ(cloud_noise({7, -3, 260}), 0);
  // Between (0, 0, 0), whose gradient is x + z (36 & 15 is 4), and (1, 0, 0), where it is x − z
  // (6): 0.25 and −0.75, of which the second has the weight 6 t⁵ − 15 t⁴ + 10 t³ = 0.103515625.
  EXPECT_NEAR(cloud_noise({.25, 0, 0}), .25 - .103515625, 1e-12);
  // In the middle of that cell the corners have 1, 0, 0, 0, −1, −1, −1, 1.
  EXPECT_NEAR(cloud_noise({.5, .5, .5}), -1. / 8, 1e-12);
  EXPECT_NEAR(cloud_noise({256.5, -255.5, 512.5}), -1. / 8, 1e-12);
}

TEST(PbrtClouds, DensityFallsWithHeight) {
  // Without noise what is left is twice the depth below one half.
  for (const auto& [height, density] : {std::pair(-1., 1.), {0., 1.}, {.3, .4}, {.5, 0.}, {.9, 0.}})
    EXPECT_NEAR(cloud_density({1, 0, 0}, {.2, height, .4}), density, 1e-12) << height;
  // By pbrt's formula, evaluated by another program.
  EXPECT_NEAR(cloud_density({1, 1, 5}, {.3, .6, .2}), .2604919533, 1e-9);
  EXPECT_NEAR(cloud_density({2, 0, 3}, {.13, .7, .41}), .3718194318, 1e-9);
  EXPECT_NEAR(cloud_density({2, 0, 3}, {.1, .75, .3}), .5002068949, 1e-9);
  EXPECT_NEAR(cloud_density({1, 0, 1}, {.41, .62, .83}), .1546754094, 1e-9);
}

TEST(PbrtClouds, AreSampledInTheirBox) {
  const Description scene = parse_scene_of_pbrt(R"(WorldBegin
    Translate 1 0 0
    MakeNamedMedium "c" "string type" "cloud" "float density" 2 "float wispiness" 0
      "float frequency" 3 "point3 p0" [0 .4 0] "point3 p1" [4 .5 .1]
      "rgb sigma_a" [1 1 1] "rgb sigma_s" [3 3 3] "float g" .2
    MediumInterface "c" "" Shape "sphere")");
  EXPECT_TRUE(is_approximated(scene, "'c'", "128 × 4 × 4 cells"));
  EXPECT_EQ(scene.deviations.size(), 1u);
  const Object& cloud = child(only(scene, "shape"), "interior");
  expect_rgb(value<Rgb>(cloud, "albedo"), .75, .75, .75);
  EXPECT_EQ(value<double>(only(cloud, "phase"), "g"), .2);
  const Object& grid = child(cloud, "sigma_t");
  const std::vector<float> samples = numbers_in<float>(grid, "data");
  ASSERT_EQ(samples.size(), 128u * 4 * 4);
  // The middle of cell (5, 1, 2).
  const double density = cloud_density({2, 0, 3}, {5.5 / 32, .4 + 1.5 / 40, 2.5 / 40});
  EXPECT_GT(density, .1);
  EXPECT_NEAR(samples[5 + 128 * (1 + 4 * 2)], 4 * density, 1e-5);
  expect_same(value<Transform>(grid, "to_world"),
              Transform::translate({1, .4, 0}) * Transform::scale({4, .1, .1}), 1e-5);
}

}  // namespace
}  // namespace kaustik::pbrt
