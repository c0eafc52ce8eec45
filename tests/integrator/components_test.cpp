// The photon map against the unbiased integrators, component by component: `path` for what it finds
// well, `lighttracer` for caustics.

#include <array>

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

std::string wall(const std::string& transform, const std::string& bsdf) {
  return flat("rectangle", transform, bsdf);
}

/// A closed room 2 m wide with a red and a green wall, seen from inside; without floor and lamp.
std::string walls() {
  const std::string white = diffuse("0.5, 0.5, 0.5");
  return camera("0.1, -0.9, 0.9", "0, 1, 0.7", 65, 20) +
         wall(rotate("1, 0, 0", 180) + translate("0, 0, 2"), white) +
         wall(rotate("0, 1, 0", 90) + translate("-1, 0, 1"), diffuse("0.6, 0.1, 0.1")) +
         wall(rotate("0, 1, 0", -90) + translate("1, 0, 1"), diffuse("0.1, 0.5, 0.1")) +
         wall(rotate("1, 0, 0", 90) + translate("0, 1, 1"), white) +
         wall(rotate("1, 0, 0", -90) + translate("0, -1, 1"), white);
}
std::string white_floor() { return wall(scale("1, 1, 1"), diffuse("0.5, 0.5, 0.5")); }
std::string lamp() {
  return flat("rectangle",
              scale("0.6, 0.6, 1") + rotate("1, 0, 0", 180) + translate("0, 0.1, 1.98"),
              diffuse("0, 0, 0") + area_light("10, 9, 8"));
}
std::string cube(const std::string& transform) {
  return fmt::format(R"(<shape type="cube"><transform name="to_world">{}</transform>{}</shape>)",
                     transform, diffuse("0.5, 0.5, 0.5"));
}

const std::string box =
    walls() + white_floor() + lamp() +
    cube(scale("0.28, 0.28, 0.55") + rotate("0, 0, 1", 20) + translate("-0.35, 0.35, 0.55")) +
    cube(scale("0.25, 0.25, 0.25") + rotate("0, 0, 1", -20) + translate("0.35, -0.1, 0.25"));
std::string balls_in_room(const std::string& left, const std::string& right) {
  return walls() + white_floor() + lamp() + sphere("-0.45, 0.4, 0.401", 0.4, left) +
         sphere("0.45, 0, 0.401", 0.4, right);
}
/// A floor and a wall behind it, open to all other sides, with a lamp above.
std::string open_scene(const std::string& floor_bsdf, const std::string& objects) {
  return camera("0, -2.2, 1.3", "0, 0.2, 0.35", 48, 20) + wall("", floor_bsdf) +
         wall(rotate("1, 0, 0", 90) + translate("0, 1, 1"), diffuse("0.5, 0.5, 0.5")) + objects;
}
std::string near_lamp() {
  return flat("rectangle",
              scale("0.3, 0.15, 1") + rotate("1, 0, 0", 180) + translate("0, 0.1, 1.4"),
              diffuse("0, 0, 0") + area_light("10, 9, 8"));
}
std::string balls_on_floor(const std::string& left, const std::string& right) {
  return open_scene(diffuse("0.5, 0.5, 0.5"), near_lamp() + sphere("-0.45, 0.3, 0.401", 0.4, left) +
                                                  sphere("0.45, -0.05, 0.401", 0.4, right));
}
const std::string glossy_floor = open_scene(phong(0.3, 0.6, 20), near_lamp());
/// All light starts L S.
const std::string lamp_behind_glass =
    open_scene(diffuse("0.5, 0.5, 0.5"),
               sphere("0, 0, 0.7", 0.3, glass()) +
                   sphere("0, 0, 0.7", 0.2, diffuse("0, 0, 0") + area_light("10, 9, 8")));

