// Connection and merging: every choice of techniques makes the same picture.

#include "kaustik/material/fresnel.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

std::string wall(const std::string& transform, const std::string& bsdf) {
  return flat("rectangle", transform, bsdf);
}

/// A closed room 2 m wide with a glossy floor, a mirror, a glass and a rough metal ball.
std::string room(const std::string& lights, int size = 8) {
  const std::string white = diffuse("0.5, 0.5, 0.5");
  return camera("0.1, -0.9, 0.9", "0, 1, 0.5", 65, size) +
         wall(rotate("1, 0, 0", 180) + translate("0, 0, 2"), white) +
         wall(rotate("0, 1, 0", 90) + translate("-1, 0, 1"), diffuse("0.6, 0.1, 0.1")) +
         wall(rotate("0, 1, 0", -90) + translate("1, 0, 1"), diffuse("0.1, 0.5, 0.1")) +
         wall(rotate("1, 0, 0", 90) + translate("0, 1, 1"), white) +
         wall(rotate("1, 0, 0", -90) + translate("0, -1, 1"), white) +
         wall("", phong(0.4, 0.3, 8)) + sphere("-0.5, 0.4, 0.351", 0.35, mirror()) +
         sphere("0.5, 0.1, 0.301", 0.3, glass()) + sphere("0, 0.6, 0.251", 0.25, ggx(0.3)) + lights;
}
std::string large_lamp(bool two_sided = false) {
  return flat("rectangle",
              scale("0.85, 0.85, 1") + rotate("1, 0, 0", 180) + translate("0, 0.1, 1.9"),
              diffuse("0, 0, 0") +
                  fmt::format(R"(<emitter type="area"><rgb name="radiance" value="10, 9, 8"/>
                              <boolean name="two_sided" value="{}"/></emitter>)",
                              two_sided));
}

struct Choice {
  const char* name;
  bool unidirectional, next_event, splats, connections;
};
std::string techniques(const Choice& c) {
  return set("unidirectional", c.unidirectional) + set("next_event", c.next_event) +
         set("splats", c.splats) + set("connections", c.connections);
}

/// What all that follows in this room is compared with, rendered once.
const Passes& room_by_path() {
  static const Passes path = render(TestScene(room(large_lamp())), "path", "", {1200, 7});
  return path;
}

/// Every set of unbiased techniques that finds all light finds that of `path`, in all components.
TEST(Vcm, AnyUnbiasedTechniquesLong) {
  const TestScene scene(room(large_lamp()));
  const Passes& path = room_by_path();
  const Choice choices[] = {{"met", true, false, false, false},
                            {"sampled", true, true, false, false},
                            {"sampled and splatted", true, true, true, false},
                            {"connected", true, true, false, true},
                            {"all", true, true, true, true}};
  for (const Choice& c : choices) {
    const Passes found = render(scene, "bdpt", techniques(c), {c.next_event ? 340.0 : 900.0, 8});
    for (const char* layer : {"", "direct", "indirect", "specular"})
      expect_equal_means(fmt::format("{} {}", c.name, layer), found.mean({layer}),
                         path.mean({layer}));
  }
}

/// Splats need no light that is met: what the camera sees by the floor's diffuse lobe is found
/// without.
TEST(Vcm, WithoutMeetingLightsLong) {
  const TestScene scene(room(large_lamp()));
  const Passes& path = room_by_path();
  const Passes found = render(scene, "bdpt", techniques({"", false, true, true, true}), {320, 8});
  for (const char* layer : {"direct", "indirect"})
    expect_equal_means(fmt::format("lights not met, {}", layer), found.mean({layer}),
                       path.mean({layer}));
}

