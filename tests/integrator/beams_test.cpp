// Parallel light from flat shapes (emitter `directionalarea`): every method finds what is known in
// closed form, and the same where nothing is.

#include <numbers>

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

std::string beam(const std::string& transform, const std::string& radiance,
                 const std::string& inside = "") {
  return flat(
      "rectangle", transform,
      "<emitter type=\"directionalarea\">" +
          (inside.empty() ? "<rgb name=\"radiance\" value=\"" + radiance + "\"/>" : inside) +
          "</emitter>");
}

/// A beam falls on a floor under 60 degrees from its normal, and is seen from the side.
class BeamOnFloor : public testing::Test {
 protected:
  BeamOnFloor()
      : scene_(camera("0, -3, 2", "0, 0, 0", 4, 4) +
               flat("rectangle", scale("3, 3, 1"), diffuse("0.6, 0.6, 0.6")) +
               beam(scale("0.5") + rotate("0, 1, 0", 180) + translate("0, 0, 2") +
                        rotate("0, 1, 0", 60),
                    "2, 2, 2")) {}
  /// E cos 60° ρ / π, the same everywhere within.
  static constexpr double radiance = 2 * 0.5 * 0.6 / std::numbers::pi;

  void check(const std::string& type, const std::string& parameters, double samples) {
    const Passes found = render(scene_, type, parameters, {.samples = samples});
    expect_mean(type, found.mean({""}), radiance);
    expect_mean(type + " direct", found.mean({"direct"}), radiance);
  }
  TestScene scene_;
};

TEST_F(BeamOnFloor, IsFoundByAll) {
  for (const char* type : {"path", "bdpt", "vcm", "auto", "ppm", "photonmap", "raytracing"})
    check(type, "", 4);
}
/// Of its light paths few come to what the camera sees.
TEST_F(BeamOnFloor, IsFoundByLightPaths) { check("lighttracer", "", 4000); }

TEST(Beams, EndAtTheirBorders) {
  const TestScene scene(camera("0, -3, 2", "1.6, 0, 0", 4, 4) +
                        flat("rectangle", scale("3, 3, 1"), diffuse("0.6")) +
                        beam(rotate("0, 1, 0", 180) + translate("0, 0, 2"), "2, 2, 2"));
  for (const char* type : {"path", "vcm", "lighttracer", "photonmap"})
    EXPECT_EQ(render(scene, type, "", {.samples = 16}).mean({""}).mean(), 0) << type;
}

/// A floor with a wall, lit by a beam with a picture and by a lamp: lights are chosen, too.
std::string room_with_beam() {
  return camera("0, -2.2, 1.3", "0, 0.2, 0.35", 48, 8) +
         flat("rectangle", scale("2, 2, 1"), phong(0.4, 0.3, 6)) +
         flat("rectangle", rotate("1, 0, 0", 90) + translate("0, 1.5, 0"), diffuse("0.6")) +
         beam(scale("0.6") + rotate("1, 0, 0", 200) + translate("-0.2, -0.6, 1.9"), "",
              R"(<texture name="radiance" type="checkerboard"><rgb name="color0" value="0, 0, 0"/>
              <rgb name="color1" value="3, 2, 1"/><transform name="to_uv"><scale value="2"/>
              </transform></texture>)") +
         point_light("0.5, 0, 1.6", 0.5);
}

TEST(Beams, OfPicturesAreFoundByAll) {
  const TestScene scene(room_with_beam());
  const RunningStatistics by_path = render(scene, "path", set("max_depth", 3), {300, 1}).mean({""});
  for (const char* integrator : {"lighttracer", "bdpt"})
    expect_equal_means(
        integrator, render(scene, integrator, set("max_depth", 3), {400, 2}).mean({""}), by_path);
  expect_near_means("vcm", render(scene, "vcm", set("max_depth", 3), {300, 3}).mean({""}), by_path,
                    0.01);
}

TEST(Beams, MakeCaustics) {
  const TestScene scene(
      camera("0, -2.2, 1.3", "0, 0, 0", 40, 8) +
      flat("rectangle", scale("2, 2, 1"), diffuse("0.7")) + sphere("0, 0, 0.5", 0.3, glass()) +
      beam(scale("0.4") + rotate("1, 0, 0", 180) + translate("0.1, 0, 1.6"), "3, 3, 3"));
  const auto caustic = [&](const char* integrator, double samples) {
    return render(scene, integrator, set("components", "caustic"), {samples, 7}).mean({"caustic"});
  };
  expect_equal_means("bdpt, caustic", caustic("bdpt", 700), caustic("lighttracer", 200));
}

}  // namespace
}  // namespace kaustik
