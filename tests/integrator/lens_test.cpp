// A camera with a lens: every method sees the same blur through it.

#include "tests/support/measure.h"
#include "tests/support/scene_text.h"

namespace kaustik {
namespace {

using namespace test;

/// The camera with a lens of that radius in place of its pinhole, sharp 2 m before it.
std::string with_lens(std::string text, double radius) {
  const std::string pinhole = R"(type="perspective">)";
  return text.replace(
      text.find(pinhole), pinhole.size(),
      R"(type="thinlens">)" + set("aperture_radius", radius) + set("focus_distance", 2.0));
}

/// The columns just outside of the card's sharp edge: what is there is blur.
const std::string whole_camera = camera("0, 0, 3", "0, 0, 0", 40, 12, "0, 1, 0");
std::string camera_at_the_edge() {
  std::string text = whole_camera;
  const std::string film = "<film type=\"hdrfilm\">";
  return text.replace(text.find(film), film.size(),
                      film + set("crop_offset_x", 8) + set("crop_width", 2));
}

const std::string direct_light = R"(<emitter type="spot"><rgb name="intensity" value="10"/>
    <float name="cutoff_angle" value="24"/><float name="beam_width" value="22"/>
    <transform name="to_world"><lookat origin="0.4, 0, 2.9" target="0.4, 0, 0" up="0, 1, 0"/>
    </transform></emitter>)";
/// A lamp behind the camera and walls that send its light on.
const std::string indirect_light =
    flat("rectangle", scale("0.7, 0.7, 1") + rotate("1, 0, 0", 180) + translate("0, 0, 4"),
         area_light("10")) +
    flat("rectangle", scale("3, 3, 1") + rotate("0, 1, 0", 90) + translate("-1.2, 0, 0"),
         diffuse("0.8")) +
    flat("rectangle", scale("3, 3, 1") + rotate("0, 1, 0", -90) + translate("1.2, 0, 0"),
         diffuse("0.8"));

/// A white card before a dark wall, both out of focus for a lens.
TestScene card_seen_by(const std::string& view, const std::string& light = direct_light) {
  return TestScene(view + flat("rectangle", scale("0.4, 2, 1"), diffuse("0.8")) +
                   flat("rectangle", scale("4, 4, 1") + translate("0, 0, -1"), diffuse("0.1")) +
                   light);
}

/// Mean of the picture, a value per pass.
std::vector<double> means(const TestScene& scene, const std::string& type, double samples,
                          const std::string& parameters = "") {
  std::vector<std::string> warnings;
  const auto integrator = make_integrator(
      description_of("<integrator type=\"" + type + "\">" + parameters + "</integrator>"),
      scene.scene(), warnings);
  std::vector<double> result;
  for (uint32_t pass = 0; pass < measured_passes; ++pass) {
    SessionSettings settings;
    settings.first_pass = pass;
    settings.passes = 1;
    settings.samples_per_pixel = uint32_t(std::max(1.0, samples * sample_share()));
    Session session(scene.scene(), *integrator, settings);
    session.run();
    result.push_back(Passes::mean_of(session.film().image(), {""}));
  }
  return result;
}
RunningStatistics statistics_of(const std::vector<double>& values) {
  RunningStatistics result;
  for (const double value : values) result.add(value);
  return result;
}

// By rays from the lens and by light paths to it.
TEST(Lens, LightPathsReachItAsRaysLeaveIt) {
  const TestScene scene = card_seen_by(with_lens(camera_at_the_edge(), 0.6));
  expect_equal_means("lighttracer", statistics_of(means(scene, "lighttracer", 6000)),
                     statistics_of(means(scene, "path", 2500)));
}

/// A half plane that shines, 3 m before the camera, whose edge is blurred by the lens.
TestScene glowing_edge_seen_by(const std::string& view) {
  return TestScene(view + flat("rectangle", scale("50, 50, 1") + translate("-50, 0, 0"),
                               diffuse("0, 0, 0") + area_light("1")));
}
/// What the picture's columns from `first` on, `count` of 40, show of it: through a point l of the
/// lens, across the edge, the ray that meets the sharp plane at f meets the half plane where
/// l (1 − d/F) + f d/F > 0: for l below f d/(d − F).
double mean_at_edge(int first, int count, double radius, double focus, double lens_at = 0) {
  constexpr double distance = 3;
  const double tan_half_fov = std::tan(20 * std::numbers::pi / 180);
  constexpr int steps = 2000;
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double plane = 1 - 2 * (first + count * (i + 0.5) / steps) / 40;
    const double sharp = focus * tan_half_fov * plane;
    const double t =
        std::clamp((sharp * distance / (distance - focus) - lens_at) / radius, -1.0, 1.0);
    sum += 0.5 + (t * std::sqrt(1 - t * t) + std::asin(t)) * std::numbers::inv_pi;
  }
  return sum / steps;
}

