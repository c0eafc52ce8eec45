// Whether all integrators find the same picture on the scenes that ship: means of each component,
// from seeds of their own, every pair compared, and pairs told that are too noisy for that. `auto`
// stands beside them.
#include <atomic>
#include <bit>
#include <cmath>
#include <map>
#include <optional>
#include <thread>

#include "benchmarks/report.h"
#include "benchmarks/shipped_scenes.h"
#include "kaustik/base/processors.h"
#include "kaustik/base/statistics.h"
#include "kaustik/integrator/override_integrator.h"
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
/// must find the same. `auto` has the radii that it learns, a pixel and more: nothing is asked of
/// its means, but they are told after some passes and after four times as many, and the gap must be
/// seen to shrink.
constexpr float narrow_radius_share = 2e-4f;
/// Pairs agree by nothing but noise where the standard error of their difference is more than this
/// part of the component's mean: too noisy to tell.
constexpr double largest_noise = 0.003;
/// Components that are less than this part of the picture are left out.
constexpr double least_part = 0.002;

const std::vector<std::string> all_scenes = {
    "cornell_box", "cornell_spheres", "metal_ring", "point_spotlight",
    "gallery_1",   "gallery_2",       "museum",     "maze",
    "atrium",      "pool_above",      "pool_below"};
const std::vector<std::string> all_integrators = {"path", "lighttracer", "bdpt",
                                                  "vcm",  "ppm",         "auto"};

bool merges(const std::string& integrator) { return integrator == "vcm" || integrator == "ppm"; }
bool is_asked(const std::string& integrator) { return integrator != "auto"; }
bool has_no_bias(const std::string& integrator) {
  return is_asked(integrator) && !merges(integrator);
}

using ComponentMeans = std::map<std::string, double>;
using Means = std::map<std::string, RunningStatistics>;  ///< by component; a value per seed

/// Mean of the layer's green channel, which all scenes have light in.
double mean_of(const Image& image, int channel) {
  double sum = 0;
  for (const float value : image.channel(channel)) sum += double(value);
  return sum / double(image.pixel_count());
}

ComponentMeans component_means(const Image& image) {
  ComponentMeans means;
  for (const std::string_view component : component_names) {
    const std::string name(component);
    const int channel = image.find_channel(name + ".G");
    if (channel >= 0) means[name] = mean_of(image, channel);
  }
  return means;
}

/// A scene with one of the integrators.
struct Setup {
  Setup(const std::string& name, const std::string& type) {
    Description description = bench::load_shipped(name);
    override_integrator(description, type);
    override_property(description, fmt::format("film.width={}", width));
    override_property(description, fmt::format("film.height={}", height));
    scene = build_scene(description);
    // What is seen by specular events is out of its reach.
    if (type == "lighttracer")
      override_property(description, "integrator.components=caustic,indirect");
    if (merges(type)) {
      const float radius = narrow_radius_share * bounding_radius(scene->tracer().bounds());
      override_property(description, fmt::format("integrator.radius={}", radius));
    }
    std::vector<std::string> warnings;
    integrator = make_integrator(description, *scene, warnings);
  }
  std::shared_ptr<const Scene> scene;
  std::unique_ptr<Integrator> integrator;
};

/// What one integrator finds.
struct Found {
  Means means;
  std::map<uint32_t, Means> after;  ///< of `auto`, by passes that all seeds have had: 1, 2, 4, …
};

/// One seed's picture.
struct SeedResult {
  ComponentMeans means;
  std::map<uint32_t, ComponentMeans> after;
};

SeedResult render(const Setup& setup, const std::string& integrator, uint64_t seed,
                  double seconds) {
  SessionSettings settings;
  // No two integrators share numbers.
  settings.seed = 1 + seed + seeds * std::hash<std::string>()(integrator) % (1u << 20);
  settings.threads = 1;
  settings.seconds = seconds;
  Session session(*setup.scene, *setup.integrator, settings);
  SeedResult result;
  const auto look = [&] {
    const uint32_t passes = session.film().pass_count();
    if (!is_asked(integrator) && std::has_single_bit(passes))
      result.after[passes] = component_means(session.film().image());
  };
  session.run({}, {}, look);
  result.means = component_means(session.film().image());
  return result;
}

