// Whether all integrators find the same picture on the scenes that ship: means of each component,
// from seeds of their own, every pair compared. `auto` stands beside them.
#include <atomic>
#include <cmath>
#include <map>
#include <thread>

#include "benchmarks/report.h"
#include "benchmarks/shipped_scenes.h"
#include "kaustik/base/statistics.h"
#include "kaustik/render/session.h"
#include "kaustik/scene/overrides.h"
#include "kaustik/transport/component.h"

namespace {

using namespace kaustik;

constexpr int width = 96, height = 96;
constexpr uint64_t seeds = 8;
/// A pair is told to disagree by a chance of all pairs together of so much, …
constexpr double level = 0.01;
/// … if one of them merges by more than this: merging has a bias …
constexpr double merging_tolerance = 0.01;
/// … that falls with the radius. In pictures as small as these a pixel is as wide as a picture's
/// frame, so `vcm` and `ppm` merge in disks of this part of the scene's bounding sphere, where all
/// must find the same. `auto` has the radii that it learns, a pixel and more: its means are told,
/// and the bias can be seen, but nothing is asked of them.
constexpr float narrow_radius_share = 2e-4f;
/// Components that are less than this part of the picture are left out.
constexpr double least_part = 0.002;

const std::vector<std::string> all_scenes = {
    "cornell_box", "cornell_spheres", "metal_ring", "point_spotlight",
    "gallery_1",   "gallery_2",       "museum",     "maze",
    "atrium",      "pool_above",      "pool_below"};
const std::vector<std::string> all_integrators = {"path", "bdpt", "vcm", "ppm", "auto"};

bool merges(const std::string& integrator) { return integrator != "path" && integrator != "bdpt"; }
bool is_asked(const std::string& integrator) { return integrator != "auto"; }

using Means = std::map<std::string, RunningStatistics>;  ///< by component; a value per seed

/// Mean of the layer's green channel, which all scenes have light in.
double mean_of(const Image& image, int channel) {
  double sum = 0;
  for (const float value : image.channel(channel)) sum += double(value);
  return sum / double(image.pixel_count());
}

/// A scene with one of the integrators.
struct Setup {
  Setup(const std::string& name, const std::string& type) {
    Description description = bench::load_shipped(name);
    override_integrator(description, type);
    override_property(description, fmt::format("film.width={}", width));
    override_property(description, fmt::format("film.height={}", height));
    scene = build_scene(description);
    if (type == "vcm" || type == "ppm") {
      const float radius = narrow_radius_share * bounding_radius(scene->tracer().bounds());
      override_property(description, fmt::format("integrator.radius={}", radius));
    }
    std::vector<std::string> warnings;
    integrator = make_integrator(description, *scene, warnings);
  }
  std::shared_ptr<const Scene> scene;
  std::unique_ptr<Integrator> integrator;
};

Means measure(const std::string& scene, const std::string& integrator, double seconds) {
  // Learning belongs to a seed, so each thread has its own.
  std::vector<Setup> setups;
  for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
    setups.emplace_back(scene, integrator);
  std::vector<std::map<std::string, double>> found(seeds);
  std::atomic<uint64_t> next{0};
  const auto work = [&](const Setup& setup) {
    for (uint64_t seed = next++; seed < seeds; seed = next++) {
      SessionSettings settings;
      // No two integrators share numbers.
      settings.seed = 1 + seed + seeds * std::hash<std::string>()(integrator) % (1u << 20);
      settings.threads = 1;
      settings.seconds = seconds;
      Session session(*setup.scene, *setup.integrator, settings);
      session.run();
      const Image image = session.film().image();
      for (const std::string_view component : component_names) {
        const std::string name(component);
        const int channel = image.find_channel(name + ".G");
        if (channel >= 0) found[seed][name] = mean_of(image, channel);
      }
    }
  };
  std::vector<std::jthread> threads;
  for (const Setup& setup : setups) threads.emplace_back(work, std::cref(setup));
  threads.clear();
  Means result;
  for (const auto& of_seed : found)
    for (const auto& [name, mean] : of_seed) result[name].add(mean);
  return result;
}

/// Chance of a difference as large or larger, where the means differ by `tolerance` at most (Welch
/// 1947).
double p_value(const RunningStatistics& a, const RunningStatistics& b, double tolerance) {
  const double va = sqr(a.standard_error()), vb = sqr(b.standard_error());
  const double excess = std::fabs(a.mean() - b.mean()) - tolerance * std::max(a.mean(), b.mean());
  if (!(excess > 0)) return 1;
  if (!(va + vb > 0)) return 0;
  const double freedom = sqr(va + vb) / ((sqr(va) + sqr(vb)) / double(seeds - 1));
  const double sides = tolerance > 0 ? 1 : 2;
  return sides * student_t_cdf(-excess / std::sqrt(va + vb), freedom);
}

/// Of one component of a scene; the smallest p value of all pairs.
double report(const std::string& scene, const std::string& component,
              const std::map<std::string, Means>& found) {
  std::vector<std::pair<std::string, RunningStatistics>> means;
  for (const auto& [integrator, of] : found)
    if (const auto at = of.find(component); at != of.end())
      means.emplace_back(integrator, at->second);
  double least = 1, middle = 0;
  for (const auto& [name, mean] : means) middle += mean.mean() / double(means.size());
  std::string note, worst = "none";
  for (const auto& [name, mean] : means)
    note += fmt::format("{} {:.4f} ± {:.4f}, ", name, mean.mean() / middle,
                        mean.standard_error() / middle);
  for (size_t i = 0; i < means.size(); ++i)
    for (size_t j = 0; j < i; ++j) {
      if (!is_asked(means[i].first) || !is_asked(means[j].first)) continue;
      const bool has_bias = merges(means[i].first) || merges(means[j].first);
      const double p =
          p_value(means[i].second, means[j].second, has_bias ? merging_tolerance : 0.0);
      if (p < least) least = p, worst = means[j].first + " and " + means[i].first;
    }
  bench::report(fmt::format("agreement_{}_{}", scene, component), least,
                "smallest p value of all pairs",
                fmt::format("{}the pair {}; of the mean, ± standard error", note, worst));
  return least;
}

}  // namespace

