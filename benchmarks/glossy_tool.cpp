// Whether `photonmap` finds the same light with its irradiance cache and without, and `path` too,
// where something glossy is in view: each component of six scenes in pictures of several sizes,
// from seeds of their own; means of the picture and of 8 × 8 blocks of it.
// `glossy_tool [PASSES [SIZE ...]] [SCENE ...] [NAME=VALUE ...]`: passes of photonmap for each of
// 8 seeds; scenes by name, all without one; parameters of photonmap.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "benchmarks/report.h"
#include "benchmarks/welch.h"
#include "kaustik/base/statistics.h"
#include "kaustik/integrator/override_integrator.h"
#include "kaustik/loader/mitsuba_xml.h"
#include "kaustik/render/session.h"
#include "kaustik/scene/overrides.h"
#include "kaustik/transport/component.h"
#include "tests/support/glossy_scenes.h"

namespace {

using namespace kaustik;

constexpr uint64_t seeds = 8;
/// Of all comparisons together.
constexpr double level = 0.003;
/// Photon maps have a bias, which shrinks with the passes: less than this part is none …
constexpr double tolerance = 0.003;
/// … and in a block, where edges and shadows begin, less than this.
constexpr double block_tolerance = 0.03;
/// Components that are less than this part of the picture are left out, and blocks that have less
/// than this part of what the component has elsewhere.
constexpr double least_part = 0.002, least_block_part = 0.1;
/// Blocks per side of the picture.
constexpr int blocks = 8;

/// Passes of path for one of photonmap, which are quick.
constexpr uint32_t path_passes = 16;
/// Larger pictures need fewer samples of each pixel.
uint32_t samples_per_pass(int size) { return uint32_t(std::clamp(1024 / size, 1, 16)); }

struct Options {
  uint32_t passes = 8;
  std::vector<int> sizes;
  std::vector<std::string> scenes, parameters;
};

/// Of a component, a value per seed: the picture's mean, and those of its blocks.
struct Measured {
  RunningStatistics picture;
  RunningStatistics block[blocks * blocks];

  void add(const Image& image, int channel) {
    double sums[blocks * blocks] = {}, sum = 0;
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x)
        sums[y * blocks / image.height() * blocks + x * blocks / image.width()] +=
            double(image.at(x, y, channel));
    const double pixels = double(image.pixel_count());
    for (int i = 0; i < blocks * blocks; ++i) {
      block[i].add(sums[i] * blocks * blocks / pixels);
      sum += sums[i];
    }
    picture.add(sum / pixels);
  }
};
using Components = std::map<std::string, Measured>;

struct Method {
  const char* integrator;
  bool cache;
};
constexpr Method methods[] = {{"path", false}, {"photonmap", true}, {"photonmap", false}};

Components measure(const std::string& text, int size, const Method& method,
                   const Options& options) {
  Description description =
      parse_mitsuba_xml("<scene version=\"3.0.0\">\n" + text + "\n</scene>\n", "scene", "");
  override_integrator(description, method.integrator);
  const bool is_path = std::string(method.integrator) == "path";
  if (!is_path) {
    for (const std::string& parameter : options.parameters)
      override_property(description, "integrator." + parameter);
    if (!method.cache) override_property(description, "integrator.irradiance_cache=false");
  }
  const auto scene = build_scene(description);
  std::vector<std::string> warnings;
  const auto integrator = make_integrator(description, *scene, warnings);
  Components result;
  for (uint64_t seed = 0; seed < seeds; ++seed) {
    SessionSettings settings;
    settings.seed = 1 + seed + seeds * uint64_t(&method - methods);
    settings.passes = options.passes * (is_path ? path_passes : 1);
    settings.samples_per_pass = samples_per_pass(size);
    Session session(*scene, *integrator, settings);
    session.run();
    const Image image = session.film().image();
    for (const std::string_view component : component_names) {
      const int channel = image.find_channel(std::string(component) + ".G");
      if (channel >= 0) result[std::string(component)].add(image, channel);
    }
  }
  return result;
}

/// "+1.2 ± 0.3": how much larger a is than b, in percent.
std::string difference(const RunningStatistics& a, const RunningStatistics& b) {
  const double error = std::hypot(a.standard_error(), b.standard_error());
  return fmt::format("{:+.2f} ± {:.2f}", 100 * (a.mean() / b.mean() - 1), 100 * error / b.mean());
}

/// Of all rows so far: the least p value of each kind of comparison, and how many there are.
struct Verdict {
  double least = 1;
  int count = 0;

  void add(double p) {
    least = std::min(least, p);
    ++count;
  }
  bool agrees() const { return least >= sidak_level(level, std::max(1, count)); }
};