// The closed form of the blur, and its twins: a lens that is off by little would be found.
TEST(Lens, BlursAnEdgeAsMuchAsItShould) {
  std::string view = with_lens(camera("0, 0, 3", "0, 0, 0", 40, 40, "0, 1, 0"), 0.6);
  const std::string film = "<film type=\"hdrfilm\">";
  view.replace(view.find(film), film.size(),
               film + set("crop_offset_x", 17) + set("crop_width", 1) + set("crop_height", 16));
  const RunningStatistics seen = render(glowing_edge_seen_by(view), "path", "", {3000}).mean({""});
  expect_mean("edge through a lens", seen, mean_at_edge(17, 1, 0.6, 2));
  if (slow_build) return;
  const auto is_refused = [&](double radius, double focus, double lens_at) {
    return Comparison(seen, mean_at_edge(17, 1, radius, focus, lens_at)).p_value_of_equality() <
           check_level();
  };
  EXPECT_TRUE(is_refused(0.6, 2.02, 0)) << "focus off by 1 %";
  EXPECT_TRUE(is_refused(0.62, 2, 0)) << "radius off by 3 %";
  EXPECT_TRUE(is_refused(0.6, 2, 0.012)) << "lens off by 2 % of its radius";
}

/// What weighs light by both ends knows where rays began.
void expect_methods_to_agree(const TestScene& scene) {
  const std::vector<double> path = means(scene, "path", 64);
  const auto expect = [&](const std::string& type, const std::string& parameters,
                          double tolerance) {
    expect_near_means(type, Comparison::same_seed(means(scene, type, 64, parameters), path),
                      tolerance, 0.005);
  };
  expect("bdpt", "", 0.005);
  expect("vcm", set("light_paths", 2.0), 0.01);
  expect("photonmap", set("global_photons", 5000), 0.01);
}

TEST(Lens, MethodsFromBothEndsAgree) {
  expect_methods_to_agree(card_seen_by(with_lens(whole_camera, 0.6), indirect_light));
}

// The twin: without the lens the edge is sharp.
TEST(Lens, APinholeSeesAnotherPicture) {
  const RunningStatistics blurred =
      statistics_of(means(card_seen_by(with_lens(camera_at_the_edge(), 0.6)), "path", 64));
  const RunningStatistics sharp_one =
      statistics_of(means(card_seen_by(camera_at_the_edge()), "path", 64));
  EXPECT_GT(blurred.mean(), 1.3 * sharp_one.mean());
}

/// Along parallel lines, 2 m wide.
const std::string parallel_camera =
    R"(<sensor type="orthographic"><transform name="to_world">
    <lookat origin="0, 0, 3" target="0, 0, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><rfilter type="box"/>)" +
    set("width", 12) + set("height", 12) + "</film></sensor>";

TEST(ParallelView, LightPathsReachItAsRaysLeaveIt) {
  const TestScene scene = card_seen_by(parallel_camera);
  expect_equal_means("lighttracer", statistics_of(means(scene, "lighttracer", 600)),
                     statistics_of(means(scene, "path", 250)));
}

TEST(ParallelView, MethodsFromBothEndsAgree) {
  expect_methods_to_agree(card_seen_by(parallel_camera, indirect_light));
}

// A card of 0.8 m before the camera takes 0.4 of the picture's width, near or far.
TEST(ParallelView, SizesDoNotDependOnDistances) {
  for (const char* away : {"0, 0, -5", "0, 0, 2"}) {
    const TestScene scene(parallel_camera +
                          flat("rectangle", scale("0.4, 2, 1") + translate(away), area_light("1")));
    const RunningStatistics seen = statistics_of(means(scene, "path", 64));
    EXPECT_NEAR(seen.mean(), 0.4, 0.002) << away;
  }
}

}  // namespace
}  // namespace kaustik
