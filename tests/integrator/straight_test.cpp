// Light that goes straight on through thin panes and holes: lamps are sampled through them, every
// method finds the same light, and it counts as if the surface were not there.

#include <fmt/format.h>

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

std::string pane(const std::string& transmittance = "1, 1, 1") {
  return R"(<bsdf type="thindielectric"><float name="int_ior" value="1.5"/>
      <float name="ext_ior" value="1"/><rgb name="specular_transmittance" value=")" +
         transmittance + "\"/></bsdf>";
}
std::string holes(double opacity, const std::string& nested) {
  return R"(<bsdf type="mask">)" + set("opacity", opacity) + R"(<bsdf type="twosided">)" + nested +
         "</bsdf></bsdf>";
}
/// Seen at normal incidence: F = 0.04 of each side, 2F / (1 + F) of both.
constexpr double mirrored_by_pane = 2 * 0.04 / 1.04;

/// A floor below a lamp, seen from below `between`, which lies half way.
std::string lamp_above(const std::string& between, const std::string& lamp) {
  return camera("0, -0.02, 0.9", "0, 0, 0", 3, 4) +
         flat("rectangle", scale("2, 2, 1"), diffuse("0.5")) +
         (between.empty() ? ""
                          : flat("rectangle", scale("2, 2, 1") + translate("0, 0, 1"), between)) +
         lamp;
}

double direct(const std::string& integrator, const std::string& scene) {
  return render(TestScene(scene), integrator, set("components", "direct"), {4, 1})
      .mean({"direct"})
      .mean();
}

/// A point is found by sampling alone, without noise.
TEST(Straight, PanesAndHolesTakeTheirShareOfDirectLight) {
  const std::string lamp = point_light("0, 0, 2", 10);
  for (const char* integrator : {"path", "bdpt", "auto", "photonmap", "raytracing"}) {
    const double open = direct(integrator, lamp_above("", lamp));
    EXPECT_NEAR(open, 0.5 / pi * 10 / 4, 1e-3) << integrator;
    EXPECT_NEAR(direct(integrator, lamp_above(pane(), lamp)) / open, 1 - mirrored_by_pane, 2e-4)
        << integrator;
    EXPECT_NEAR(direct(integrator, lamp_above(pane("0.5, 0.5, 0.5"), lamp)) / open,
                0.5 * (1 - mirrored_by_pane), 2e-4)
        << integrator;
    EXPECT_NEAR(direct(integrator, lamp_above(holes(0.3, diffuse("0.5")), lamp)) / open, 0.7, 2e-4)
        << integrator;
    EXPECT_NEAR(direct(integrator, lamp_above(holes(1, diffuse("0.5")), lamp)), 0, 1e-6)
        << integrator;
  }
}

TEST(Straight, NothingOfItIsACaustic) {
  const TestScene scene(lamp_above(pane(), point_light("0, 0, 2", 10)));
  EXPECT_EQ(render(scene, "auto", "", {16, 1}).mean({"caustic"}).mean(), 0);
}

/// What is seen through a pane counts as what it is, what the pane mirrors as specular.
TEST(Straight, TheCameraSeesWhatIsBehind) {
  const TestScene scene(
      camera("0, 0, 4", "0, 0, 0", 4, 8, "0, 1, 0") +
      flat("rectangle", scale("9, 9, 1") + translate("0, 0, 2"), pane()) +
      flat("rectangle", scale("9, 9, 1"),
           diffuse("0") + R"(<emitter type="area"><rgb name="radiance" value="4"/></emitter>)") +
      flat("rectangle", rotate("1, 0, 0", 180) + scale("9, 9, 1") + translate("0, 0, 6"),
           diffuse("0") + R"(<emitter type="area"><rgb name="radiance" value="2"/></emitter>)"));
  for (const char* integrator : {"path", "auto", "bdpt", "photonmap"}) {
    const Passes passes = render(scene, integrator, "", {600, 3});
    expect_mean(fmt::format("{}, behind", integrator), passes.mean({"emission"}),
                4 * (1 - mirrored_by_pane));
    // Between the panels and the pane there is nothing that the camera would see twice.
    expect_near_means(fmt::format("{}, mirrored", integrator), passes.mean({"specular"}),
                      render(scene, "path", "", {1200, 5}).mean({"specular"}), 0.03);
    EXPECT_GT(passes.mean({"specular"}).mean(), 2 * mirrored_by_pane * 0.95) << integrator;
  }
}

/// Panes one behind the other, tinted, aslant and half there, between a wide lamp and a room.
std::string greenhouse() {
  return camera("0, -2.4, 0.9", "0, 0.2, 0.3", 46, 8) +
         flat("rectangle", scale("2, 2, 1"), phong(0.4, 0.3, 8)) +
         flat("rectangle", rotate("1, 0, 0", 90) + translate("0, 1.6, 0"), diffuse("0.6")) +
         sphere("0.4, 0.3, 0.3", 0.25, diffuse("0.5")) +
         flat("rectangle", scale("2, 2, 1") + translate("0, 0, 1.3"), pane("0.9, 0.6, 0.5")) +
         flat("rectangle", rotate("0, 1, 0", 30) + scale("2, 2, 1") + translate("0, 0, 2"),
              pane()) +
         flat("rectangle", scale("0.5, 0.7, 1") + translate("-0.4, 0, 1.1"),
              holes(0.6, diffuse("0.7"))) +
         flat("rectangle", rotate("1, 0, 0", 180) + scale("0.4, 0.4, 1") + translate("0, 0.2, 3"),
              diffuse("0") + R"(<emitter type="area"><rgb name="radiance" value="9"/></emitter>)");
}

