// The default integrator: what it decides, and that it makes the picture that all others make.

#include "kaustik/image/metrics.h"
#include "tests/integrator/media_scenes.h"
#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// A closed room 2 m wide.
std::string room_of_auto(const std::string& inside, int size) {
  const std::string white = diffuse("0.6, 0.6, 0.6");
  return camera("0, -0.9, 0.9", "0, 1, 0.6", 65, size) + flat("rectangle", "", white) +
         flat("rectangle", rotate("1, 0, 0", 180) + translate("0, 0, 2"), white) +
         flat("rectangle", rotate("0, 1, 0", 90) + translate("-1, 0, 1"), white) +
         flat("rectangle", rotate("0, 1, 0", -90) + translate("1, 0, 1"), white) +
         flat("rectangle", rotate("1, 0, 0", 90) + translate("0, 1, 1"), white) +
         flat("rectangle", rotate("1, 0, 0", -90) + translate("0, -1, 1"), white) + inside;
}
std::string ceiling_lamp(const std::string& transform, double radiance) {
  return flat("rectangle", transform, diffuse("0, 0, 0") + area_light(std::to_string(radiance)));
}
const std::string ceiling =
    scale("0.4, 0.4, 1") + rotate("1, 0, 0", 180) + translate("0, 0.2, 1.95");

/// Shines at the ceiling from behind a screen: all light is indirect.
std::string hidden_lamp() {
  return ceiling_lamp(scale("0.1, 0.1, 1") + translate("0, 0.8, 0.3"), 40) +
         flat("rectangle", scale("0.4, 0.3, 1") + rotate("1, 0, 0", 90) + translate("0, 0.6, 0.3"),
              diffuse("0.2, 0.2, 0.2"));
}

/// What light paths do follows in lines of their own.
std::string decision(const std::string& scene_text) {
  const TestScene scene(scene_text);
  const auto integrator = scene.integrator("auto");
  SessionSettings settings;
  settings.passes = 1;
  settings.samples_per_pixel = 4;
  Session session(scene.scene(), *integrator, settings);
  const SessionReport report = session.run();
  EXPECT_FALSE(report.decisions.empty());
  return report.decisions.empty() ? "" : report.decisions[0];
}
/// What pass 0 of so many samples has chosen, in one line.
std::string decision(const TestScene& scene, const Integrator& integrator, uint32_t samples) {
  SplatBuffer splats(scene.scene().film(), ComponentSet());
  const auto state = integrator.prepare({0, 0, samples}, splats, {}, {});
  EXPECT_EQ(state->report.decisions.size(), 1u);
  return state->report.decisions.empty() ? "" : state->report.decisions[0];
}
/// Other decisions name the camera alone too, to tell what they are better than.
bool is_for_camera_alone(const std::string& decision) {
  return decision.find("auto: paths from the camera alone") == 0;
}
/// Of "camera paths go on in 12 % of cases".
int going_on(const std::string& decision) {
  const std::string before = "go on in ";
  const size_t at = decision.find(before);
  if (at == std::string::npos) return -1;
  return std::stoi(decision.substr(at + before.size()));
}

/// A floor under an even sky.
std::string open_floor(const std::string& inside, int size) {
  return camera("0, -3, 1.5", "0, 0, 0", 40, size) +
         flat("rectangle", scale("3, 3, 1"), diffuse("0.5, 0.5, 0.5")) + constant_light(1) + inside;
}
std::string ball_in_the_open(int size) {
  return open_floor(sphere("0, 0, 0.5", 0.5, diffuse("0.7, 0.3, 0.3")), size);
}

/// A caustic in a white court under an even sky: paths for what the walls send on of the sky's
/// light, light paths for the lamp.
std::string court_with_a_lamp(int size) {
  const auto wall = [](const char* axis, double degrees, const char* place) {
    return flat("rectangle", scale("3, 3, 1") + rotate(axis, degrees) + translate(place),
                diffuse("0.9, 0.9, 0.9"));
  };
  return open_floor(wall("1, 0, 0", 90, "0, 3, 0") + wall("0, 1, 0", 90, "-3, 0, 0") +
                        wall("0, 1, 0", -90, "3, 0, 0") + sphere("0, 0, 0.6", 0.5, glass()) +
                        sphere("0, 0, 4", 0.05, diffuse("0, 0, 0") + area_light("3000")),
                    size);
}

