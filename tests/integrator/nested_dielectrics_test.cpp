// Water in glass: bodies that overlap look as if their surfaces had been cut by hand.

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

std::string index_of(const std::string& inside, const std::string& outside) {
  return set("int_ior", inside.c_str()) + set("ext_ior", outside.c_str());
}
std::string dielectric(const std::string& inside, const std::string& outside) {
  return "<bsdf type=\"dielectric\">" + index_of(inside, outside) + "</bsdf>";
}
std::string body(const std::string& material, int priority) {
  return "<bsdf type=\"dielectric\">" + index_of(material, "air") + set("priority", priority) +
         "</bsdf>";
}

/// Boxes between two heights, so wide that nothing sees their sides.
std::string layer(double low, double high, const std::string& bsdf) {
  return flat("cube",
              scale(fmt::format("50, 50, {}", (high - low) / 2)) +
                  translate(fmt::format("0, 0, {}", (high + low) / 2)),
              bsdf);
}
/// A level border: `below` lies under it.
std::string border(double height, const std::string& below, const std::string& above) {
  return flat("rectangle", scale("50, 50, 1") + translate(fmt::format("0, 0, {}", height)),
              dielectric(below, above));
}

/// Below a sky with a bright half, a floor of glowing and dark stripes.
const std::string surroundings =
    camera("0, 0, 6", "0.5, 0.4, 0", 60, 12, "0, 1, 0") + constant_light(1) +
    flat("rectangle", scale("4, 50, 1") + translate("3, 0, -1"), area_light("5")) +
    flat("rectangle", scale("50, 50, 1") + translate("0, 0, -1.5"), diffuse("0.3"));

RunningStatistics seen(const std::string& bodies, double samples = 150) {
  RenderOptions options;
  options.samples = samples;
  return render(TestScene(surroundings + bodies), "path", set("max_depth", 40), options).mean({""});
}

// Glass from 0 to 1 under water up to 2. The water of the bodies reaches down into the glass.
TEST(NestedDielectrics, HiddenSurfacesAreNotThere) {
  const RunningStatistics cut = seen(
      flat("rectangle", scale("50, 50, 1") + rotate("1, 0, 0", 180), dielectric("bk7", "air")) +
      border(1, "bk7", "water") + border(2, "water", "air"));
  const auto bodies = [](int of_glass, int of_water) {
    return layer(0, 1, body("bk7", of_glass)) + layer(0.4, 2, body("water", of_water));
  };
  expect_equal_means("glass wins", seen(bodies(2, 1)), cut);
  // The first in the file wins among equals.
  expect_equal_means("glass is first", seen(bodies(0, 0)), cut);
  // Twins: where water wins the glass is thinner, and without priorities light meets surfaces that
  // should not be there.
  const RunningStatistics plain =
      seen(layer(0, 1, dielectric("bk7", "air")) + layer(0.4, 2, dielectric("water", "air")));
  EXPECT_LT(Comparison(plain, cut).p_value_of_equality(), check_level());
}

// A drop within a block of glass borders on glass, not on air.
TEST(NestedDielectrics, InnerBodiesBorderOnTheOuterOne) {
  const auto block = [](const std::string& outer, const std::string& inner) {
    return flat("cube", scale("1.5, 1.5, 1"), outer) + sphere("0.2, 0.1, 0.02", 0.95, inner);
  };
  const RunningStatistics cut =
      seen(block(dielectric("bk7", "air"), dielectric("water", "bk7")), 400);
  expect_equal_means("drop", seen(block(body("bk7", 1), body("water", 2)), 400), cut);
  const RunningStatistics plain =
      seen(block(dielectric("bk7", "air"), dielectric("water", "air")), 400);
  EXPECT_LT(Comparison(plain, cut).p_value_of_equality(), check_level());
}

// The same material twice, one body within the other's border, is one body.
TEST(NestedDielectrics, LikeMaterialsMelt) {
  expect_equal_means("melted", seen(layer(0, 1, body("bk7", 0)) + layer(0.5, 2, body("bk7", 0))),
                     seen(layer(0, 2, dielectric("bk7", "air"))));
}

/// A trough of water, filled over its rim, on a floor under a lamp: a caustic through three
/// borders.
TestScene glass_of_water() {
  return TestScene(camera("0, -3, 2.5", "0, 0, 0.3", 45, 12) +
                   flat("rectangle",
                        scale("0.4, 0.4, 1") + rotate("1, 0, 0", 180) + translate("0.5, 0, 3"),
                        area_light("30")) +
                   flat("rectangle", scale("5, 5, 1"), diffuse("0.7")) +
                   flat("cube", scale("0.6, 0.6, 0.45") + translate("0, 0, 0.5"), body("bk7", 1)) +
                   flat("cube", scale("0.5, 0.5, 0.4") + translate("0, 0, 0.6"), body("water", 2)));
}

// The answer belongs to the point, so that camera paths, light paths and photons agree.
TEST(NestedDielectrics, MethodsAgree) {
  const TestScene scene = glass_of_water();
  const auto values = [&](const std::string& type, const std::string& parameters, double samples) {
    RenderOptions options;
    options.samples = samples;
    return render(scene, type, parameters, options).mean({""});
  };
  const RunningStatistics reference = values("bdpt", "", 200);
  expect_near_means("path", Comparison(values("path", "", 1200), reference), 0.01, 0.006);
  expect_near_means(
      "photonmap",
      Comparison(
          values("photonmap", set("global_photons", 20000) + set("caustic_photons", 20000), 30),
          reference),
      0.02, 0.006);
}

TEST(NestedDielectrics, PriorityInAGroupIsTold) {
  const auto scene = build_scene(description_of(
      camera("0, -3, 2.5", "0, 0, 0.3", 45) + "<shape type=\"shapegroup\" id=\"group\">" +
      sphere("0, 0, 0", 1, body("water", 1)) + "</shape><shape type=\"instance\">" +
      "<ref id=\"group\"/></shape>"));
  ASSERT_EQ(scene->warnings().size(), 1u);
  EXPECT_NE(scene->warnings()[0].find("has no effect: it is in a shape group"), std::string::npos);
}

}  // namespace
}  // namespace kaustik