TEST(Straight, EveryMethodFindsTheSameLight) {
  const TestScene scene(greenhouse());
  const auto means = [&](const char* integrator, double samples, uint64_t seed) {
    return render(scene, integrator, set("max_depth", 4), {samples, seed}).mean({""});
  };
  const RunningStatistics by_path = means("path", 600, 1);
  expect_equal_means("bdpt", means("bdpt", 300, 2), by_path);
  expect_equal_means("lighttracer", means("lighttracer", 3000, 3), by_path);
  for (const char* integrator : {"vcm", "ppm", "auto"})
    expect_near_means(integrator, means(integrator, 300, 4), by_path, 0.01);
}

/// At the end of paths sampled lamps and lamps that are met have to weigh alike.
TEST(Straight, TheLastEventIsComplete) {
  const TestScene scene(greenhouse());
  const auto by = [&](const char* integrator, double samples) {
    return render(scene, integrator, set("max_depth", 2), {samples, 7}).mean({"direct"});
  };
  const RunningStatistics by_path = by("path", 500);
  expect_equal_means("bdpt", by("bdpt", 300), by_path);
  expect_equal_means("lighttracer", by("lighttracer", 2000), by_path);
}

TEST(Straight, PhotonsPassOn) {
  const TestScene scene(
      camera("0, -0.8, 0", "0, 1, -0.2", 75, 8) + sphere("0, 0, 0", 1, diffuse("0.5"), true) +
      flat("rectangle", scale("2, 2, 1") + translate("0, 0, 0.1"), pane("0.8, 0.8, 0.8")) +
      point_light("0, 0.1, 0.5", 3));
  const auto indirect = [&](const char* integrator, const std::string& more, double samples) {
    return render(scene, integrator, set("components", "indirect") + more, {samples, 5})
        .mean({"indirect"});
  };
  expect_near_means("photonmap, indirect",
                    indirect("photonmap",
                             set("global_photons", 20'000) + set("caustic_photons", 0) +
                                 set("global_neighbors", 12) + set("irradiance_cache", false),
                             256),
                    indirect("path", "", 1024), 0.02);
}

/// A lamp whose surface has holes shines as ever, and shows what is behind it.
TEST(Straight, LampsMayHaveHoles) {
  const TestScene scene(
      camera("0, 0, 4", "0, 0, 0", 4, 8, "0, 1, 0") +
      flat("rectangle", scale("9, 9, 1") + translate("0, 0, 2"),
           holes(0.25, diffuse("0")) +
               R"(<emitter type="area"><rgb name="radiance" value="3"/></emitter>)") +
      flat("rectangle", scale("9, 9, 1"),
           diffuse("0") + R"(<emitter type="area"><rgb name="radiance" value="4"/></emitter>)"));
  expect_mean("both", render(scene, "path", "", {800, 3}).mean({"emission"}), 3 + 0.75 * 4);
}

/// Radiance's illum: it shines, and nobody sees it.
TEST(Straight, LampsOfNullAreNotThereForOtherLight) {
  const std::string lamp = point_light("0, 0, 2", 10);
  const auto weak = [&](double radiance) {
    return lamp_above(fmt::format(R"(<bsdf type="null"/><emitter type="area">
        <boolean name="visible" value="false"/>
        <rgb name="radiance" value="{}"/></emitter>)",
                                  radiance),
                      lamp);
  };
  const TestScene open(lamp_above("", lamp)), dark(weak(1e-6));
  for (const char* integrator : {"path", "bdpt", "auto", "photonmap"})
    expect_near_means(
        integrator, render(dark, integrator, set("components", "direct"), {64, 1}).mean({"direct"}),
        render(open, integrator, set("components", "direct"), {4, 1}).mean({"direct"}), 0.01);
}

TEST(Straight, LampsOfNullShineAndShowWhatIsBehind) {
  const TestScene scene(
      camera("0, 0, 4", "0, 0, 0", 4, 8, "0, 1, 0") +
      flat(
          "rectangle", scale("9, 9, 1") + translate("0, 0, 2"),
          R"(<bsdf type="null"/><emitter type="area"><rgb name="radiance" value="3"/></emitter>)") +
      flat("rectangle", scale("9, 9, 1"),
           diffuse("0") + R"(<emitter type="area"><rgb name="radiance" value="4"/></emitter>)"));
  for (const char* integrator : {"path", "auto", "bdpt", "photonmap"})
    expect_mean(integrator, render(scene, integrator, "", {800, 3}).mean({"emission"}), 3 + 4);
}

TEST(Straight, ShadowPhotonsAreRefused) {
  const TestScene scene(greenhouse());
  EXPECT_THROW(render(scene, "photonmap", set("shadow_photons", 1000), {1, 1}), Error);
}

}  // namespace
}  // namespace kaustik
