// Names of pbrt that are misspelt: what is told has the nearest one.

#include "tests/loader/pbrt_support.h"

namespace kaustik::pbrt {
namespace {

/// What is told of a scene, the only thing.
std::string told_of(const std::string& text) {
  const Description scene = parse_scene_of_pbrt(text);
  EXPECT_EQ(scene.deviations.size(), 1u) << text;
  return scene.deviations.empty() ? "" : scene.deviations[0].what;
}

void suggests(const std::string& text, const std::string& name) {
  const std::string what = told_of(text);
  EXPECT_TRUE(what.ends_with("; did you mean '" + name + "'?")) << what;
}

TEST(PbrtNames, OfTypesHaveTheNearestOne) {
  suggests("WorldBegin Shape \"spere\"", "sphere");
  suggests("WorldBegin Shape \"Sphere\"", "sphere");
  suggests("WorldBegin Shape \"curv\"", "curve");
  suggests("WorldBegin Material \"difuse\" Shape \"sphere\"", "diffuse");
  suggests("WorldBegin Material \"mate\" Shape \"sphere\"", "matte");
  suggests("WorldBegin Material \"interfac\" Shape \"sphere\"", "interface");
  suggests("WorldBegin LightSource \"distand\"", "distant");
  suggests(
      "WorldBegin Texture \"t\" \"spectrum\" \"imagmap\" Material \"diffuse\" "
      "\"texture reflectance\" \"t\" Shape \"sphere\"",
      "imagemap");
  suggests(
      "WorldBegin MakeNamedMedium \"m\" \"string type\" \"homogenous\" "
      "MediumInterface \"m\" \"\" Shape \"sphere\"",
      "homogeneous");
  suggests(
      "WorldBegin MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"string preset\" "
      "\"Ketschup\" MediumInterface \"m\" \"\" Shape \"sphere\"",
      "ketchup");
  suggests("Camera \"perspectiv\" WorldBegin", "perspective");
  suggests("PixelFilter \"gausian\" WorldBegin", "gaussian");
}

TEST(PbrtNames, OfThingsInTheFileHaveTheNearestOne) {
  suggests(
      "WorldBegin MakeNamedMaterial \"glass\" \"string type\" \"diffuse\" "
      "NamedMaterial \"glas\" Shape \"sphere\"",
      "glass");
  suggests(
      "WorldBegin Texture \"wood\" \"spectrum\" \"constant\" Material \"diffuse\" "
      "\"texture reflectance\" \"woud\" Shape \"sphere\"",
      "wood");
  suggests(
      "WorldBegin MakeNamedMedium \"smoke\" \"string type\" \"homogeneous\" "
      "MediumInterface \"smoek\" \"\" Shape \"sphere\"",
      "smoke");
  suggests("WorldBegin ObjectBegin \"chair\" Shape \"sphere\" ObjectEnd ObjectInstance \"chairs\"",
           "chair");
  // One of numbers is none of colours.
  EXPECT_TRUE(told_of("WorldBegin Texture \"wood\" \"float\" \"constant\" Material \"diffuse\" "
                      "\"texture reflectance\" \"wood\" Shape \"sphere\"")
                  .ends_with("of colours, but one of numbers; write \"spectrum\" behind its name"));
}

TEST(PbrtNames, ThatAreNearNoneAreToldAlone) {
  EXPECT_TRUE(told_of("WorldBegin Shape \"teapot\"").ends_with("it is left out"));
}

TEST(PbrtNames, AreTheRemedyOfStrictReaders) {
  expect_problem(problems_of([] { parse_scene_of_pbrt("WorldBegin Shape \"spere\"", true); }),
                 "test.pbrt:1:12", "no shape 'spere'", "did you mean 'sphere'?");
  const TemporaryFolder folder;
  expect_problem(problems_of([&] {
                   parse_scene_of_pbrt("WorldBegin Shape \"plymesh\" \"string filename\" \"a.ply\"",
                                       true, folder / "");
                 }),
                 "test.pbrt:1:28", "'a.ply' is not there", "relative to the folder");
}

}  // namespace
}  // namespace kaustik::pbrt
