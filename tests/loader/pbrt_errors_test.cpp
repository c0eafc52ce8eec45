// What is wrong with files of pbrt: messages with place and remedy, and hostile files.

#include "kaustik/loader/scene_format.h"
#include "tests/loader/pbrt_support.h"

namespace kaustik::pbrt {
namespace {

void told_in_pbrt(const std::string& text, const std::string& place, const std::string& message,
                  const std::string& remedy) {
  expect_problem(problems_of([&] { parse_scene_of_pbrt(text); }), place, message, remedy);
}

TEST(PbrtErrors, MistakesHavePlaceAndRemedy) {
  told_in_pbrt("WorldBegin\n Shap \"sphere\"", "test.pbrt:2:2", "no directive 'Shap'",
               "did you mean 'Shape'");
  told_in_pbrt("Shape", "test.pbrt:1:6", "lacks a type", "in quotes");
  told_in_pbrt("[", "test.pbrt:1:1", "where a directive is expected", "Shape or Material");
  told_in_pbrt("Translate 1 2", "test.pbrt:1:14", "has 2 numbers, and needs 3", "give the others");
  told_in_pbrt("Transform [1 2]", "test.pbrt:1:15", "has 2 numbers, and needs 16", "");
  told_in_pbrt("LookAt 0 0 0 0 0 0 0 1 0", "test.pbrt:1:1", "no direction", "differ");
  told_in_pbrt("AttributeEnd", "test.pbrt:1:1", "ends nothing", "take it out");
  told_in_pbrt("AttributeBegin\nTransformEnd", "test.pbrt:2:1", "ends nothing", "test.pbrt:1:1");
  told_in_pbrt("WorldBegin AttributeBegin", "test.pbrt:1:12", "within attributes", "AttributeEnd");
  told_in_pbrt("ObjectBegin \"a\" ObjectBegin \"b\"", "test.pbrt:1:17", "in another one",
               "ObjectEnd");
  told_in_pbrt("ObjectEnd", "test.pbrt:1:1", "no object", "ObjectBegin");
  told_in_pbrt("ColorSpace \"srbg\"", "test.pbrt:1:1", "no colour space 'srbg'",
               "did you mean 'srgb'");
  told_in_pbrt("Attribute \"shapes\"", "test.pbrt:1:1", "no attributes of 'shapes'",
               "did you mean 'shape'");
  told_in_pbrt("Texture \"a\" \"colour\" \"constant\"", "test.pbrt:1:1", "type 'colour'",
               "float or spectrum");
  told_in_pbrt("Include \"nowhere.pbrt\"", "test.pbrt:1:1", "no file 'nowhere.pbrt'",
               "relative to");
  told_in_pbrt("Camera \"perspective\" \"float fov\" 180 WorldBegin", "test.pbrt:1:22",
               "180 degrees", "between 0 and 180");
  told_in_pbrt("Scale 0 1 1 Camera \"perspective\"", "test.pbrt:1:13", "singular", "factors of 0");
  told_in_pbrt("WorldBegin Material \"mix\" Shape \"sphere\"", "test.pbrt:1:12", "two materials",
               "string materials");
  told_in_pbrt(
      "WorldBegin MakeNamedMaterial \"a\" \"string type\" \"mix\" \"string materials\" [\"a\" "
      "\"a\"]\n"
      "NamedMaterial \"a\" Shape \"sphere\"",
      "test.pbrt:1:12", "mixed of itself", "other materials");
  told_in_pbrt("WorldBegin Shape \"sphere\" \"float radius\" 0", "test.pbrt:1:27", "not above zero",
               "");
  told_in_pbrt("WorldBegin LightSource \"spot\" \"point3 to\" [0 0 0]", "test.pbrt:1:12",
               "same point", "");
  told_in_pbrt("WorldBegin LightSource \"point\" \"blackbody I\" 30", "test.pbrt:1:32", "30 K",
               "200 to");
  told_in_pbrt("WorldBegin MediumInterface \"" + std::string(1000, 'x') + "\"", "test.pbrt:1:28",
               "more than 500 bytes", "shorter");
  told_in_pbrt("WorldBegin LightSource \"point\" \"spectrum I\" [400 1 300 1]", "test.pbrt:1:32",
               "do not ascend", "ascending");
}

TEST(PbrtErrors, IncludesCanFormNoCircle) {
  const TemporaryFolder folder;
  folder.write("a.pbrt", "Include \"b.pbrt\"");
  folder.write("b.pbrt", "Import \"./a.pbrt\"");
  const auto problems = problems_of([&] { load_scene(folder / "a.pbrt"); });
  EXPECT_NE(problems[0].message.find("includes itself"), std::string::npos);
}

TEST(PbrtErrors, WhatIsIncludedAgainAndAgainIsRefused) {
  const TemporaryFolder folder;
  folder.write("big.pbrt", "Identity #" + std::string(1 << 20, '.') + "\n");
  std::string text = "WorldBegin\n";
  for (int i = 0; i < 100; ++i) text += "Include \"big.pbrt\"\n";
  const std::string path = folder.write("main.pbrt", text);
  EXPECT_NE(problems_of([&] { load_scene(path); })[0].message.find("again and again"),
            std::string::npos);
}

TEST(PbrtErrors, OtherFilesAreNotQuoted) {
  const TemporaryFolder folder;
  folder.write("secret", "password: 1234\n");
  const std::string path = folder.write("main.pbrt", "WorldBegin Include \"secret\"\n");
  const auto problems = problems_of([&] { load_scene(path); });
  EXPECT_EQ(problems[0].place.line, 1);
  EXPECT_EQ(*problems[0].place.file, path);
  EXPECT_NE(problems[0].message.find("no scene of pbrt"), std::string::npos);
  for (const Problem& problem : problems)
    EXPECT_EQ((problem.message + problem.remedy).find("password"), std::string::npos);
  // Comments alone are an empty scene.
  folder.write("secret", "# nothing\n");
  EXPECT_TRUE(objects_of(load_scene(path), "shape").empty());
}

TEST(PbrtErrors, AttributesAreNoMultiplier) {
  std::string text = "WorldBegin\nAttribute \"shape\" \"float width0\" [";
  for (int i = 0; i < 200'000; ++i) text += " 1";
  text += "]\n";
  for (int i = 0; i < 5'000; ++i) text += "Shape \"sphere\"\n";
  EXPECT_NE(problems_of([&] { parse_scene_of_pbrt(text); })[0].message.find("take more than"),
            std::string::npos);
}

TEST(PbrtErrors, DepthsAndSizesAreBounded) {
  std::string deep;
  for (int i = 0; i < 20'000; ++i) deep += "AttributeBegin\n";
  EXPECT_NE(problems_of([&] { parse_scene_of_pbrt(deep); })[0].message.find("nest more than"),
            std::string::npos);
  std::string textures = "WorldBegin\nTexture \"t0\" \"spectrum\" \"constant\"\n";
  for (int i = 1; i < 100; ++i)
    textures += "Texture \"t" + std::to_string(i) +
                "\" \"spectrum\" \"scale\" \"texture tex\" \"t" + std::to_string(i - 1) + "\"\n";
  textures += "Material \"diffuse\" \"texture reflectance\" \"t99\" Shape \"sphere\"";
  EXPECT_NE(problems_of([&] { parse_scene_of_pbrt(textures); })[0].message.find("nest more than"),
            std::string::npos);
}

TEST(PbrtErrors, MeshesOfBodiesHaveABudget) {
  std::string parts = "WorldBegin\n";
  for (int i = 0; i < 20'000; ++i) parts += "Shape \"sphere\" \"float phimax\" 300\n";
  EXPECT_NE(problems_of([&] { parse_scene_of_pbrt(parts); })[0].message.find("MiB"),
            std::string::npos);
}

TEST(PbrtErrors, StrictReadersRefuseDeviations) {
  const std::string text = "WorldBegin Material \"hair\" Shape \"sphere\"\nShape \"nothing\"";
  EXPECT_EQ(parse_scene_of_pbrt(text).deviations.size(), 2u);
  const auto problems = problems_of([&] { parse_scene_of_pbrt(text, true); });
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_NE(problems[0].remedy.find("strict"), std::string::npos);
}

TEST(PbrtErrors, FormatsAreToldApart) {
  EXPECT_TRUE(is_pbrt("# a comment\n\n  LookAt 0 0 0"));
  EXPECT_TRUE(is_pbrt("Integrator\"path\""));
  EXPECT_TRUE(is_pbrt("\xef\xbb\xbfWorldBegin"));
  for (const char* text : {"", "# Radiance\nvoid plastic", "<scene/>", "{}", "Shapes", "shape x"})
    EXPECT_FALSE(is_pbrt(text)) << text;
}

}  // namespace
}  // namespace kaustik::pbrt