/// The block of photonmap's two pictures that tells most of not being as in path's.
std::string worst_block(const Measured& path, const Measured& cached, const Measured& gathered,
                        Verdict& verdict) {
  std::string worst = "-";
  double least = 1;
  for (int i = 0; i < blocks * blocks; ++i) {
    const RunningStatistics& referee = path.block[i];
    if (!(referee.mean() > least_block_part * path.picture.mean())) continue;
    for (const Measured* found : {&cached, &gathered}) {
      const double p = welch_p_value(found->block[i], referee, block_tolerance);
      verdict.add(p);
      if (p >= least) continue;
      least = p;
      worst = fmt::format("{} {},{}: {}, p {:.1g}", found == &cached ? "cache" : "no cache",
                          i % blocks, i / blocks, difference(found->block[i], referee), p);
    }
  }
  return worst;
}

void compare(const std::string& name, const std::string& text, int size, const Options& options,
             Verdict& pictures, Verdict& in_blocks) {
  std::vector<Components> found;
  for (const Method& method : methods) found.push_back(measure(text, size, method, options));
  double picture = 0;
  for (const auto& [component, measured] : found.front()) picture += measured.picture.mean();
  for (const auto& [component, path] : found.front()) {
    if (!(path.picture.mean() > least_part * picture)) continue;
    // What a method lacks is black.
    const Measured &cached = found[1][component], &gathered = found[2][component];
    double p = 1;
    for (const auto& [a, b] :
         {std::pair{&path, &cached}, std::pair{&path, &gathered}, std::pair{&cached, &gathered}}) {
      const double chance = welch_p_value(a->picture, b->picture, tolerance);
      pictures.add(chance);
      p = std::min(p, chance);
    }
    const std::string block = worst_block(path, cached, gathered, in_blocks);
    fmt::print("{:<15}{:>4}  {:<9}{:>11.6f}{:>17}{:>17}{:>9.2g}  {}\n", name, size, component,
               path.picture.mean(), difference(cached.picture, path.picture),
               difference(gathered.picture, path.picture), p, block);
    std::fflush(stdout);
  }
}

std::optional<Options> parse(int argc, char** argv) {
  Options options;
  bool has_passes = false;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    char* end = nullptr;
    const double number = std::strtod(argv[i], &end);
    if (word.find('=') != std::string::npos)
      options.parameters.push_back(word);
    else if (end == argv[i] || *end != '\0')
      options.scenes.push_back(word);
    else if (!(number >= 1 && number < 1e5))
      return std::nullopt;
    else if (has_passes)
      options.sizes.push_back(int(number));
    else
      options.passes = uint32_t(number), has_passes = true;
  }
  if (options.sizes.empty()) options.sizes = {64, 256, 512};
  const auto known = test::glossy_scenes(blocks);
  for (const std::string& scene : options.scenes)
    if (std::none_of(known.begin(), known.end(), [&](auto& s) { return s.first == scene; }))
      return std::nullopt;
  const bool holds_blocks = *std::min_element(options.sizes.begin(), options.sizes.end()) >= blocks;
  return holds_blocks ? std::optional(options) : std::nullopt;
}

void print_verdict(const char* what, const Verdict& verdict) {
  fmt::print("{} comparisons of {}, least p {:.2g}: {}\n", verdict.count, what, verdict.least,
             verdict.agrees() ? "all agree" : "some disagree");
}

}  // namespace

int main(int argc, char** argv) {
  const std::optional<Options> options = parse(argc, argv);
  if (!options) {
    fmt::print(stderr,
               "glossy_tool [PASSES [SIZE ...]] [SCENE ...] [NAME=VALUE ...]: asks for positive "
               "passes, sizes from {} pixels on, and names of scenes that it has\n",
               blocks);
    return 2;
  }
  Verdict pictures, in_blocks;
  fmt::print("{:<15}{:>4}  {:<9}{:>11}{:>17}{:>17}{:>9}  {}\n", "scene", "size", "component",
             "path", "cache, %", "no cache, %", "least p", "worst block, %");
  std::fflush(stdout);
  try {
    for (const int size : options->sizes)
      for (const auto& [name, text] : test::glossy_scenes(size))
        if (options->scenes.empty() || std::find(options->scenes.begin(), options->scenes.end(),
                                                 name) != options->scenes.end())
          compare(name, text, size, *options, pictures, in_blocks);
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  print_verdict("pictures", pictures);
  print_verdict("blocks", in_blocks);
  return pictures.agrees() && in_blocks.agrees() ? 0 : 1;
}