/// Three scenes, three choices.
TEST(Auto, DecidesByTheScene) {
  const std::string open = decision(ball_in_the_open(64));
  EXPECT_TRUE(is_for_camera_alone(open)) << open;
  const std::string hidden = decision(room_of_auto(hidden_lamp(), 64));
  EXPECT_LT(going_on(hidden), 15) << hidden;
  EXPECT_GE(going_on(hidden), 2) << hidden;
  const std::string both = decision(court_with_a_lamp(64));
  EXPECT_GT(going_on(both), 2 * going_on(hidden)) << both << hidden;
}

/// Behind a glass ball light is focused, on the walls that gather rays meet as well.
TEST(Auto, CacheHasTheIndirectLightOfPath) {
  const TestScene scene(room_of_auto(ceiling_lamp(ceiling, 8) +
                                         sphere("0.3, 0.3, 0.6", 0.4, glass()) +
                                         sphere("-0.4, 0.4, 0.3", 0.3, phong(0.4, 0.3, 20)),
                                     slow_build ? 32 : 64));
  const Passes path = render(scene, "path", "", {100});
  const Passes cached = render(scene, "ppm", set("indirect_cache", "always"), {12});
  for (const std::string component : {"indirect", "direct"})
    expect_near_means("cached " + component,
                      Comparison(cached.mean({component}), path.mean({component})), 0.01, 0.005);
}

/// So it has where a mirror and clear glass show it, under a name that tells nothing of it.
TEST(Auto, CacheHasTheMirroredLightOfPath) {
  const TestScene scene(room_of_auto(ceiling_lamp(ceiling, 8) +
                                         sphere("0.4, 0.3, 0.6", 0.4, mirror()) +
                                         sphere("-0.5, 0.4, 0.4", 0.35, glass()),
                                     slow_build ? 32 : 64));
  const Passes path = render(scene, "path", "", {100});
  const Passes cached = render(scene, "ppm", set("indirect_cache", "always"), {12});
  for (const std::string component : {"specular", "indirect", "direct"})
    expect_near_means("cached " + component,
                      Comparison(cached.mean({component}), path.mean({component})), 0.015, 0.006);
  // Of few events, which a record does not know, a mirror shows fewer.
  const Passes short_paths = render(scene, "path", set("max_depth", 3), {60});
  const Passes short_cached =
      render(scene, "ppm", set("indirect_cache", "always") + set("max_depth", 3), {12});
  expect_near_means("short cached",
                    Comparison(short_cached.mean({"specular"}), short_paths.mean({"specular"})),
                    0.015, 0.006);
}

/// A matt room is smooth, and gathering shows the whole of it to what the camera sees.
TEST(Auto, CachesIndirectLightWhereItIsSmooth) {
  const auto has_cache = [](const std::string& scene_text, const std::string& parameters) {
    const TestScene scene(scene_text);
    SplatBuffer splats(scene.scene().film(), ComponentSet());
    const auto integrator = scene.integrator("ppm", parameters);
    const auto state = integrator->prepare({0, 0, 4}, splats, {}, {});
    const std::vector<std::string>& decisions = state->report.decisions;
    return std::any_of(decisions.begin(), decisions.end(), [](const std::string& text) {
      return text.find("diffuse indirect light is gathered") == 0;
    });
  };
  const std::string smooth = room_of_auto(ceiling_lamp(ceiling, 8), 64);
  EXPECT_TRUE(has_cache(smooth, ""));
  EXPECT_FALSE(has_cache(smooth, set("indirect_cache", "never")));
  // There is no indirect light.
  const std::string floor = open_floor("", 64);
  EXPECT_FALSE(has_cache(floor, ""));
  EXPECT_TRUE(has_cache(floor, set("indirect_cache", "always")));
}

// Slow builds take too few samples to tell.
#ifndef KAUSTIK_SLOW_BUILD

/// A method that could have been chosen.
struct Alternative {
  std::string name, type, parameters;
};

/// 16 passes, those by which `auto` decides.
SessionSettings sixteen_passes(uint64_t seed, uint32_t samples) {
  SessionSettings settings;
  settings.seed = seed;
  settings.passes = 16;
  settings.samples_per_pass = samples;
  return settings;
}

