// Caustic photons that are aimed at specular objects make the same picture as those that are not:
// with a radius that does not depend on the photons the estimates are linear in them, so the means
// agree exactly. And lamps elsewhere don't starve the one that makes the caustic.

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

struct Case {
  std::string name;
  std::string objects;  ///< over a floor that the picture shows
  int photons, unaimed_photons;
  double samples = 16;
};

/// From beneath everything that stands over the floor.
std::string floor_from_above(double half_side) {
  constexpr double height = 0.15;
  return camera("0, 0, 0.15", "0, 0, 0", 2 * 180 / std::numbers::pi * std::atan(half_side / height),
                16, "0, 1, 0") +
         flat("rectangle", scale("1, 1, 1"), diffuse("0.5, 0.5, 0.5"));
}

Passes caustic(const TestScene& scene, const char* aim, int photons, double samples,
               uint64_t seed) {
  return render(scene, "photonmap",
                set("components", "caustic") + set("aim", aim) +
                    set("caustic_photons", int(photons * sample_share())) +
                    set("caustic_neighbors", 100'000) + set("caustic_radius", 0.2) +
                    set("caustic_kernel", "constant"),
                {samples, seed});
}

void check(const Case& c, double half_side = 0.8) {
  const TestScene scene(floor_from_above(half_side) + c.objects);
  const RunningStatistics unaimed =
      caustic(scene, "none", c.unaimed_photons, c.samples, 2).mean({"caustic"});
  EXPECT_GT(unaimed.mean(), 0);
  for (const char* aim : {"boxes", "projection_map"})
    expect_equal_means(c.name + ", " + aim,
                       caustic(scene, aim, c.photons, c.samples, 1).mean({"caustic"}), unaimed);
}

const std::string lamp = point_light("0.3, 0.2, 1", 1);

/// Thin as a pin, 75 times as long as wide, and so near to the lamp that it reaches past it on both
/// sides.
TEST(AimedCaustics, MirrorNeedle) {
  check({"mirror needle",
         point_light("0.05, 0.05, 0.35", 1) +
             cylinder("-0.3, -0.1, 0.3", "0.4, 0.2, 0.5", 0.005, mirror()),
         20'000, 100'000});
}
TEST(AimedCaustics, GlassNeedle) {
  check({"glass needle",
         point_light("0.05, 0.05, 0.45", 1) +
             cylinder("-0.3, -0.1, 0.3", "0.4, 0.2, 0.5", 0.005, glass()),
         20'000, 150'000});
}
/// What only the rim reflects: the mirror's face toward the lamp is covered by a black disk.
TEST(AimedCaustics, SphereAtItsSilhouette) {
  check({"silhouette",
         point_light("0, 0, 1.1", 1) + sphere("0, 0, 0.4", 0.2, mirror()) +
             flat("disk", translate("0, 0, 0.65") + scale("0.12, 0.12, 1"), diffuse("0, 0, 0")),
         20'000, 300'000});
}
TEST(AimedCaustics, DirectionalLight) {
  check({"directional",
         directional_light("0.3, 0.2, -1", 1) + sphere("0, 0, 0.7", 0.3, glass()) +
             sphere("0.4, 0.4, 0.4", 0.2, mirror()),
         25'000, 70'000});
}
TEST(AimedCaustics, EnvironmentLight) {
  check({"environment",
         constant_light(1) + sphere("0, 0, 0.7", 0.45, glass()) +
             sphere("0.6, 0.6, 0.4", 0.25, mirror()),
         150'000, 700'000});
}
TEST(AimedCaustics, AreaLight) {
  check({"area light",
         flat("rectangle", scale("0.2, 0.1, 1") + rotate("1, 0, 0", 180) + translate("0.3, 0.2, 1"),
              diffuse("0, 0, 0") + area_light("5, 5, 5")) +
             sphere("0, 0, 0.6", 0.3, glass()) +
             cylinder("-0.5, -0.1, 0.3", "-0.5, 0.2, 0.5", 0.02, mirror()),
         30'000, 100'000});
}

/// The light tracer aims as well; what it finds of a caustic is the same without.
TEST(AimedCaustics, LightTracer) {
  const TestScene scene(floor_from_above(0.8) + lamp + sphere("0, 0, 0.4", 0.2, glass()) +
                        sphere("0.3, -0.3, 0.2", 0.1, mirror()));
  const auto caustic_of = [&](const char* aim, double samples, uint64_t seed) {
    return render(scene, "lighttracer", set("components", "caustic") + set("aim", aim),
                  {samples, seed})
        .mean({"caustic"});
  };
  const RunningStatistics unaimed = caustic_of("none", 400, 2);
  for (const char* aim : {"boxes", "projection_map"}) {
    const RunningStatistics aimed = caustic_of(aim, 60, 1);
    expect_equal_means(std::string("aimed light tracer, ") + aim, aimed, unaimed);
    // Aiming is worth it.
    EXPECT_LT(aimed.standard_error(), 1.5 * unaimed.standard_error());
  }
}

#ifndef KAUSTIK_SLOW_BUILD
/// Fifty lamps far off, hidden behind a wall from the ball of glass that the last one shines on.
TEST(AimedCaustics, LampsElsewhereDoNotStarveOne) {
  const std::string ball = floor_from_above(0.8) + lamp + sphere("0, 0, 0.4", 0.15, glass());
  std::string many =
      ball + flat("rectangle", rotate("0, 1, 0", 90) + translate("2, 0, 0") + scale("1, 9, 9"),
                  diffuse("0, 0, 0"));
  for (int i = 0; i < 50; ++i)
    many += point_light(fmt::format("{}, {}, 1", 3 + i % 5, i / 5 - 5), 20);
  const TestScene with_one(ball), with_many(many);
  constexpr int photons = 5'000;
  const RunningStatistics one = caustic(with_one, "boxes", photons, 16, 1).mean({"caustic"});
  const RunningStatistics of_many = caustic(with_many, "boxes", photons, 16, 1).mean({"caustic"});
  std::printf("  caustic of one lamp: error %.5f alone, %.5f among 51\n",
              one.standard_error() / one.mean(), of_many.standard_error() / of_many.mean());
  expect_equal_means("caustic of one lamp among 51", of_many, one);
  // A standard deviation over 16 values is itself uncertain by a fifth.
  EXPECT_LT(of_many.standard_error(), 2 * 1.5 * one.standard_error());
}
#endif

}  // namespace
}  // namespace kaustik