Found measure(const std::string& scene, const std::string& integrator, double seconds) {
  // Learning belongs to a seed, so each thread has its own.
  std::vector<Setup> setups;
  for (int i = 0; i < usable_processors(); ++i) setups.emplace_back(scene, integrator);
  std::vector<SeedResult> of_seeds(seeds);
  std::atomic<uint64_t> next{0};
  const auto work = [&](const Setup& setup) {
    for (uint64_t seed = next++; seed < seeds; seed = next++)
      of_seeds[seed] = render(setup, integrator, seed, seconds);
  };
  std::vector<std::jthread> threads;
  for (const Setup& setup : setups) threads.emplace_back(work, std::cref(setup));
  threads.clear();
  Found found;
  for (const SeedResult& of_seed : of_seeds) {
    for (const auto& [name, mean] : of_seed.means) found.means[name].add(mean);
    for (const auto& [passes, means] : of_seed.after)
      for (const auto& [name, mean] : means) found.after[passes][name].add(mean);
  }
  std::erase_if(found.after, [](const auto& of) {
    return of.second.empty() || of.second.begin()->second.count() < int64_t(seeds);
  });
  return found;
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

double noise_of_difference(const RunningStatistics& a, const RunningStatistics& b) {
  return std::hypot(a.standard_error(), b.standard_error());
}

using NamedMean = std::pair<std::string, RunningStatistics>;

/// The mean of those without bias, each by its precision; absent: none is known.
struct Referee {
  double mean = 0, standard_error = 0;
};
std::optional<Referee> referee_of(const std::vector<NamedMean>& means) {
  double sum = 0, precision = 0;
  for (const auto& [name, mean] : means) {
    if (!has_no_bias(name) || !(mean.standard_error() > 0)) continue;
    sum += mean.mean() / sqr(mean.standard_error());
    precision += 1 / sqr(mean.standard_error());
  }
  if (!(precision > 0)) return std::nullopt;
  return Referee{sum / precision, 1 / std::sqrt(precision)};
}

/// How far `auto` is from those without bias, after some passes and after four times as many.
std::string described_gap(const std::string& component, const Found& of_auto,
                          const std::vector<NamedMean>& means) {
  const auto referee = referee_of(means);
  if (of_auto.after.empty() || !referee || !(referee->mean > 0)) return "of auto nothing is known";
  std::string text = "auto is away from those without bias by";
  const uint32_t last = of_auto.after.rbegin()->first;
  for (const uint32_t passes : {last / 4, last}) {
    const auto at = of_auto.after.find(passes);
    if (at == of_auto.after.end()) continue;  // too few passes in the time
    const RunningStatistics& mean = at->second.at(component);
    text += fmt::format(
        " {:+.2f} ± {:.2f} % after {} passes,", 100 * (mean.mean() / referee->mean - 1),
        100 * std::hypot(mean.standard_error(), referee->standard_error) / referee->mean, passes);
  }
  text.pop_back();
  return text;
}

/// What was found out about pairs.
struct Verdict {
  double least_p = 1;  ///< of all pairs
  int pairs = 0;
  int too_noisy = 0;          ///< by the component's mean
  int too_noisy_picture = 0;  ///< the same by the picture's mean
};

/// Of one component of a scene; `picture`: mean of all components together.
Verdict report(const std::string& scene, const std::string& component, double picture,
               const std::map<std::string, Found>& found) {
  std::vector<NamedMean> means;
  for (const auto& [integrator, of] : found)
    if (const auto at = of.means.find(component); at != of.means.end())
      means.emplace_back(integrator, at->second);
  double middle = 0;
  for (const auto& [name, mean] : means) middle += mean.mean() / double(means.size());
  std::string note, worst = "none", noisy;
  for (const auto& [name, mean] : means)
    note += fmt::format("{} {:.4f} ± {:.4f}, ", name, mean.mean() / middle,
                        mean.standard_error() / middle);
  Verdict verdict;
  for (size_t i = 0; i < means.size(); ++i)
    for (size_t j = 0; j < i; ++j) {
      if (!is_asked(means[i].first) || !is_asked(means[j].first)) continue;
      const bool has_bias = merges(means[i].first) || merges(means[j].first);
      const double p =
          p_value(means[i].second, means[j].second, has_bias ? merging_tolerance : 0.0);
      const std::string pair = means[j].first + " and " + means[i].first;
      if (p < verdict.least_p) verdict.least_p = p, worst = pair;
      ++verdict.pairs;
      const double noise = noise_of_difference(means[i].second, means[j].second);
      if (noise > largest_noise * picture) ++verdict.too_noisy_picture;
      if (!(noise > largest_noise * middle)) continue;
      ++verdict.too_noisy;
      noisy +=
          fmt::format("{}{} ({:.1f} %)", noisy.empty() ? "" : ", ", pair, 100 * noise / middle);
    }
  bench::report(
      fmt::format("agreement_{}_{}", scene, component), verdict.least_p,
      "smallest p value of all pairs",
      fmt::format("{}the pair {}; of the mean, ± standard error; {:.1f} % of the picture; too "
                  "noisy to tell: {}; {}",
                  note, worst, 100 * middle / picture, noisy.empty() ? "none" : noisy,
                  described_gap(component, found.at("auto"), means)));
  return verdict;
}

/// Returns the program's exit status.
int summarize(const std::vector<Verdict>& verdicts) {
  int pairs = 0, too_noisy = 0, too_noisy_picture = 0;
  for (const Verdict& verdict : verdicts) {
    pairs += verdict.pairs;
    too_noisy += verdict.too_noisy;
    too_noisy_picture += verdict.too_noisy_picture;
  }
  const double least = sidak_level(level, std::max(1, pairs));
  const auto apart = std::count_if(verdicts.begin(), verdicts.end(),
                                   [&](const Verdict& of) { return of.least_p < least; });
  fmt::print(stderr,
             "{} of {} components disagree; of {} pairs {} are too noisy to tell differences of "
             "{:.1f} % of the component, {} such of {:.1f} % of the picture\n",
             apart, verdicts.size(), pairs, too_noisy, 100 * largest_noise, too_noisy_picture,
             100 * largest_noise);
  return apart > 0 ? 1 : 0;
}

}  // namespace

/// Scenes by name, all without; a number: seconds for each seed and integrator.
int main(int argc, char** argv) {
  double seconds = 3.3;
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
  std::vector<Verdict> verdicts;
  try {
    for (const std::string& scene : scenes) {
      std::map<std::string, Found> found;
      for (const std::string& integrator : all_integrators)
        found[integrator] = measure(scene, integrator, seconds);
      const Means& of_vcm = found["vcm"].means;
      double picture = 0;
      for (const auto& [name, mean] : of_vcm) picture += mean.mean();
      for (const auto& [name, mean] : of_vcm)
        if (mean.mean() > least_part * picture)
          verdicts.push_back(report(scene, name, picture, found));
    }
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return summarize(verdicts);
}