/// Scenes by name, all without; a number: seconds for each seed and integrator.
int main(int argc, char** argv) {
  double seconds = 4;
  std::vector<std::string> scenes;
  for (const std::string& argument : std::vector<std::string>(argv + 1, argv + argc))
    if (std::find(all_scenes.begin(), all_scenes.end(), argument) != all_scenes.end())
      scenes.push_back(argument);
    else
      seconds = std::atof(argument.c_str());
  if (!(seconds > 0)) {
    fmt::print(
        stderr,
        "agreement_tool: asks for scenes or a number of seconds\n  remedy: name some of {}\n",
        fmt::join(all_scenes, " "));
    return 2;
  }
  if (scenes.empty()) scenes = all_scenes;
  std::vector<double> p_values;
  try {
    for (const std::string& scene : scenes) {
      std::map<std::string, Means> found;
      for (const std::string& integrator : all_integrators)
        found[integrator] = measure(scene, integrator, seconds);
      double total = 0;
      for (const auto& [name, mean] : found["vcm"]) total += mean.mean();
      for (const auto& [name, mean] : found["vcm"])
        if (mean.mean() > least_part * total) p_values.push_back(report(scene, name, found));
    }
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  const auto asked = int(std::count_if(all_integrators.begin(), all_integrators.end(), is_asked));
  const int pairs = asked * (asked - 1) / 2;
  const double least = sidak_level(level, int(p_values.size()) * pairs);
  const auto apart =
      std::count_if(p_values.begin(), p_values.end(), [&](double p) { return p < least; });
  fmt::print(stderr, "{} of {} components disagree\n", apart, p_values.size());
  return apart > 0 ? 1 : 0;
}
