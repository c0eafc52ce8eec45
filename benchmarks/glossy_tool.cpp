// Whether `photonmap` finds the same light with its irradiance cache and without, and `path` too,
// where something glossy is in view: means of each component of six scenes in pictures of several
// sizes, from seeds of their own. `glossy_tool [SECONDS [SIZE ...]]`: for each seed and method.
#include <cmath>
#include <map>

#include "benchmarks/report.h"
#include "kaustik/base/statistics.h"
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
/// Photon maps have a bias, which shrinks with the passes: less than this part is none.
constexpr double tolerance = 0.003;
/// Components that are less than this part of the picture are left out.
constexpr double least_part = 0.002;

using Means = std::map<std::string, RunningStatistics>;  ///< by component; a value per seed

struct Method {
  const char* name;
  const char* integrator;
  bool cache;
};
constexpr Method methods[] = {
    {"cache", "photonmap", true}, {"no cache", "photonmap", false}, {"path", "path", false}};

Means measure(const std::string& text, const Method& method, double seconds) {
  Description description =
      parse_mitsuba_xml("<scene version=\"3.0.0\">\n" + text + "\n</scene>\n", "scene", "");
  override_integrator(description, method.integrator);
  const bool is_path = std::string(method.integrator) == "path";
  if (!is_path && !method.cache)
    override_property(description, "integrator.irradiance_cache=false");
  const auto scene = build_scene(description);
  std::vector<std::string> warnings;
  const auto integrator = make_integrator(description, *scene, warnings);
  Means means;
  for (uint64_t seed = 0; seed < seeds; ++seed) {
    SessionSettings settings;
    settings.seed = 1 + seed + seeds * uint64_t(&method - methods);
    settings.seconds = seconds;
    Session session(*scene, *integrator, settings);
    session.run();
    const Image image = session.film().image();
    for (const std::string_view component : component_names) {
      const int channel = image.find_channel(std::string(component) + ".G");
      if (channel < 0) continue;
      double sum = 0;
      for (const float value : image.channel(channel)) sum += double(value);
      means[std::string(component)].add(sum / double(image.pixel_count()));
    }
  }
  return means;
}

/// Chance of a difference as large or larger, where the means differ by the tolerance (Welch 1947).
double p_value(const RunningStatistics& a, const RunningStatistics& b) {
  const double va = sqr(a.standard_error()), vb = sqr(b.standard_error());
  const double excess = std::fabs(a.mean() - b.mean()) - tolerance * std::max(a.mean(), b.mean());
  if (!(excess > 0)) return 1;
  if (!(va + vb > 0)) return 0;
  const double freedom = sqr(va + vb) / ((sqr(va) + sqr(vb)) / double(seeds - 1));
  return student_t_cdf(-excess / std::sqrt(va + vb), freedom);
}

}  // namespace

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 2;
  std::vector<int> sizes;
  for (int i = 2; i < argc; ++i) sizes.push_back(std::atoi(argv[i]));
  if (sizes.empty()) sizes = {64, 256, 512};
  if (!(seconds > 0) || *std::min_element(sizes.begin(), sizes.end()) <= 0) {
    fmt::print(stderr, "glossy_tool [SECONDS [SIZE ...]]: asks for positive numbers\n");
    return 2;
  }
  double least = 1;
  int comparisons = 0;
  fmt::print("{:<16}{:>5} {:<10}{:>20}{:>20}{:>20}{:>10}\n", "scene", "size", "component", "cache",
             "no cache", "path", "least p");
  try {
    for (const int size : sizes)
      for (const auto& [name, text] : test::glossy_scenes(size)) {
        std::vector<Means> found;
        for (const Method& method : methods) found.push_back(measure(text, method, seconds));
        double picture = 0;
        for (const auto& [component, mean] : found.back()) picture += mean.mean();
        for (const auto& [component, of_path] : found.back()) {
          if (!(of_path.mean() > least_part * picture)) continue;
          double p = 1;
          std::string row = fmt::format("{:<16}{:>5} {:<10}", name, size, component);
          for (size_t i = 0; i < found.size(); ++i) {
            const RunningStatistics& mean = found[i].at(component);
            row += fmt::format("{:>20}",
                               fmt::format("{:.5f} ± {:.5f}", mean.mean(), mean.standard_error()));
            for (size_t j = 0; j < i; ++j, ++comparisons)
              p = std::min(p, p_value(mean, found[j].at(component)));
          }
          fmt::print("{}{:>10.2g}\n", row, p);
          std::fflush(stdout);
          least = std::min(least, p);
        }
      }
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  const bool agree = least >= sidak_level(level, std::max(1, comparisons));
  fmt::print("{} comparisons, least p {:.2g}: {}\n", comparisons, least,
             agree ? "all agree" : "some disagree");
  return agree ? 0 : 1;
}