/// What a given error takes: relative squared error of 16 passes times all their rays, those of
/// pilots included, over some seeds. The truth's own noise is taken off.
double time_of(const TestScene& scene, const Image& truth, const Alternative& method) {
  constexpr uint64_t seeds = 2;
  double error = 0, rays = 0;
  for (uint64_t seed = 1; seed <= seeds; ++seed) {
    const auto integrator = scene.integrator(method.type, method.parameters);
    Session session(scene.scene(), *integrator, sixteen_passes(seed, 4));
    rays += double(session.run().rays) / double(seeds);
    error += compare_images(session.film().image(), truth).relative_mse_trimmed / double(seeds);
  }
  error -= own_relative_mse(truth);
  std::printf("  %-40s relative MSE %.3g, %.3g rays: %.3g\n", method.name.c_str(), error, rays,
              error * rays);
  return error * rays;
}

/// What is chosen takes at most 1.3 times as much as any of what could have been (as to paths and
/// photons; `auto` does not splat), since a pilot knows only so much. `wrong`, another scene's
/// choice, takes more than that; "": a few seeds can't tell, since paths find a caustic by rare
/// chance.
void expect_best(const char* what, const std::string& text, const std::string& wrong) {
  constexpr double allowed = 1.3;
  const TestScene scene(text);
  const auto reference = scene.integrator("bdpt", set("light_paths", 1.0));
  Session session(scene.scene(), *reference, sixteen_passes(77, 32));
  session.run();
  const Image truth = session.film().image();
  std::printf(" %s, truth's own relative MSE %.3g\n", what, own_relative_mse(truth));
  const double chosen = time_of(scene, truth, {"auto", "auto", ""});
  const Alternative alternatives[] = {{"paths", "path", ""},
                                      {"photons first", "ppm", set("light_paths", 1.0)},
                                      {"both everywhere", "ppm", set("choose_survival", false)},
                                      {"everything", "vcm", set("choose_survival", false)}};
  for (const Alternative& alternative : alternatives) {
    const double time = time_of(scene, truth, alternative);
    EXPECT_LT(chosen, allowed * time) << what << ": " << alternative.name;
    if (alternative.name == wrong) {
      EXPECT_GT(time, allowed * chosen) << what << ": " << wrong << " would do as well";
    }
  }
}

TEST(Auto, DecidesForTheBestLong) {
  expect_best("open", ball_in_the_open(24), "both everywhere");
  expect_best("hidden", room_of_auto(hidden_lamp(), 24), "paths");
  expect_best("both", court_with_a_lamp(24), "");
}

#endif

/// Where a point lamp shines through glass there is light that no path from the camera finds,
/// however little: light paths are traced. (Without the glass they would not be.)
TEST(Auto, LeavesOutNoLight) {
  const std::string spark = point_light("0.3, 0.3, 1", 0.05);
  const std::string hidden =
      decision(open_floor(spark + sphere("0.3, 0.3, 0.5", 0.1, glass()), 64));
  EXPECT_FALSE(is_for_camera_alone(hidden)) << hidden;
  EXPECT_NE(hidden.find("they alone might not find all light"), std::string::npos) << hidden;
  const std::string matt =
      decision(open_floor(spark + sphere("0.3, 0.3, 0.5", 0.1, diffuse("0.5, 0.5, 0.5")), 64));
  EXPECT_TRUE(is_for_camera_alone(matt)) << matt;
  // By a beam onto a plate smaller than a pixel, where no probe looks, and on to nowhere.
  const std::string narrow = R"(<emitter type="spot"><float name="cutoff_angle" value="0.2"/>
      <transform name="to_world"><lookat origin="0.3, 0.3, 1.5" target="0.3, 0.3, 0" up="0, 1, 0"/>
      </transform></emitter>)";
  const std::string plate = decision(open_floor(
      narrow + sphere("0.3, 0.3, 0.35", 0.02, glass()) +
          flat("disk", scale("0.02, 0.02, 1") + translate("0.3, 0.3, 0.3"), diffuse("0.001")),
      64));
  EXPECT_NE(plate.find("they alone might not find all light"), std::string::npos) << plate;
}

