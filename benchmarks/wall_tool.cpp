// Whether what merges finds the light that `bdpt` finds beside walls, doors, furniture and bodies
// on a floor: in the mean of the picture and in each block of 8 x 8 pixels, on eight scenes in
// pictures of several sizes. Beside them stands what `auto` does without its test of what it merges
// (visibility=false), which need not agree. `wall_tool [SECONDS [SIZE ...]] [SCENE ...]`: for each
// seed and method, four times as long for `bdpt`; scenes by name, all without one.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "benchmarks/welch.h"
#include "kaustik/integrator/override_integrator.h"
#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/render/session.h"
#include "kaustik/scene/overrides.h"
#include "tests/support/wall_scenes.h"

namespace {

using namespace kaustik;

constexpr uint64_t seeds = 8;
/// Of all blocks of a picture, or all means, together.
constexpr double level = 0.003;
/// What merges has a bias, which shrinks with the passes: less than this part is none.
constexpr double tolerance = 0.01;
constexpr int block_size = 8;

struct Method {
  const char* name;
  const char* integrator;
  std::vector<const char*> settings;  ///< assignments
  bool has_to_agree;
};
// ppm that chooses light paths is auto.
const Method methods[] = {{"auto", "auto", {}, true},
                          {"unguarded",
                           "ppm",
                           {"integrator.choose_light_paths=true", "integrator.visibility=false"},
                           false},
                          {"vcm", "vcm", {}, true},
                          {"ppm", "ppm", {}, true},
                          {"photonmap", "photonmap", {}, true}};
const Method referee = {"bdpt", "bdpt", {}, true};

struct Measured {
  RunningStatistics mean;
  std::vector<RunningStatistics> blocks;  ///< row by row
};

/// Values of the picture's green light, one for each seed.
Measured measure(const std::string& text, const Method& method, uint64_t first_seed,
                 double seconds) {
  Description description =
      parse_mitsuba_xml("<scene version=\"3.0.0\">\n" + text + "\n</scene>\n", "scene", "");
  override_integrator(description, method.integrator);
  for (const char* setting : method.settings) override_property(description, setting);
  const auto scene = build_scene(description);
  std::vector<std::string> warnings;
  const auto integrator = make_integrator(description, *scene, warnings);
  Measured result;
  for (uint64_t seed = 0; seed < seeds; ++seed) {
    SessionSettings settings;
    settings.seed = first_seed + seed;
    settings.seconds = seconds;
    Session session(*scene, *integrator, settings);
    session.run();
    const Image image = session.film().image();
    const auto& green = image.channel(image.find_channel("G"));
    const int width = image.width(), across = (width + block_size - 1) / block_size;
    const int down = (image.height() + block_size - 1) / block_size;
    std::vector<RunningStatistics> blocks(size_t(across * down));
    double sum = 0;
    for (size_t i = 0; i < green.size(); ++i) {
      const int x = int(i) % width, y = int(i) / width;
      blocks[size_t(y / block_size * across + x / block_size)].add(double(green[i]));
      sum += double(green[i]);
    }
    result.mean.add(sum / double(green.size()));
    result.blocks.resize(blocks.size());
    for (size_t b = 0; b < blocks.size(); ++b) result.blocks[b].add(blocks[b].mean());
  }
  return result;
}

struct Blocks {
  size_t wrong = 0;
  double worst = 1;  ///< ratio of the one that is least likely
  double least_p = 1;
};

Blocks compare(const Measured& measured, const Measured& reference) {
  Blocks result;
  const double of_each = sidak_level(level, int(reference.blocks.size()));
  for (size_t b = 0; b < reference.blocks.size(); ++b) {
    const RunningStatistics &is = measured.blocks[b], &should = reference.blocks[b];
    const double p = welch_p_value(is, should, tolerance);
    result.wrong += p < of_each;
    if (p < result.least_p) {
      result.least_p = p;
      result.worst = should.mean() > 0 ? is.mean() / should.mean() : infinity;
    }
  }
  return result;
}

}  // namespace

int main(int argc, char** argv) {
  std::set<std::string> names;
  for (const auto& [name, text] : test::wall_scenes(1)) names.insert(name);
  std::vector<double> numbers;
  std::set<std::string> wanted;
  for (int i = 1; i < argc; ++i) {
    const std::string text = argv[i];
    if (names.contains(text)) {
      wanted.insert(text);
      continue;
    }
    char* end = nullptr;
    numbers.push_back(std::strtod(argv[i], &end));
    const bool is_size = numbers.size() > 1;
    const double least = is_size ? 1 : 1e-3, most = is_size ? 4096 : 1e6;
    if (*end != 0 || !(numbers.back() >= least && numbers.back() <= most)) {
      fmt::print(stderr, "wall_tool: '{}' is neither a number of seconds or pixels nor a scene\n",
                 text);
      return 2;
    }
  }
  const double seconds = numbers.empty() ? 2 : numbers[0];
  std::vector<int> sizes;
  for (size_t i = 1; i < numbers.size(); ++i) sizes.push_back(int(numbers[i]));
  if (sizes.empty()) sizes = {64, 128, 256, 512};
  bool agree = true;
  fmt::print("{:<14}{:>5} {:<10}{:>20}{:>14}{:>16}{:>14}\n", "scene", "size", "method",
             "mean / bdpt", "wrong blocks", "least likely", "its p");
  try {
    for (const int size : sizes)
      for (const auto& [name, text] : test::wall_scenes(size)) {
        if (!wanted.empty() && !wanted.contains(name)) continue;
        const Measured reference = measure(text, referee, 1, 4 * seconds);
        uint64_t seed = 1;
        for (const Method& method : methods) {
          const Measured found = measure(text, method, seed += seeds, seconds);
          const Blocks blocks = compare(found, reference);
          const double ratio = found.mean.mean() / reference.mean.mean();
          const double error =
              ratio * std::hypot(found.mean.standard_error() / found.mean.mean(),
                                 reference.mean.standard_error() / reference.mean.mean());
          const bool is_mean_wrong = welch_p_value(found.mean, reference.mean, tolerance) < level;
          if (method.has_to_agree) agree = agree && !is_mean_wrong && blocks.wrong == 0;
          fmt::print("{:<14}{:>5} {:<10}{:>20}{:>14}{:>16.3f}{:>14.2g}\n", name, size, method.name,
                     fmt::format("{:.4f} ± {:.4f}{}", ratio, error, is_mean_wrong ? " !" : ""),
                     fmt::format("{} / {}", blocks.wrong, reference.blocks.size()), blocks.worst,
                     blocks.least_p);
          std::fflush(stdout);
        }
      }
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  fmt::print("{}\n", agree ? "all agree" : "some disagree");
  return agree ? 0 : 1;
}