/// Parameters for pictures of 20 pixels, whose cache would be too coarse, and few neighbours, whose
/// disks hardly reach over the edges of walls.
std::string fine_estimates() {
  return set("cache_minimum_spacing", 0.2) + set("cache_maximum_spacing", 4.0) +
         set("caustic_neighbors", 8) + set("global_neighbors", 8) + set("caustic_photons", 60'000) +
         set("global_photons", 40'000);
}

struct Samples {
  double photonmap, path;
};

void compare(const std::string& name, const TestScene& scene,
             const std::vector<std::string>& layers, const Samples& samples) {
  const Passes found = render(scene, "photonmap", fine_estimates(), {samples.photonmap, 1});
  const Passes path = render(scene, "path", "", {samples.path, 2});
  for (const std::string& layer : layers)
    // What `path` finds of caustics behind mirrors are rare and bright samples.
    expect_near_means(name + " " + layer, found.mean({layer}), path.mean({layer}), 0.01,
                      layer == "specular" ? 0.008 : 0.005);
}

TEST(Components, Box) { compare("box", TestScene(box), {"direct", "indirect"}, {8, 32}); }
TEST(Components, MirrorAndGlass) {
  compare("spheres", TestScene(balls_in_room(mirror(), glass())),
          {"direct", "indirect", "specular"}, {8, 48});
}
TEST(Components, RoughAndPolishedMetal) {
  compare("GGX", TestScene(balls_in_room(ggx(0.05), ggx(0.3))), {"direct", "indirect", "specular"},
          {8, 72});
}
TEST(Components, LampBehindGlass) {
  compare("lamp behind glass", TestScene(lamp_behind_glass), {"specular"}, {16, 48});
}

/// Caustics as light paths find them, in the open, where most of those come to where the camera
/// sees them.
void compare_caustics(const std::string& name, const std::string& text) {
  const TestScene scene(text);
  const RunningStatistics found =
      render(scene, "photonmap",
             set("components", "caustic") + set("caustic_photons", 100'000) +
                 set("caustic_neighbors", 30),
             {24, 1})
          .mean({"caustic"});
  const Passes light = render(scene, "lighttracer", set("components", "caustic"), {300, 3});
  expect_near_means(name + " caustic", found, light.mean({"caustic"}), 0.01);
}

TEST(Components, CausticsOfMirrorAndGlass) {
  compare_caustics("spheres", balls_on_floor(mirror(), glass()));
}
TEST(Components, CausticsOfRoughAndPolishedMetal) {
  compare_caustics("GGX", balls_on_floor(ggx(0.05), ggx(0.3)));
}
TEST(Components, CausticsOfALampBehindGlass) {
  compare_caustics("lamp behind glass", lamp_behind_glass);
}

/// Also what two unbiased integrators find that share nothing but the scene: where the camera sees
/// no mirror, light paths find all.
TEST(Components, PhongFloor) {
  const TestScene scene(glossy_floor);
  const Passes found = render(scene, "photonmap", fine_estimates(), {16, 1});
  const Passes path = render(scene, "path", "", {160, 2});
  const Passes light = render(scene, "lighttracer", "", {500, 3});
  for (const char* layer : {"direct", "caustic", "indirect", "specular"}) {
    expect_near_means(std::string("Phong floor ") + layer, found.mean({layer}), path.mean({layer}),
                      0.01, 0.008);
    expect_near_means(std::string("lighttracer and path ") + layer, light.mean({layer}),
                      path.mean({layer}), 0, 0.01);
  }
  expect_equal_means("lighttracer and path", light.mean({""}), path.mean({""}));
  for (const Passes* passes : {&path, &light, &found})
    EXPECT_NEAR(passes->mean({"emission", "direct", "caustic", "indirect", "specular"}).mean(),
                passes->mean({""}).mean(), 1e-6);
}

/// Mean square error over pixels of the mean of n passes falls like 1/n. The reference's own
/// variance is taken off.
TEST(Components, ErrorFallsWithPasses) {
  const TestScene scene(balls_in_room(diffuse("0.5, 0.5, 0.5"), ggx(0.3)));
  const Passes found = render(scene, "photonmap", fine_estimates(), {4, 1});
  const Passes reference = render(scene, "path", "", {48, 2});
  const auto pixel_of = [](const Passes& passes, int pixel, size_t count) {
    RunningStatistics values;
    for (size_t i = 0; i < count; ++i)
      values.add(
          double(passes.images()[i].channel(passes.images()[i].find_channel("G"))[size_t(pixel)]));
    return values;
  };
  RunningStatistics x, y;
  double xy = 0;
  std::printf("  mean square error over passes:");
  for (size_t n = 1; n <= found.images().size(); n *= 2) {
    double sum = 0;
    for (int pixel = 0; pixel < 400; ++pixel) {
      const RunningStatistics truth = pixel_of(reference, pixel, reference.images().size());
      sum += std::pow(pixel_of(found, pixel, n).mean() - truth.mean(), 2) -
             std::pow(truth.standard_error(), 2);
    }
    std::printf(" %zu: %.3g", n, sum / 400);
    x.add(std::log(double(n)));
    y.add(std::log(std::max(sum, 1e-12)));
    xy += std::log(double(n)) * std::log(std::max(sum, 1e-12));
  }
  const double slope =
      (xy - double(x.count()) * x.mean() * y.mean()) / (double(x.count() - 1) * x.variance());
  std::printf(", slope %.2f\n", slope);
  if (!slow_build) {
    EXPECT_LT(slope, -0.7);
    EXPECT_GT(slope, -1.3);
  }
}

}  // namespace
}  // namespace kaustik
