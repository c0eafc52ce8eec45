// Pictures that spots and projectors throw: every method finds the same light from them.

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

const std::string black_and_white = R"(type="checkerboard"><rgb name="color0" value="0, 0, 0"/>
    <rgb name="color1" value="1, 0.8, 0.3"/><transform name="to_uv"><scale value="3"/></transform>
    </texture>)";
std::string down_from(const std::string& place) {
  return "<transform name=\"to_world\">" + rotate("1, 0, 0", 180) + translate(place) +
         "</transform>";
}

/// A floor with a wall, lit by a projector and by a spot with a slide.
std::string room() {
  return camera("0, -2.2, 1.3", "0, 0.2, 0.35", 48, 8) +
         flat("rectangle", scale("2, 2, 1"), phong(0.4, 0.3, 6)) +
         flat("rectangle", rotate("1, 0, 0", 90) + translate("0, 1.5, 0"), diffuse("0.6")) +
         "<emitter type=\"projector\"><texture name=\"irradiance\" " + black_and_white +
         set("scale", 3.0) + set("fov", 50.0) + down_from("-0.3, 0, 1.4") + "</emitter>" +
         "<emitter type=\"spot\"><texture name=\"texture\" " + black_and_white +
         set("cutoff_angle", 40.0) + set("falloff", "smooth") + down_from("0.5, 0, 1.2") +
         R"(<rgb name="intensity" value="4"/></emitter>)";
}

TEST(Slides, EveryMethodFindsTheirLight) {
  const TestScene scene(room());
  const RunningStatistics by_path = render(scene, "path", set("max_depth", 3), {300, 1}).mean({""});
  for (const char* integrator : {"lighttracer", "bdpt"})
    expect_equal_means(
        integrator, render(scene, integrator, set("max_depth", 3), {400, 2}).mean({""}), by_path);
  expect_near_means("vcm", render(scene, "vcm", set("max_depth", 3), {300, 3}).mean({""}), by_path,
                    0.01);
}

/// Photon maps: what the lamps send out by emitted rays, gathered in a ball.
TEST(Slides, PhotonsCarryTheirLightLong) {
  const TestScene scene(
      camera("0, -0.8, 0", "0, 1, -0.2", 75, 8) + sphere("0, 0, 0", 1, diffuse("0.5"), true) +
      "<emitter type=\"projector\"><texture name=\"irradiance\" " + black_and_white +
      set("scale", 5.0) + set("fov", 90.0) + down_from("0, 0, 0.3") + "</emitter>");
  const auto indirect = [&](const char* integrator, const std::string& more, double samples) {
    return render(scene, integrator, set("components", "indirect") + more, {samples, 5})
        .mean({"indirect"});
  };
  expect_near_means("photonmap, indirect",
                    indirect("photonmap",
                             set("global_photons", 20'000) + set("caustic_photons", 0) +
                                 set("global_neighbors", 12) + set("irradiance_cache", false),
                             256),
                    indirect("path", "", 1024), 0.015);
}

/// What a picture's bright parts send through a ball of glass: rays that are aimed at it and those
/// that are not find the same.
TEST(Slides, LightCaustics) {
  const TestScene scene(
      camera("0, -2.2, 1.3", "0, 0, 0", 40, 8) +
      flat("rectangle", scale("2, 2, 1"), diffuse("0.7")) + sphere("0, 0, 0.5", 0.3, glass()) +
      "<emitter type=\"projector\"><texture name=\"irradiance\" " + black_and_white +
      set("scale", 3.0) + set("fov", 70.0) + down_from("0, 0, 1.6") + "</emitter>");
  const auto caustic = [&](const char* integrator, double samples) {
    return render(scene, integrator, set("components", "caustic"), {samples, 7}).mean({"caustic"});
  };
  expect_equal_means("bdpt, caustic", caustic("bdpt", 700), caustic("lighttracer", 200));
}

}  // namespace
}  // namespace kaustik