/// All kinds of lights, which differ in their densities.
TEST(Vcm, AnyLightLong) {
  const std::string floor =
      wall("", diffuse("0.5, 0.4, 0.3")) +
      wall(rotate("1, 0, 0", 90) + translate("0, 1, 1"), diffuse("0.5, 0.5, 0.5")) +
      sphere("-0.45, 0.3, 0.401", 0.4, phong(0.4, 0.3, 8)) +
      camera("0, -2.2, 1.3", "0, 0.2, 0.35", 48, 16);
  const struct {
    const char* name;
    double share;  ///< of the samples that the noisiest takes
    std::string light;
  } rows[] = {{"point", 0.9, point_light("0.3, -0.2, 1.2", 2)},
              {"directional", 0.9, directional_light("0.2, 0.3, -1", 2)},
              {"constant", 0.8, constant_light(1)},
              {"two-sided lamp", 1.15,
               flat("rectangle", scale("0.3, 0.3, 1") + translate("0, 0.4, 0.9"),
                    diffuse("0, 0, 0") +
                        R"(<emitter type="area"><rgb name="radiance" value="3"/>
                                          <boolean name="two_sided" value="true"/></emitter>)")},
              {"distributed", 0.9,
               R"(<emitter type="distributed"><point name="position" value="0.4, 0, 0.9"/>
               <float name="radius" value="0.1"/><rgb name="intensity" value="1"/></emitter>)"},
              {"ball", 1.15, sphere("0.4, 0, 0.7", 0.15, diffuse("0, 0, 0") + area_light("5"))},
              {"two lamps", 1,
               point_light("0.3, -0.2, 1.2", 2) +
                   sphere("0.4, 0, 0.7", 0.15, diffuse("0, 0, 0") + area_light("5"))}};
  for (const auto& row : rows) {
    const TestScene scene(floor + row.light);
    const Passes path = render(scene, "path", "", {300 * row.share, 7});
    for (const char* type : {"bdpt", "vcm"}) {
      const bool unbiased = type == std::string("bdpt");
      const Passes found =
          render(scene, type, set("radius", 0.01), {(unbiased ? 240 : 60) * row.share, 8});
      expect_equal_means(fmt::format("{} {}", row.name, type), found.mean({""}), path.mean({""}));
      if (unbiased)
        expect_equal_means(fmt::format("{} {} indirect", row.name, type), found.mean({"indirect"}),
                           path.mean({"indirect"}));
    }
  }
}

/// Merging is biased by its radius alone. The noise is that of the light paths: many for few
/// samples of the camera.
TEST(Vcm, MergingLong) {
  const TestScene scene(room(large_lamp()));
  const Passes& path = room_by_path();
  for (const char* type : {"vcm", "ppm"}) {
    const Passes found =
        render(scene, type, set("radius", 0.03) + set("light_paths", 16.0), {200, 8});
    for (const char* layer : {"direct", "indirect"})
      expect_near_means(fmt::format("{} {}", type, layer), found.mean({layer}), path.mean({layer}),
                        0.01);
  }
}

/// Hundreds of vertices in each disk on a floor that is not matt: the eight samples of a pixel
/// share them out. A lamp shines at the ceiling.
TEST(Vcm, MergingInPartsLong) {
  const TestScene scene(
      camera("0, -1.5, 0.5", "0, 0, 0", 40, 16) + wall("", phong(0.4, 0.3, 8)) +
      wall(rotate("1, 0, 0", 180) + translate("0, 0, 1"), diffuse("0.8, 0.8, 0.8")) +
      flat("rectangle", scale("0.2, 0.2, 1") + translate("0, 0.3, 0.6"),
           diffuse("0, 0, 0") + area_light("10")));
  const Passes path = render(scene, "path", "", {800, 7});
  for (const char* type : {"vcm", "ppm"}) {
    const Passes found = render(
        scene, type, set("radius", 0.1) + set("light_paths", 32.0) + set("indirect_cache", "never"),
        {8, 8});
    expect_near_means(fmt::format("{} in parts", type), found.mean({"indirect"}),
                      path.mean({"indirect"}), 0.01);
  }
}

/// Where a small lamp shines through glass only light paths know it.
TEST(Vcm, CausticOfASmallLampLong) {
  const TestScene scene(camera("0, -2.2, 1.3", "0, 0.2, 0.35", 48, 16) +
                        wall("", diffuse("0.5, 0.5, 0.5")) + sphere("0, 0.1, 0.5", 0.3, glass()) +
                        sphere("0, 0.3, 1.6", 0.02, diffuse("0, 0, 0") + area_light("500")));
  const Passes light = render(scene, "lighttracer", set("components", "caustic"), {300, 7});
  for (const char* type : {"bdpt", "vcm"})
    expect_near_means(
        fmt::format("caustic by {}", type),
        render(scene, type, set("components", "caustic") + set("light_paths", 1.0), {200, 8})
            .mean({"caustic"}),
        light.mean({"caustic"}), 0.01);
}

/// A court that is a fiftieth of what the sun shines on, with nine lamps of which one reaches it.
std::string court_in_a_town() {
  const std::string grey = diffuse("0.6, 0.55, 0.5");
  std::string text = camera("0.3, -1.6, 1.5", "0, 0, 0.3", 60, 16) +
                     wall(scale("12, 12, 1"), diffuse("0.5, 0.45, 0.4")) +
                     sphere("0.5, 0.6, 0.31", 0.3, diffuse("0.2, 0.4, 0.7")) +
                     directional_light("0.3, 0.35, -1", 2);
  const auto block = [&](const std::string& size, const std::string& at) {
    text += flat("cube", scale(size) + translate(at), grey);
  };
  block("2.2, 0.1, 1.5", "0, 2.1, 1.5");
  block("2.2, 0.1, 1.5", "0, -2.1, 1.5");
  block("0.1, 2.2, 1.5", "-2.1, 0, 1.5");
  block("0.1, 2.2, 1.5", "2.1, 0, 1.5");
  for (int i = 0; i < 9; ++i)
    text += point_light(fmt::format("{}, {}, 2.5", 8 * (i % 3 - 1), 8 * (i / 3 - 1)), 4);
  return text;
}

/// What light paths learn leaves the picture as it is.
TEST(Vcm, GuidedLong) {
  const TestScene scene(court_in_a_town());
  const Passes path = render(scene, "path", "", {300, 7});
  const Passes found = render(scene, "bdpt", "", {100, 8});
  for (const char* layer : {"direct", "indirect"})
    expect_equal_means(fmt::format("guided, {}", layer), found.mean({layer}), path.mean({layer}));
  const Passes merged = render(scene, "vcm", set("radius", 0.02), {100, 8});
  expect_near_means("guided, merged", merged.mean({"indirect"}), path.mean({"indirect"}), 0.01);
}

/// And it learns something: where few light paths are of use, and nothing else finds indirect
/// light, guided ones leave less than half of the variance.
TEST(Vcm, GuidingPaysLong) {
  const TestScene scene(court_in_a_town());
  const auto variance = [&](const char* type, bool guiding) {
    const Passes passes =
        render(scene, type,
               set("guiding", guiding) + set("next_event", false) + set("radius", 0.05) +
                   set("light_paths", 16.0) + set("components", "indirect"),
               {8, 9});
    double sum = 0;
    for (size_t i = 0; i < passes.images()[0].pixel_count(); ++i) {
      RunningStatistics pixel;
      for (const Image& image : passes.images())
        pixel.add(double(image.channel(image.find_channel("indirect.G"))[i]));
      sum += pixel.variance();
    }
    return sum;
  };
  for (const char* type : {"bdpt", "vcm", "ppm"}) {
    const double share = variance(type, true) / variance(type, false);
    std::printf("  %s: guided light paths leave %.2f of the variance\n", type, share);
    EXPECT_LT(share, 0.5) << type;
  }
}

/// Without a technique no light is found, which is told; any technique finds some.
TEST(Vcm, NoTechniqueIsToldOf) {
  const TestScene scene(room(large_lamp(), 4));
  const auto warnings = [&](const std::string& switched_on) {
    std::string parameters;
    for (const char* name : {"unidirectional", "next_event", "splats", "connections", "merging"})
      parameters += set(name, name == switched_on);
    SplatBuffer splats(scene.scene().film(), ComponentSet());
    return scene.integrator("vcm", parameters)->prepare({1, 0, 1}, splats, {}, {})->report.warnings;
  };
  ASSERT_EQ(warnings("none").size(), 1u);
  EXPECT_NE(warnings("none")[0].find("all techniques are switched off"), std::string::npos);
  for (const char* name : {"unidirectional", "next_event", "splats", "connections", "merging"})
    EXPECT_TRUE(warnings(name).empty()) << name;
}

/// A lamp mirrored in glass is there in every sample: paths branch, they do not choose.
TEST(Vcm, MirroredLampsAreNoNoise) {
  const TestScene scene(
      camera("0, -2, 2", "0, 0, 0", 1, 4) +
      flat("rectangle", scale("3, 3, 1"), R"(<bsdf type="dielectric">
                                               <float name="int_ior" value="1.5"/></bsdf>)") +
      flat("rectangle", rotate("1, 0, 0", 135) + translate("0, 2, 2"), area_light("100")));
  const double seen = 100 * double(fresnel_dielectric(std::sqrt(0.5f), 1.5f).reflectance);
  for (const char* type : {"bdpt", "vcm", "auto"}) {
    const Passes found = render(scene, type, "", {1, 1, 2});
    for (const Image& image : found.images())
      for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
          EXPECT_NEAR(double(image.at(x, y, 0)), seen, 0.05 * seen) << type;
  }
}

/// Of a pane before the sky layers show the pane, not what it mirrors.
TEST(Vcm, LayersShowTheLikelyBranch) {
  const TestScene scene(
      camera("0, 0, 2", "0, 1, 2", 1, 2) +
      flat("rectangle", scale("9, 9, 1") + rotate("1, 0, 0", 120) + translate("0, 3, 2"),
           R"(<bsdf type="dielectric"/>)") +
      flat("rectangle", scale("50, 50, 1"), diffuse("0.2, 0.7, 0.3")) + constant_light(1));
  for (const char* type : {"path", "bdpt"}) {
    const Passes found = render(scene, type, "", {16, 1, 1});
    const Image& image = found.images().front();
    const int albedo = image.find_channel("albedo.G");
    ASSERT_GE(albedo, 0);
    EXPECT_GT(double(image.at(0, 0, albedo)), 0.9) << type;
  }
}

/// max_depth cuts all techniques at the same length.
TEST(Vcm, LongestPathLong) {
  const TestScene scene(room(large_lamp(), 16));
  for (const int depth : {2, 3, 4}) {
    const Passes path = render(scene, "path", set("max_depth", depth), {130, 7});
    for (const char* type : {"bdpt", "vcm"})
      expect_near_means(
          fmt::format("{} with at most {} segments", type, depth),
          render(scene, type, set("max_depth", depth) + set("light_paths", 2.0), {40, 8})
              .mean({""}),
          path.mean({""}), 0.01);
  }
}

}  // namespace
}  // namespace kaustik
