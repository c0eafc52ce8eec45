// The photon map against the unbiased integrators, component by component: `path` for what the
// camera finds, `lighttracer` for what light paths find better, caustics first of all.

#include <array>

#include <gtest/gtest-spi.h>

#include "kaustik/loader/scene_format.h"
#include "kaustik/scene/overrides.h"
#include "tests/support/forgetful.h"
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
std::string small_lamp() {
  return flat("rectangle",
              scale("0.6, 0.6, 1") + rotate("1, 0, 0", 180) + translate("0, 0.1, 1.98"),
              diffuse("0, 0, 0") + area_light("10, 9, 8"));
}
std::string cube(const std::string& transform) {
  return fmt::format(R"(<shape type="cube"><transform name="to_world">{}</transform>{}</shape>)",
                     transform, diffuse("0.5, 0.5, 0.5"));
}

const std::string box =
    walls() + white_floor() + small_lamp() +
    cube(scale("0.28, 0.28, 0.55") + rotate("0, 0, 1", 20) + translate("-0.35, 0.35, 0.55")) +
    cube(scale("0.25, 0.25, 0.25") + rotate("0, 0, 1", -20) + translate("0.35, -0.1, 0.25"));
std::string balls_in_room(const std::string& left, const std::string& right) {
  return walls() + white_floor() + small_lamp() + sphere("-0.45, 0.4, 0.401", 0.4, left) +
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

/// One of the scenes that ship, as a picture of 20 pixels.
Description shipped(const std::string& name, int size = 20) {
  return load_scene(fmt::format("{}/scenes/{}/{}.xml", KAUSTIK_SOURCE_DIR, name, name),
                    {{{"size", std::to_string(size)}}});
}

/// Parameters for pictures of 20 pixels, whose cache would be too coarse, and few neighbours, whose
/// disks hardly reach over the edges of walls.
std::string fine_estimates(int caustic_photons = 60'000) {
  return set("cache_minimum_spacing", 0.2) + set("cache_maximum_spacing", 4.0) +
         set("cache_quality", 0.1) + set("caustic_neighbors", 8) + set("global_neighbors", 8) +
         set("caustic_photons", int(caustic_photons * sample_share())) +
         set("global_photons", int(40'000 * sample_share()));
}

constexpr double one_percent = 0.01;

/// The photon map's pictures, and `path`'s with the same numbers of the camera: lamps in view,
/// direct light and mirror images of both are the same in both, so the difference is that of the
/// light that photons carry.
struct Measurement {
  Measurement(std::string scene_name, const TestScene& scene, double samples,
              const std::string& parameters = fine_estimates())
      : name(std::move(scene_name)),
        found(render(scene, "photonmap", parameters, {samples, 1})),
        path(render(scene, "path", "", {samples, 1})) {}

  /// Both sample these alike, and neither has a bias.
  void expect_equal_to_path(const std::string& layer) const {
    expect_equal_means(name + " " + layer,
                       Comparison::same_seed(found.values({layer}), path.values({layer})));
  }
  void expect_near_path(const std::string& layer) const {
    expect_near_means(name + " " + layer,
                      Comparison::same_seed(found.values({layer}), path.values({layer})),
                      one_percent);
  }
  void expect_near(const Passes& referee, const std::string& layer,
                   const PixelWeight& weight = {}) const {
    expect_near_means(name + " " + layer, found.mean({layer}, weight),
                      referee.mean({layer}, weight), one_percent);
  }
  /// The scene has no such light.
  void expect_none(const std::string& layer) const {
    EXPECT_EQ(found.mean({layer}).mean(), 0) << name << " " << layer;
    EXPECT_EQ(path.mean({layer}).mean(), 0) << name << " " << layer;
  }

  std::string name;
  Passes found, path;
};

Passes by_light(const TestScene& scene, double samples, const std::string& components) {
  return render(scene, "lighttracer", set("components", components.c_str()), {samples, 3});
}

/// Caustics alone, for which the camera takes more samples and the lamps send more photons.
struct CausticSamples {
  double per_pixel;
  int photons = 100'000, neighbors = 30;
};
void check_caustic(const std::string& name, const TestScene& scene, const CausticSamples& samples,
                   const Passes& light, const PixelWeight& weight = {}) {
  const Passes found = render(scene, "photonmap",
                              set("components", "caustic") +
                                  set("caustic_photons", int(samples.photons * sample_share())) +
                                  set("caustic_neighbors", samples.neighbors),
                              {samples.per_pixel, 1});
  expect_near_means(fmt::format("{} caustic, {} neighbours", name, samples.neighbors),
                    found.mean({"caustic"}, weight), light.mean({"caustic"}, weight), one_percent);
}

TEST(Components, CornellBox) {
  const TestScene scene(shipped("cornell_box"));
  const Measurement m("cornell_box", scene, 16);
  m.expect_equal_to_path("emission");
  m.expect_equal_to_path("direct");
  m.expect_none("caustic");
  m.expect_near(by_light(scene, 200, "indirect"), "indirect");
  m.expect_none("specular");
}

/// The lamp is so small that `path` hardly ever finds it behind mirror and glass: for what these
/// show there is the room below.
TEST(Components, CornellSpheresLong) {
  const TestScene scene(shipped("cornell_spheres"));
  const Measurement m("cornell_spheres", scene, 32);
  m.expect_equal_to_path("emission");
  m.expect_equal_to_path("direct");
  m.expect_near(by_light(scene, 200, "indirect"), "indirect");
}
/// The glass sphere's focus is half of all: a few pixels, so these apart and closer up.
TEST(Components, CausticsOfCornellSpheresLong) {
  const TestScene scene(shipped("cornell_spheres"));
  check_caustic("cornell_spheres, but for the focus,", scene, {32, 200'000, 8},
                by_light(scene, 400, "caustic"),
                [](int x, int y) { return x >= 11 && x < 16 && y >= 16 ? 0.0 : 1.0; });
  Description focus = shipped("cornell_spheres", 120);
  for (const char* assignment : {"film.crop_offset_x=66", "film.crop_offset_y=96",
                                 "film.crop_width=30", "film.crop_height=24"})
    override_property(focus, assignment);
  const TestScene close_up(focus);
  check_caustic("cornell_spheres, focus,", close_up, {32}, by_light(close_up, 150, "caustic"));
}

/// Rooms like that with a large lamp, which `path` finds by any way.
void check_room(const std::string& name, const std::string& left, const std::string& right) {
  const TestScene scene(balls_in_room(left, right));
  const Measurement m(name, scene, 48);
  m.expect_none("emission");  // the camera is below the lamp and looks ahead
  m.expect_equal_to_path("direct");
  m.expect_near(by_light(scene, 300, "indirect"), "indirect");
  m.expect_near_path("specular");
}
/// The same balls where most light paths come to where the camera sees them.
void check_caustics_in_the_open(const std::string& name, const std::string& left,
                                const std::string& right, double light_samples) {
  const TestScene scene(balls_on_floor(left, right));
  check_caustic(name, scene, {40}, by_light(scene, light_samples, "caustic"));
}
TEST(Components, MirrorAndGlassLong) {
  check_room("spheres", mirror(), glass());
  check_caustics_in_the_open("spheres", mirror(), glass(), 300);
}
TEST(Components, RoughAndPolishedMetalLong) {
  check_room("GGX", ggx(0.05), ggx(0.3));
  check_caustics_in_the_open("GGX", ggx(0.05), ggx(0.3), 250);
}

TEST(Components, LampBehindGlassLong) {
  const TestScene scene(lamp_behind_glass);
  const Measurement m("lamp behind glass", scene, 64, fine_estimates(200'000));
  const Passes light = by_light(scene, 200, "caustic");
  m.expect_none("emission");
  m.expect_none("direct");
  m.expect_near(light, "caustic");
  m.expect_near(by_light(scene, 1300, "indirect"), "indirect");
  m.expect_near_path("specular");
  check_caustic("lamp behind glass", scene, {16}, light);
}

/// Also what two unbiased integrators find that share nothing but the scene: where the camera sees
/// no mirror, light paths find all.
TEST(Components, PhongFloorLong) {
  const TestScene scene(glossy_floor);
  const Measurement m("Phong floor", scene, 64);
  const Passes path = render(scene, "path", "", {800, 2});
  const Passes light = render(scene, "lighttracer", "", {1500, 3});
  m.expect_equal_to_path("emission");
  m.expect_equal_to_path("direct");
  m.expect_near(path, "indirect");
  m.expect_near(path, "specular");
  check_caustic("Phong floor", scene, {32, 240'000, 8}, light);
  expect_equal_means("lighttracer and path", light.mean({""}), path.mean({""}));
  for (const char* layer : {"direct", "caustic", "indirect"})
    expect_equal_means(std::string("lighttracer and path ") + layer, light.mean({layer}),
                       path.mean({layer}));
  for (const Passes* passes : {&path, &light, &m.found})
    EXPECT_NEAR(passes->mean({"emission", "direct", "caustic", "indirect", "specular"}).mean(),
                passes->mean({""}).mean(), 1e-6);
}

/// Slope of the logarithm of the mean square error over pixels of a mean of n pictures, n = 1, 2, 4
/// … 16, over that of n. The reference's own variance is taken off.
double slope_of_error(const std::string& what, const std::vector<Image>& found,
                      const Passes& reference, const std::string& layer) {
  const auto pixel_of = [&](const std::vector<Image>& images, size_t pixel, size_t count) {
    RunningStatistics values;
    for (size_t i = 0; i < count; ++i)
      values.add(double(images[i].channel(images[i].find_channel(layer + ".G"))[pixel]));
    return values;
  };
  RunningStatistics x, y;
  double xy = 0;
  std::printf("  mean square error of %s over passes:", what.c_str());
  const size_t pixels = found.front().channel(0).size();
  for (size_t n = 1; n <= found.size(); n *= 2) {
    double sum = 0;
    for (size_t pixel = 0; pixel < pixels; ++pixel) {
      const RunningStatistics truth =
          pixel_of(reference.images(), pixel, reference.images().size());
      sum += std::pow(pixel_of(found, pixel, n).mean() - truth.mean(), 2) -
             std::pow(truth.standard_error(), 2);
    }
    const double error = std::max(sum / double(pixels), 1e-12);
    std::printf(" %zu: %.3g", n, error);
    x.add(std::log(double(n)));
    y.add(std::log(error));
    xy += std::log(double(n)) * std::log(error);
  }
  const double slope =
      (xy - double(x.count()) * x.mean() * y.mean()) / (double(x.count() - 1) * x.variance());
  std::printf(", slope %.2f\n", slope);
  return slope;
}

/// Noise alone falls like 1/n, the squared bias of shrinking radii like n^(−2/3) (α = 2/3); five
/// correlated points leave the slope uncertain by about 0.2.
constexpr double flattest_slope = -0.45, steepest_slope = -1.4;

void check_slope(const std::string& layer, const Passes& found, const Passes& reference) {
  const double slope = slope_of_error(layer, found.images(), reference, layer);
  if (slow_build) return;
  EXPECT_LT(slope, flattest_slope) << layer;
  EXPECT_GT(slope, steepest_slope) << layer;
}

TEST(Components, ErrorFallsWithPassesLong) {
  const TestScene room(balls_in_room(mirror(), ggx(0.3)));
  const Passes found = render(room, "photonmap", fine_estimates(), {4, 1});
  const Passes path = render(room, "path", "", {60, 2});
  check_slope("direct", found, path);
  check_slope("specular", found, path);
  check_slope("indirect", found, by_light(room, 150, "indirect"));
  const TestScene open(balls_on_floor(glass(), ggx(0.3)));
  // Few photons and many samples of the camera: the noise is the photons'.
  const auto caustics =
      open.integrator("photonmap", set("components", "caustic") + fine_estimates(4000));
  const Passes reference = by_light(open, 200, "caustic");
  check_slope("caustic", render(open, *caustics, {24, 1}), reference);
  // The twin traces the same photons in every pass.
  const ForgetfulIntegrator twin(*caustics, ForgetfulIntegrator::Forgets::index);
  EXPECT_GT(slope_of_error("caustic by the same photons", render(open, twin, {24, 1}).images(),
                           reference, "caustic"),
            flattest_slope);
}

/// What is not wanted is not followed, and the rest has the same bits.
TEST(Components, PathAloneFindsTheSame) {
  const TestScene scene(balls_in_room(mirror(), ggx(0.3)));
  const Image all = render(scene, "path", "", {2, 1, 1}).images().front();
  for (const std::string_view component : component_names) {
    const std::string name(component);
    const Image alone =
        render(scene, "path", set("components", name.c_str()), {2, 1, 1}).images().front();
    for (const char* lane : {".R", ".G", ".B"}) {
      const auto x = all.channel(all.find_channel(name + lane)),
                 y = alone.channel(alone.find_channel(name + lane));
      EXPECT_TRUE(std::equal(x.begin(), x.end(), y.begin(), y.end())) << name << lane;
    }
  }
}

#ifndef KAUSTIK_SLOW_BUILD
/// A lamp that is 3 % brighter for one of the two: the checks notice.
TEST(Components, PlantedErrorsFail) {
  std::string brighter = lamp_behind_glass;
  const std::string radiance = "10, 9, 8";
  brighter.replace(brighter.find(radiance), radiance.size(), "10.3, 9.27, 8.24");
  const TestScene right(lamp_behind_glass), wrong(brighter);
  EXPECT_NONFATAL_FAILURE(check_caustic("3 % brighter lamp behind glass", wrong, {24, 100'000, 8},
                                        by_light(right, 160, "caustic")),
                          "is not within");
  const Passes a = render(TestScene(glossy_floor), "path", "", {64, 1});
  std::string brighter_floor = glossy_floor;
  brighter_floor.replace(brighter_floor.find(radiance), radiance.size(), "10.3, 9.27, 8.24");
  const Passes b = render(TestScene(brighter_floor), "path", "", {64, 2});
  EXPECT_NONFATAL_FAILURE(
      expect_equal_means("3 % brighter lamp, direct", b.mean({"direct"}), a.mean({"direct"})),
      "ratio");
}
#endif

}  // namespace
}  // namespace kaustik
