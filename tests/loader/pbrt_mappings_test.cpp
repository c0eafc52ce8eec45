// Textures of pbrt that lie by the place in space: meshes get the uv.

#include <cmath>
#include <numbers>

#include "tests/loader/pbrt_support.h"

namespace kaustik::pbrt {
namespace {

using std::numbers::pi;

/// Shapes of a matt surface with a chequered texture of the mapping.
Description mapped(const std::string& mapping, const std::string& shapes,
                   const std::string& before = "") {
  return parse_scene_of_pbrt(
      "WorldBegin AttributeBegin " + before +
      " Texture \"t\" \"spectrum\" \"checkerboard\" \"string mapping\" " + mapping +
      " AttributeEnd Material \"diffuse\" \"texture reflectance\" \"t\"\n" + shapes);
}

void expect_floats(const Object& mesh, const char* name, const std::vector<float>& expected) {
  const auto numbers = numbers_in<float>(mesh, name);
  ASSERT_EQ(numbers.size(), expected.size()) << name;
  for (size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(numbers[i], expected[i], 1e-5) << i;
}

TEST(PbrtMappings, PlanesAreExact) {
  const Description scene = mapped(
      "\"planar\" \"vector3 v1\" [2 0 0] \"vector3 v2\" [0 0 .5] \"float udelta\" .1 "
      "\"float vdelta\" .2",
      "Translate 0 0 4 Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 2] "
      "\"point2 uv\" [0 0 0 0 0 0]",
      "Translate 1 0 0");
  // The vertices are (−1, 0, 4), (0, 0, 4), (−1, 1, 6) in the texture's space.
  expect_floats(only(scene, "shape"), "uv", {-1.9f, 2.2f, .1f, 2.2f, -1.9f, 3.2f});
  EXPECT_TRUE(scene.deviations.empty());
}

TEST(PbrtMappings, PlanesHaveDefaults) {
  const Description scene = mapped("\"planar\"", "Shape \"disk\" \"float height\" 2");
  const Object& disk = only(scene, "shape");
  const auto points = numbers_in<float>(disk, "positions"), uv = numbers_in<float>(disk, "uv");
  ASSERT_EQ(points.size() / 3, uv.size() / 2);
  for (size_t i = 0; i < uv.size() / 2; ++i) {
    EXPECT_EQ(uv[2 * i], points[3 * i]);
    EXPECT_EQ(uv[2 * i + 1], points[3 * i + 1]);
  }
}

TEST(PbrtMappings, SpheresAreSplitWhereTheAngleBegins) {
  const Description scene =
      mapped("\"spherical\"",
             "Shape \"trianglemesh\" \"point3 P\" [1 .1 0 1 -.1 0 1 0 1] \"normal N\" "
             "[0 0 1 0 1 0 1 0 0]");
  const Object& mesh = only(scene, "shape");
  // u is the angle from +z over π, v that about z over 2π.
  const auto a = float(std::atan(.1) / (2 * pi));
  expect_floats(mesh, "uv", {.5f, a, .5f, 1 - a, .25f, 0, .5f, 1 + a, .25f, 1});
  expect_floats(mesh, "positions", {1, .1f, 0, 1, -.1f, 0, 1, 0, 1, 1, .1f, 0, 1, 0, 1});
  expect_floats(mesh, "normals", {0, 0, 1, 0, 1, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0});
  EXPECT_EQ(numbers_in<int>(mesh, "faces"), (std::vector<int>{3, 1, 4}));
  EXPECT_TRUE(is_approximated(scene, "texture 't'", "'spherical' is exact at vertices"));
}

TEST(PbrtMappings, CylindersHaveTheirHeight) {
  const Description scene =
      mapped("\"cylindrical\"", "Shape \"trianglemesh\" \"point3 P\" [1 0 2 0 1 3 0 -1 0]");
  const Object& mesh = only(scene, "shape");
  expect_floats(mesh, "uv", {.5f, 2, .75f, 3, .25f, 0});
  EXPECT_EQ(numbers_in<int>(mesh, "faces"), (std::vector<int>{0, 1, 2}));
  EXPECT_TRUE(is_approximated(scene, "texture 't'", "'cylindrical' is exact at vertices"));
}

TEST(PbrtMappings, WhatCannotBeLaidIsTold) {
  const auto told = [](const Description& scene, const std::string& why) {
    EXPECT_TRUE(is_approximated(scene, "texture 't'", why));
    EXPECT_TRUE(is_approximated(scene, "texture 't'", "by uv, not by mapping 'planar'"));
  };
  const std::string triangle = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]";
  told(mapped("\"planar\"", "Shape \"sphere\""), "does not have its vertices");
  told(mapped("\"planar\"", triangle, "Scale 0 1 1"), "does not have its vertices");
  told(mapped("\"planar\"", "ObjectBegin \"o\" " + triangle + " ObjectEnd ObjectInstance \"o\""),
       "of an object that is placed");
  told(mapped("\"planar\"", "Texture \"holes\" \"float\" \"checkerboard\" " + triangle +
                                " \"texture alpha\" \"holes\""),
       "other textures of the surface");
  EXPECT_TRUE(is_approximated(mapped("\"planer\"", triangle), "texture 't'",
                              "by the surface's uv; did you mean 'planar'?"));
}

TEST(PbrtMappings, AlikeOnesOfSeveralTexturesAreOne) {
  const Description scene = parse_scene_of_pbrt(R"(WorldBegin
    Texture "t" "spectrum" "checkerboard" "string mapping" "planar" "vector3 v1" [0 1 0]
    Texture "h" "float" "checkerboard" "string mapping" "planar" "vector3 v1" [0 1 0]
    MakeNamedMaterial "m" "string type" "diffuse" "texture reflectance" "t"
    MakeNamedMaterial "n" "string type" "diffuse" "texture displacement" "h"
    Material "mix" "string materials" ["m" "n"]
    Shape "trianglemesh" "point3 P" [0 0 0 1 0 0 0 1 0])");
  EXPECT_TRUE(scene.deviations.empty());
  expect_floats(only(scene, "shape"), "uv", {0, 0, 0, 0, 1, 1});
}

}  // namespace
}  // namespace kaustik::pbrt
