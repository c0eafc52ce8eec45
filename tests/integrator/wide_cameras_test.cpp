// Cameras that see more than straight lines, or less than all: every method sees the same.

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// A camera in the middle of the room below, which looks down a bit.
std::string eye(const std::string& type, const std::string& parameters = "", int width = 8,
                int height = 8, const std::string& filter = "<rfilter type=\"box\"/>") {
  return "<sensor type=\"" + type + "\">" + parameters +
         R"(<transform name="to_world"><lookat origin="0.2, 0, 0.3" target="1, 0.4, 0"
         up="0, 0, 1"/></transform><film type="hdrfilm">)" +
         set("width", width) + set("height", height) + filter + "</film></sensor>";
}

/// A room with a lamp under its ceiling, and a disk over its floor.
TestScene room_seen_by(const std::string& view) {
  return TestScene(
      view + R"(<shape type="cube"><boolean name="flip_normals" value="true"/>)" + diffuse("0.5") +
      "</shape>" +
      flat("rectangle", scale("0.8, 0.8, 1") + rotate("1, 0, 0", 180) + translate("0, 0, 0.95"),
           diffuse("0, 0, 0") + area_light("1")) +
      flat("disk", scale("0.3, 0.3, 1") + translate("0.5, -0.4, -0.5"), diffuse("0.8")));
}

/// Of the mean over the picture by `weight`.
void expect_agreement(const std::string& name, const TestScene& scene,
                      const PixelWeight& weight = {}, double samples = 32) {
  const auto measured = [&](const std::string& type, double count, const std::string& parameters) {
    return render(scene, type, parameters, {count}).values({""}, weight);
  };
  const std::vector<double> path = measured("path", samples, "");
  const auto expect = [&](const std::string& type, double count, double tolerance,
                          const std::string& parameters = "") {
    expect_near_means(name + ", " + type,
                      Comparison::same_seed(measured(type, count, parameters), path), tolerance,
                      0.005);
  };
  expect("bdpt", samples, 0.006);
  expect("vcm", samples, 0.01, set("light_paths", 1.0));
  expect("lighttracer", 8 * samples, 0.01);
  expect("photonmap", samples, 0.01, set("global_photons", 5000));
}

class WideCamera : public testing::TestWithParam<std::tuple<const char*, const char*>> {};

TEST_P(WideCamera, MethodsFromBothEndsAgree) {
  const auto& [type, parameters] = GetParam();
  expect_agreement(std::string(type) + parameters, room_seen_by(eye(type, parameters)));
}
INSTANTIATE_TEST_SUITE_P(
    All, WideCamera,
    testing::Values(std::tuple("fisheye", R"(<string name="mapping" value="equidistant"/>)"),
                    std::tuple("fisheye", R"(<string name="mapping" value="equisolid"/>)"),
                    std::tuple("fisheye", R"(<string name="mapping" value="stereographic"/>)"),
                    std::tuple("fisheye", R"(<string name="mapping" value="hemispherical"/>)"),
                    std::tuple("fisheye", R"(<float name="fov" value="300"/>)"),
                    std::tuple("spherical", ""), std::tuple("cylinder", "")));

// At the edges, where the picture goes on on its other side, with a filter that reaches there.
TEST(Panorama, MethodsAgreeAtTheEdges) {
  const TestScene scene = room_seen_by(eye("spherical", "", 8, 4, R"(<rfilter type="gaussian"/>)"));
  expect_agreement(
      "edges of a sphere", scene,
      [](int x, int y) { return x == 0 || x == 7 || y == 0 || y == 3 ? 1.0 : 0.0; }, 64);
}

/// Three cards one behind the other, lit from beside the camera, of which it shows only the middle
/// one if `planes` cut off the others: the first still casts its shadow.
TestScene cards_seen_by(const std::string& type, const std::string& parameters,
                        const std::string& planes) {
  const std::string film = "<film type=\"hdrfilm\"><rfilter type=\"box\"/>" + set("width", 8) +
                           set("height", 8) + "</film>";
  return TestScene(
      "<sensor type=\"" + type + "\">" + parameters + planes +
      R"(<transform name="to_world"><lookat origin="0, 0, 3" target="0, 0, 0"
                   up="0, 1, 0"/></transform>)" +
      film + "</sensor>" +
      flat("rectangle", scale("0.2, 0.2, 1") + translate("-0.2, 0, 2"), diffuse("0.8")) +
      flat("rectangle", scale("0.6, 0.6, 1") + translate("0, 0, 0.5"), diffuse("0.6")) +
      flat("rectangle", scale("4, 4, 1") + translate("0, 0, -1"), diffuse("0.5")) +
      R"(<emitter type="spot"><rgb name="intensity" value="10"/>
                   <float name="cutoff_angle" value="24"/><float name="beam_width" value="22"/>
                   <transform name="to_world"><lookat origin="0.2, 0.1, 2.9" target="0, 0, 0"
                   up="0, 1, 0"/></transform></emitter>)");
}

TEST(ClipPlanes, MethodsFromBothEndsAgree) {
  const std::vector<std::pair<std::string, std::string>> views = {
      {"orthographic", ""},
      {"telecentric", set("aperture_radius", 0.6) + set("focus_distance", 1.5)},
      {"thinlens", set("fov", 40.0) + set("aperture_radius", 0.1) + set("focus_distance", 2.5)},
      {"fisheye", set("fov", 60.0)}};
  for (const auto& [type, parameters] : views) {
    const TestScene clipped =
        cards_seen_by(type, parameters, set("near_clip", 1.5) + set("far_clip", 3.5));
    expect_agreement("clipped " + type, clipped, {}, type == "telecentric" ? 64 : 24);
    const double ratio =
        render(clipped, "path", "", {16}).mean({""}).mean() /
        render(cards_seen_by(type, parameters, ""), "path", "", {16}).mean({""}).mean();
    EXPECT_LT(ratio, 0.9) << type;
    EXPECT_GT(ratio, 0.05) << type;
  }
}

// A picture of irradiance by a fisheye, as glare studies and daylight studies take them.
TEST(Fisheye, PicturesOfIrradiance) {
  std::string view = eye("fisheye");
  view.insert(view.find("<rfilter"), set("quantity", "irradiance"));
  const TestScene scene = room_seen_by(view);
  expect_agreement("irradiance in a fisheye", scene);
}

// Σ L cos θ dω over a hemispherical picture is the irradiance at its place: π times the mean over
// the circle, since that mapping's pixels are equal parts of cos θ dω.
TEST(Fisheye, HemisphericalPicturesSumUpToIrradiance) {
  const std::string walls = sphere("0, 0, 0", 5, diffuse("0, 0, 0") + area_light("3"), true);
  const TestScene scene(
      eye("fisheye", R"(<string name="mapping" value="hemispherical"/>)", 16, 16) + walls);
  // The circle takes π/4 of the picture.
  expect_mean("irradiance from a fisheye", render(scene, "path", "", {50}).mean({""}),
              3 * std::numbers::pi / 4);
  expect_mean("the same by light paths", render(scene, "lighttracer", "", {20}).mean({""}),
              3 * std::numbers::pi / 4);
}

}  // namespace
}  // namespace kaustik
