// Light that is hard to find, and what learning where to send light paths brings: a pool under one
// of 51 lamps, the hundredth part of a floor under glass balls, and a room that a lamp in the next
// one lights through a door ajar. `auto` without a parameter beside others at equal time.
// `guiding_bench [seconds [scene …]]`.
#include <algorithm>
#include <cstdlib>
#include <functional>
#include <map>

#include "benchmarks/quality.h"
#include "kaustik/loader/mitsuba_xml.h"
#include "tests/support/scene_text.h"

namespace {

using namespace kaustik;
using namespace test;

constexpr int picture_size = 128;
/// A reference is rendered for so many times as long as what is measured, with a seed of its own.
constexpr double reference_factor = 4;
constexpr uint64_t reference_seed = 1000;
/// Of what is measured; the mean of their errors counts.
constexpr uint64_t seeds = 2;
/// Less than this part of the reference's own error cannot be told from it.
constexpr double least_known = 0.1;

std::string block(const std::string& half, const std::string& at, const std::string& color) {
  return flat("cube", scale(half) + translate(at), diffuse(color));
}
std::string lamp(const std::string& radiance) { return diffuse("0, 0, 0") + area_light(radiance); }

/// Water seen from below.
std::string waves() {
  return R"(<bsdf type="bumpmap"><texture type="waves" name="texture">)" + set("amplitude", 0.012) +
         set("wavelength", 0.6) + "</texture>" + glass(1.33) + "</bsdf>";
}

/// A hall of fifty lamps; one more hangs over a pool, behind walls that the light of the others has
/// to come over by the ceiling, and draws the waves on the pool's ground. Seen from under the
/// water, so that the camera sees nothing by a specular event.
std::string pool_among_lamps() {
  const std::string stone = "0.6, 0.55, 0.5";
  std::string text =
      camera("1.4, -1.5, 0.9", "0.45, -0.45, 0", 60, picture_size) +
      flat("rectangle", scale("20, 12, 1"), diffuse("0.5, 0.6, 0.7")) +
      flat("rectangle", scale("20, 12, 1") + rotate("1, 0, 0", 180) + translate("0, 0, 4"),
           diffuse("0.7, 0.7, 0.7")) +
      block("20, 0.1, 2", "0, 12, 2", stone) + block("20, 0.1, 2", "0, -12, 2", stone) +
      block("0.1, 12, 2", "20, 0, 2", stone) + block("0.1, 12, 2", "-20, 0, 2", stone) +
      flat("rectangle", scale("2, 2, 1") + translate("0, 0, 1"), waves()) +
      block("2.2, 0.1, 1.9", "0, 2.1, 1.9", stone) + block("2.2, 0.1, 1.9", "0, -2.1, 1.9", stone) +
      block("0.1, 2, 1.9", "2.1, 0, 1.9", stone) + block("0.1, 2, 1.9", "-2.1, 0, 1.9", stone) +
      sphere("0.5, 0.3, 2.6", 0.06, lamp("150"));
  for (int i = 0; i < 50; ++i)
    text += flat("rectangle",
                 scale("0.2, 0.2, 1") + rotate("1, 0, 0", 180) +
                     translate(fmt::format("{}, {}, 3.9", 1.6 * (i % 25 - 12), i < 25 ? -6 : 6)),
                 lamp("20"));
  return text;
}

/// A floor of 16 × 16 m under the sun and 25 balls of glass, of which the camera sees what lies
/// under one, about a hundredth: a caustic and a block beside it.
std::string hundredth_of_a_floor() {
  std::string text = camera("0.9, 1.05, 0.85", "0.15, 0.18, 0", 40, picture_size) +
                     flat("rectangle", scale("8, 8, 1"), diffuse("0.5, 0.45, 0.4")) +
                     directional_light("0.3, 0.35, -1", 2);
  for (int i = 0; i < 25; ++i) {
    const double x = 3.2 * (i % 5 - 2), y = 3.2 * (i / 5 - 2);
    text +=
        sphere(fmt::format("{}, {}, 1.2", x - 0.36, y - 0.42), 0.6, glass(1.33)) +
        block("0.15, 0.15, 0.15", fmt::format("{}, {}, 0.15", x - 0.35, y + 0.3), "0.7, 0.3, 0.2");
  }
  return text;
}

/// A small room, and beyond a door that is open by 8 degrees a large one, whose lamp shines away
/// from the door.
std::string door_ajar() {
  const auto wall = [](const std::string& half, const std::string& at) {
    return block(half, at, "0.6, 0.6, 0.6");
  };
  const std::string small_room = wall("1.1, 1.2, 0.1", "0, 0, -0.1") +
                                 wall("1.1, 1.2, 0.1", "0, 0, 2.1") +
                                 wall("1, 0.1, 1", "0, 1.1, 1") + wall("1, 0.1, 1", "0, -1.1, 1") +
                                 wall("0.1, 1.2, 1", "1.1, 0, 1");
  const std::string large_room =
      wall("4.2, 3.2, 0.1", "-5.2, 0, -0.1") + wall("4.2, 3.2, 0.1", "-5.2, 0, 3.1") +
      wall("4.2, 0.1, 1.5", "-5.2, 3.1, 1.5") + wall("4.2, 0.1, 1.5", "-5.2, -3.1, 1.5") +
      wall("0.1, 3, 1.5", "-9.3, 0, 1.5");
  const std::string doorway = wall("0.1, 1.3, 1.5", "-1.1, -1.7, 1.5") +
                              wall("0.1, 1.3, 1.5", "-1.1, 1.7, 1.5") +
                              wall("0.1, 0.4, 0.6", "-1.1, 0, 2.4");
  const std::string door = flat("cube",
                                scale("0.02, 0.39, 0.89") + translate("0, -0.4, 0.9") +
                                    rotate("0, 0, 1", 8) + translate("-0.97, 0.4, 0"),
                                diffuse("0.5, 0.35, 0.2"));
  return camera("0.8, -0.8, 1.4", "-1.1, 0.6, 0.7", 75, picture_size) + small_room + large_room +
         doorway + door + sphere("-0.2, 0.5, 0.25", 0.25, diffuse("0.4, 0.5, 0.7")) +
         flat("rectangle", scale("0.5, 0.5, 1") + rotate("0, 1, 0", -90) + translate("-5, -1, 1.5"),
              lamp("100"));
}

/// An integrator, with settings.
struct Method {
  std::string name, type, parameters;
};
/// `auto` first: what the others are compared with.
const std::vector<Method>& methods() {
  static const std::vector<Method> list{
      {"auto", "auto", ""},
      {"ppm", "ppm", ""},
      {"ppm_without_guiding", "ppm", set("guiding", false) + set("guided_scattering", false)},
      {"path", "path", ""},
      {"bdpt", "bdpt", ""}};
  return list;
}

struct Case {
  std::string name;
  std::function<std::string()> text;
  /// What makes the reference: `bdpt`, which has no bias, or `auto` where that is far too noisy.
  std::string reference;
};
const std::vector<Case>& cases() {
  static const std::vector<Case> list{{"pool_among_lamps", pool_among_lamps, "auto"},
                                      {"hundredth_of_a_floor", hundredth_of_a_floor, "bdpt"},
                                      {"door_ajar", door_ajar, "bdpt"}};
  return list;
}

Description description_of(const std::string& inside) {
  return parse_mitsuba_xml("<scene version=\"3.0.0\">" + inside + "</scene>", "benchmark", "");
}

struct Rendered {
  Image picture;
  SessionReport report;
};

Rendered render(const Scene& scene, const Method& method, double seconds, uint64_t seed) {
  std::vector<std::string> warnings;
  const auto integrator =
      make_integrator(description_of("<integrator type=\"" + method.type + "\">" +
                                     method.parameters + "</integrator>"),
                      scene, warnings);
  SessionSettings settings;
  settings.threads = bench::picture_threads;
  settings.seconds = seconds;
  settings.seed = seed;
  Session session(scene, *integrator, settings);
  SessionReport report = session.run();
  return {session.film().image(), std::move(report)};
}

/// Errors are without what the reference's own noise adds, on average.
struct Measured {
  double error = 0, mean_ratio = 0, passes = 0;
};

Measured measure(const Scene& scene, const Method& method, double seconds, const Image& reference,
                 double own_error) {
  Measured result;
  for (uint64_t seed = 1; seed <= seeds; ++seed) {
    const Rendered rendered = render(scene, method, seconds, seed);
    const ImageComparison quality = compare_images(rendered.picture, reference);
    result.error += (bench::error_of(quality) - own_error) / double(seeds);
    result.mean_ratio += bench::ratio_of_means(quality) / double(seeds);
    result.passes += double(rendered.report.passes) / double(seeds);
  }
  result.error = std::max(result.error, least_known * own_error);
  return result;
}

void run(const Case& one, double seconds) {
  const auto scene = build_scene(description_of(one.text()));
  const Rendered reference = render(*scene, {one.reference, one.reference, ""},
                                    reference_factor * seconds, reference_seed);
  const double own_error = own_relative_mse(reference.picture);
  std::map<std::string, Measured> found;
  for (const Method& method : methods())
    found[method.name] = measure(*scene, method, seconds, reference.picture, own_error);
  const auto compare = [&](const std::string& name, const std::string& other,
                           const std::string& with) {
    const Measured &a = found[other], &b = found[with];
    bench::report(
        name, a.error / b.error,
        fmt::format("ratio of relative MSE at equal time, {} over {}", other, with),
        fmt::format("{:.3g} s, {} seeds: {:.3g} and {:.3g}, mean of the picture over the "
                    "reference's {:.4f} and {:.4f}, {:.0f} and {:.0f} passes; the "
                    "reference is {:.3g} s of {} whose own error of {:.3g} is taken off",
                    seconds, seeds, a.error, b.error, a.mean_ratio, b.mean_ratio, a.passes,
                    b.passes, reference.report.seconds, one.reference, own_error));
  };
  for (const Method& method : methods())
    if (method.name != "auto")
      compare(fmt::format("{}_{}", one.name, method.name), method.name, "auto");
  compare("guiding_in_" + one.name, "ppm_without_guiding", "ppm");
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 5;
  const std::vector<std::string> wanted(argv + std::min(argc, 2), argv + argc);
  if (!(seconds > 0)) {
    fmt::print(stderr, "guiding_bench: asks for seconds of a picture, then for scenes\n");
    return 2;
  }
  try {
    for (const Case& one : cases())
      if (wanted.empty() || std::find(wanted.begin(), wanted.end(), one.name) != wanted.end())
        run(one, seconds);
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
