// Light paths that learn where to go on from surfaces: light from the next room.

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// A room, and beyond a gap in its wall a longer one, whose lamp shines away from the gap.
std::string next_room(int size) {
  const std::string white = diffuse("0.6, 0.6, 0.6");
  const auto block = [&](const std::string& half, const std::string& at) {
    return flat("cube", scale(half) + translate(at), white);
  };
  return camera("0.8, -0.8, 1.4", "-0.6, 0.6, 0.5", 70, size) +
         block("4, 1.2, 0.1", "-2, 0, -0.1") + block("4, 1.2, 0.1", "-2, 0, 2.1") +
         block("4, 0.1, 1", "-2, 1.1, 1") + block("4, 0.1, 1", "-2, -1.1, 1") +
         block("0.1, 1.2, 1", "1.1, 0, 1") + block("0.1, 1.2, 1", "-6.1, 0, 1") +
         // The gap: 0.3 m wide, as high as the room.
         block("0.1, 0.7, 1", "-1.1, -0.3, 1") + block("0.1, 0.15, 1", "-1.1, 0.85, 1") +
         flat("rectangle",
              scale("0.5, 0.5, 1") + rotate("0, 1, 0", -90) + translate("-4.5, -0.3, 1"),
              diffuse("0, 0, 0") + area_light("30"));
}

bool is_of_guides(const std::string& decision) {
  return decision.find("are guided") != std::string::npos;
}
bool is_guided(const PassReport& report) {
  return std::any_of(report.decisions.begin(), report.decisions.end(), is_of_guides);
}

/// A ball and a block on a floor that scatters most light past them, and a lamp.
std::string open_ground() {
  return camera("0, -3, 2", "0, 0, 0.2", 45, 12) +
         flat("rectangle", scale("3, 3, 1"), diffuse("0.6, 0.5, 0.4")) +
         sphere("-0.4, 0, 0.35", 0.35, diffuse("0.7, 0.3, 0.3")) +
         flat("cube", scale("0.25, 0.25, 0.4") + translate("0.5, 0.3, 0.4"),
              diffuse("0.3, 0.4, 0.7")) +
         flat("rectangle", scale("0.5, 0.5, 1") + rotate("1, 0, 0", 180) + translate("0, 0.5, 2.5"),
              diffuse("0, 0, 0") + area_light("10"));
}

/// What was learned leaves the picture as it is, by all weights: those of connections ask both ends
/// of a path for its densities.
TEST(GuidedScattering, LeavesThePictureAsItIsLong) {
  const TestScene scene(open_ground());
  const Passes path = render(scene, "path", "", {6000, 7});
  for (const char* type : {"bdpt", "vcm"}) {
    const auto integrator =
        scene.integrator(type, set("light_paths", 4.0) + set("splats", true) + set("radius", 0.02));
    const Passes found = render(scene, *integrator, {500, 8});
    SplatBuffer splats(scene.scene().film(), ComponentSet::all());
    EXPECT_TRUE(is_guided(integrator->prepare({8, 0, 500}, splats, {}, {})->report)) << type;
    const std::string name = fmt::format("guided scattering, {}", type);
    if (type == std::string("bdpt"))
      expect_equal_means(name, found.mean({"indirect"}), path.mean({"indirect"}));
    else
      expect_near_means(name, found.mean({"indirect"}), path.mean({"indirect"}), 0.01);
  }
}

TEST(GuidedScattering, PaysLong) {
  const TestScene scene(next_room(24));
  const auto variance = [&](const char* type, bool guided) {
    const Passes passes = render(scene, type,
                                 set("guided_scattering", guided) + set("next_event", false) +
                                     set("radius", 0.1) + set("light_paths", 16.0),
                                 {16, 9});
    double sum = 0;
    for (size_t i = 0; i < passes.images()[0].pixel_count(); ++i) {
      RunningStatistics pixel;
      for (const Image& image : passes.images())
        pixel.add(double(image.channel(image.find_channel("indirect.G"))[i]));
      sum += pixel.variance();
    }
    return sum;
  };
  for (const char* type : {"ppm", "vcm"}) {
    const double share = variance(type, true) / variance(type, false);
    std::printf("  %s: guided scattering leaves %.2f of the variance\n", type, share);
    EXPECT_LT(share, 0.7) << type;
  }
}

/// Any number of threads, and whoever renders a pass alone: the same bits.
void expect_same_for_threads_and_passes(const char* type, const std::string& parameters) {
  SCOPED_TRACE(type);
  const TestScene scene(next_room(16));
  const auto picture = [&](uint32_t first, uint32_t passes, int threads) {
    const auto integrator = scene.integrator(type, parameters);
    SessionSettings settings;
    settings.first_pass = first;
    settings.passes = passes;
    settings.samples_per_pass = 8;
    settings.threads = threads;
    Session session(scene.scene(), *integrator, settings);
    const SessionReport report = session.run();
    EXPECT_TRUE(std::any_of(report.decisions.begin(), report.decisions.end(), is_of_guides));
    return session.film().image();
  };
  const auto pixels = [](const Image& image) {
    const auto values = image.channel(image.find_channel("indirect.G"));
    return std::vector<float>(values.begin(), values.end());
  };
  const auto of_one = pixels(picture(0, 3, 1));
  EXPECT_EQ(of_one, pixels(picture(0, 3, 4)));
  const auto third = pixels(picture(2, 1, 2)), first_two = pixels(picture(0, 2, 2));
  for (size_t i = 0; i < of_one.size(); ++i)
    EXPECT_NEAR(of_one[i], (2 * first_two[i] + third[i]) / 3, 1e-5f * of_one[i]);
}

TEST(GuidedScattering, SameForThreadsAndPasses) {
  const std::string light_paths = set("light_paths", slow_build ? 4.0 : 16.0);
  expect_same_for_threads_and_passes("vcm", light_paths);
  // Passes that are made up for have no connections here, and so keep other vertices.
  expect_same_for_threads_and_passes("bdpt", light_paths);
}

/// Between walls that are seen and lit everywhere there is nothing to guide, and it is left.
TEST(GuidedScattering, IsLeftWhereItDoesNotPay) {
  const TestScene scene(
      camera("0, -0.9, 1", "0, 1, 1", 90, 16) +
      flat("cube", scale("1, 1, 1") + translate("0, 0, 1"), diffuse("0.5, 0.5, 0.5")) +
      point_light("0, 0, 1.8", 5));
  SplatBuffer splats(scene.scene().film(), ComponentSet());
  const auto integrator = scene.integrator("ppm", set("light_paths", 16.0));
  EXPECT_FALSE(is_guided(integrator->prepare({1, 0, 16}, splats, {}, {})->report));
}

}  // namespace
}  // namespace kaustik
