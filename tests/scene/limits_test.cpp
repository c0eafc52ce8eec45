// What single floats cannot carry is refused where it stands, before anything is traced.

#include "tests/scene/scene_support.h"

namespace kaustik::test {
namespace {

/// On line 3, behind a camera and a sphere.
void expect_refused(const std::string& object, const std::string& message,
                    const std::string& remedy = "1e+12") {
  expect_problem(std::string(any_camera) + "\n" + object + "\n" + any_shape, "3:1", message,
                 remedy);
}

/// The column of the object's first child.
void expect_refused_inside(const std::string& open, const std::string& inside,
                           const std::string& close, const std::string& message,
                           const std::string& remedy = "1e+12") {
  expect_problem(std::string(any_camera) + "\n" + open + inside + close + "\n" + any_shape,
                 "3:" + std::to_string(open.size() + 1), message, remedy);
}

TEST(Limits, CoordinatesOfPoints) {
  const std::string point = "<shape type=\"sphere\">", end = "</shape>";
  expect_refused_inside(point, R"(<point name="center" value="0, 2e12, 0"/>)", end,
                        "'center' is 2000000000000, outside its range",
                        "from -1000000000000 to 1000000000000");
  expect_refused_inside(
      "<emitter type=\"point\">", R"(<point name="position" value="2, -1e30, 1e6"/>)", "</emitter>",
      "'position' is -1e+30, outside its range", "from -1000000000000 to 1000000000000");
  expect_refused_inside("<shape type=\"cylinder\">", R"(<point name="p0" value="3.4e38, 0, 0"/>)",
                        end, "'p0' is 3.4e+38, outside its range",
                        "from -1000000000000 to 1000000000000");
  expect_refused_inside("<shape type=\"sdf\">", R"(<point name="center" value="1e30, 0, 0"/>)", end,
                        "'center' is 1e+30, outside its range",
                        "from -1000000000000 to 1000000000000");
}

TEST(Limits, Sizes) {
  for (const char* radius : {"1e18", "1e-30"})
    expect_refused_inside("<shape type=\"sphere\">",
                          std::string("<float name=\"radius\" value=\"") + radius + "\"/>",
                          "</shape>", "'radius' is", "1e-12 to 1000000000000 m");
}

TEST(Limits, Transforms) {
  for (const char* step :
       {R"(<translate value="0, 0, 1e13"/>)", R"(<scale value="1e13"/>)",
        R"(<scale value="1e-13"/>)", R"(<scale value="1e-20, 1, 1e20"/>)",
        R"(<lookat origin="3.4e38, -1e30, 1e38" target="0, 0, 0" up="0, 1, 0"/>)"})
    for (const char* type : {"shape type=\"rectangle\"", "emitter type=\"distributed\"",
                             "emitter type=\"point\"", "texture type=\"wood\""}) {
      const std::string open = std::string("<") + type + ">",
                        family = open.substr(1, open.find(' ') - 1);
      expect_refused_inside(open,
                            std::string("<transform name=\"to_world\">") + step + "</transform>",
                            "</" + family + ">", "'to_world' moves, grows or shrinks things");
    }
}

TEST(Limits, WhatValuesMakeTogether) {
  // Each number is in its range, the shape is not.
  expect_refused(
      "<shape type=\"sphere\"><float name=\"radius\" value=\"1e10\"/><transform "
      "name=\"to_world\"><scale value=\"1e10\"/></transform></shape>",
      "the shape reaches as far out as 1e+20 m");
  expect_refused(
      "<shape type=\"sphere\"><float name=\"radius\" value=\"1e-8\"/><transform "
      "name=\"to_world\"><scale value=\"1e-8\"/></transform></shape>",
      "the shape's area is", "1e-12 m");
  expect_problem(
      std::string(any_camera) + any_shape +
          R"(<shape type="shapegroup" id="g"><shape type="sphere"><float name="radius" value="1e9"/></shape></shape>)"
          "\n<shape type=\"instance\"><ref id=\"g\"/>"
          R"(<transform name="to_world"><scale value="1e9"/></transform></shape>)",
      "3:37", "the instance reaches as far out as 1e+18 m");
}

TEST(Limits, Densities) {
  const auto medium = [](const std::string& coefficients) {
    return "<medium type=\"homogeneous\">" + coefficients + "</medium>";
  };
  const std::string remedy = "from 1e-12 to 1e+12";
  expect_refused(medium(R"(<rgb name="sigma_s" value="1e30, 1, 1"/>)"),
                 "extinction of 1e+30 per metre is too large", remedy);
  expect_refused(medium(R"(<spectrum name="sigma_s" value="401:1e30, 402:1e-30"/>)"), "is too",
                 remedy);
  expect_refused_inside("<medium type=\"homogeneous\">", R"(<float name="scale" value="1e-38"/>)",
                        "</medium>", "extinction of 1e-38 per metre is too small", remedy);
  scene_of(std::string(any_camera) + any_shape + medium(R"(<float name="scale" value="0"/>)"));
}

TEST(Limits, TheEndsThemselvesAreFine) {
  scene_of(
      std::string(any_camera) +
      R"(<shape type="sphere"><float name="radius" value="1e12"/></shape>)"
      R"(<shape type="sphere"><float name="radius" value="1e-12"/></shape>)"
      R"(<shape type="rectangle"><transform name="to_world"><scale value="1e-12"/></transform></shape>)"
      R"(<emitter type="point"><point name="position" value="0, 1e12, 0"/></emitter>)");
}

}  // namespace
}  // namespace kaustik::test