/// Where light paths do not pay, finding that out and learning where samples go take at most a
/// tenth of the rays of 16 passes. There are no light paths then: all that is traced before samples
/// is for that.
TEST(Auto, PilotIsCheap) {
  const TestScene scene(ball_in_the_open(128));
  constexpr uint32_t passes = 16, samples = 4;
  const auto integrator = scene.integrator("auto");
  SplatBuffer splats(scene.scene().film(), ComponentSet());
  double spent = 0;
  for (uint32_t pass = 0; pass < passes; ++pass) {
    const auto state = integrator->prepare({0, pass, samples}, splats, {}, {});
    ASSERT_FALSE(state->report.decisions.empty());
    ASSERT_TRUE(is_for_camera_alone(state->report.decisions[0])) << state->report.decisions[0];
    spent += double(state->report.rays);
  }
  const auto without_learning = scene.integrator("auto", set("adaptive", false));
  const auto pilot =
      double(without_learning->prepare({0, 0, samples}, splats, {}, {})->report.rays);
  SessionSettings settings;
  settings.passes = passes;
  settings.samples_per_pass = samples;
  const auto again = scene.integrator("auto");
  Session session(scene.scene(), *again, settings);
  const auto all = double(session.run().rays);
  std::printf("  of all rays %.2f %% are the pilot's, %.2f %% are learned from\n",
              100 * pilot / all, 100 * (spent - pilot) / all);
  EXPECT_GT(pilot, 0);
  EXPECT_LE(spent, 0.1 * all);
}

TEST(Auto, MakesThePictureOfPathLong) {
  const TestScene scene(room_of_auto(ceiling_lamp(ceiling, 8) +
                                         sphere("-0.4, 0.4, 0.351", 0.35, mirror()) +
                                         sphere("0.4, 0.2, 0.301", 0.3, glass()),
                                     16));
  const std::string components = set("components", "direct,indirect");
  const Passes path = render(scene, "path", components, {400, 7});
  const Passes found = render(scene, "auto", components, {160, 8});
  for (const char* layer : {"direct", "indirect"})
    expect_near_means(fmt::format("auto {}", layer), found.mean({layer}), path.mean({layer}), 0.01);
}

/// Of a glass ball, whose brightest caustic lies in full view.
TEST(Auto, MakesTheCausticsOfLightTracer) {
  const std::string small_lamp =
      ceiling_lamp(scale("0.15, 0.15, 1") + rotate("1, 0, 0", 180) + translate("0, 0.5, 1.95"), 50);
  const std::string text = room_of_auto(small_lamp + sphere("0, 0.5, 0.9", 0.3, glass()), 32);
  EXPECT_FALSE(is_for_camera_alone(decision(text)));
  const TestScene scene(text);
  const std::string components = set("components", "caustic");
  const Passes referee = render(scene, "lighttracer", components, {15, 7});
  const Passes found = render(scene, "auto", components, {12, 8});
  expect_near_means("auto caustic", found.mean({"caustic"}), referee.mean({"caustic"}), 0.01);
}

/// In a mirror ball.
TEST(Auto, ShowsTheMirrorImagesOfPath) {
  const TestScene scene(
      room_of_auto(ceiling_lamp(ceiling, 8) + sphere("-0.4, 0.4, 0.6", 0.35, mirror()), 16));
  const std::string components = set("components", "specular");
  const Passes path = render(scene, "path", components, {200, 7});
  const Passes found = render(scene, "auto", components, {200, 8});
  expect_near_means("auto specular", found.mean({"specular"}), path.mean({"specular"}), 0.01);
}

TEST(Auto, HasNoBiasWithoutLightPaths) {
  const TestScene scene(ball_in_the_open(16));
  const auto integrator = scene.integrator("auto");
  const Passes path = render(scene, "path", "", {64, 7});
  const Passes found = render(scene, *integrator, {64, 8});
  const std::string chosen = decision(scene, *integrator, uint32_t(64 * sample_share()));
  EXPECT_TRUE(is_for_camera_alone(chosen)) << chosen;
  for (const char* layer : {"", "direct"})
    expect_equal_means(fmt::format("auto {}", layer), found.mean({layer}), path.mean({layer}));
}

TEST(Auto, IsTheDefault) {
  const std::string floor = camera("0, 0, 3", "0, 0, 0", 40, 8, "0, 1, 0") + constant_light(1);
  const Description plain = description_of(floor + flat("rectangle", "", diffuse("0.5, 0.5, 0.5")));
  EXPECT_EQ(integrator_type(plain, TestScene(plain).scene()), "auto");
  // Surfaces with models of their own would be ignored by it.
  const Description modelled =
      description_of(floor + flat("rectangle", "",
                                  diffuse("0.5, 0.5, 0.5") + "<integrator type=\"localphong\"/>"));
  EXPECT_EQ(integrator_type(modelled, TestScene(modelled).scene()), "photonmap");
  const Description named = description_of("<integrator type=\"path\"/>" + floor +
                                           flat("rectangle", "", diffuse("0.5, 0.5, 0.5")));
  EXPECT_EQ(integrator_type(named, TestScene(named).scene()), "path");
}

}  // namespace
}  // namespace kaustik
