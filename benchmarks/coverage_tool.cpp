// How often the 95 % intervals of single pixels hold the truth, of scenes that ship, in small
// pictures with many seeds: after 16, 32, 64 and 128 passes, and where `--error` would have
// stopped.
#include <atomic>
#include <map>
#include <thread>

#include "benchmarks/report.h"
#include "benchmarks/shipped_scenes.h"
#include "kaustik/base/statistics.h"
#include "kaustik/render/film_errors.h"
#include "kaustik/render/session.h"
#include "kaustik/scene/overrides.h"

namespace {

using namespace kaustik;

constexpr int size = 24;
constexpr uint64_t seeds = 64;
constexpr uint32_t least_passes = 16, most_passes = 128, samples_per_pass = 4;
/// Pixels whose truth has more of the variance than that of what is tested are left out.
constexpr double largest_truth_share = 0.05;
constexpr int least_seeds_with_noise = 4;

/// What finds some components without bias, and how many samples per pixel that takes.
struct TruthPart {
  std::string integrator, components;
  uint32_t samples;
};
struct Case {
  std::string scene;
  std::vector<TruthPart> truth;
};
const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"cornell_box", {{"path", "emission,direct,indirect", 32768}}},
      {"cornell_spheres",
       {{"path", "emission,direct", 16384},
        {"lighttracer", "caustic,indirect", 65536},
        {"path", "specular", 65536}}},
      {"metal_ring",
       {{"path", "emission,direct", 16384},
        {"lighttracer", "caustic", 65536},
        {"bdpt", "indirect", 16384},
        {"path", "specular", 131072}}},
  };
  return all;
}

Description small(const std::string& scene) {
  LoadOptions options;
  options.definitions = {{"size", std::to_string(size)}};
  return load_mitsuba_xml(
      std::string(KAUSTIK_SOURCE_DIR) + "/scenes/" + scene + "/" + scene + ".xml", options);
}

/// A scene with one of the integrators.
struct Setup {
  Setup(const std::string& name, const std::string& type, const std::string& components) {
    Description description = small(name);
    override_integrator(description, type);
    if (!components.empty()) override_property(description, "integrator.components=" + components);
    scene = build_scene(description);
    std::vector<std::string> warnings;
    integrator = make_integrator(description, *scene, warnings);
  }
  std::shared_ptr<const Scene> scene;
  std::unique_ptr<Integrator> integrator;
};

constexpr size_t pixel_count = size_t(size) * size;

/// Of a pixel's luminance.
struct Known {
  double mean = 0, variance = 0;
};

std::vector<Known> truth_of(const Case& of) {
  const double t = student_t_quantile(0.975, replicate_count - 1);
  std::vector<Known> result(pixel_count);
  for (const TruthPart& part : of.truth) {
    const Setup setup(of.scene, part.integrator, part.components);
    SessionSettings settings;
    settings.seed = 1000;
    settings.passes = 64;
    settings.samples_per_pass = part.samples / 64;
    Session session(*setup.scene, *setup.integrator, settings);
    session.run();
    const FilmErrors errors(session.film());
    for (size_t i = 0; i < pixel_count; ++i) {
      const ConfidenceInterval found = errors.luminance(i);
      result[i].mean += found.mean;
      result[i].variance += sqr(found.half_width / t);
    }
  }
  return result;
}

/// A seed's picture after some passes.
struct Look {
  double picture_error = 0;
  std::vector<ConfidenceInterval> pixels;
  std::vector<bool> has_noise;
};
using Looks = std::map<uint32_t, Look>;  ///< by passes

Look look_at(const Film& film) {
  const FilmErrors errors(film);
  Look result;
  result.picture_error = errors.of_picture();
  const double n = film.pass_count();
  for (size_t i = 0; i < pixel_count; ++i) {
    result.pixels.push_back(errors.luminance(i));
    const double mean_square = film.luminance_squares(i) / n;
    result.has_noise.push_back(mean_square - sqr(result.pixels[i].mean) > 1e-12 * mean_square);
  }
  return result;
}

std::vector<Looks> render(const std::string& scene, const std::string& integrator) {
  std::vector<Looks> result(seeds);
  std::atomic<uint64_t> next{0};
  const auto work = [&] {
    // Learning belongs to a seed, so each thread has its own.
    const Setup setup(scene, integrator, "");
    for (uint64_t seed = next++; seed < seeds; seed = next++) {
      SessionSettings settings;
      settings.seed = seed + 1;
      settings.threads = 1;
      settings.passes = most_passes;
      settings.samples_per_pass = samples_per_pass;
      Session session(*setup.scene, *setup.integrator, settings);
      session.run({}, {}, [&] {
        const uint32_t passes = session.film().pass_count();
        if (passes >= least_passes && std::has_single_bit(passes))
          result[seed][passes] = look_at(session.film());
      });
    }
  };
  std::vector<std::jthread> threads;
  for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
    threads.emplace_back(work);
  threads.clear();
  return result;
}

/// One look per seed.
void report(const std::string& name, const std::vector<const Look*>& looks,
            const std::vector<Known>& truth, const std::string& about) {
  const double t = student_t_quantile(0.975, replicate_count - 1);
  uint64_t held = 0, all = 0, without_noise = 0;
  size_t unknown_pixels = 0;
  double estimated = 0, squared_errors = 0, truth_variance = 0;
  std::vector<double> by_pixel;
  for (size_t i = 0; i < pixel_count; ++i) {
    int noisy = 0;
    double variance = 0;
    for (const Look* look : looks)
      if (look->has_noise[i]) ++noisy, variance += sqr(look->pixels[i].half_width / t);
    without_noise += looks.size() - size_t(noisy);
    if (noisy < least_seeds_with_noise) continue;
    variance /= noisy;
    if (truth[i].variance > largest_truth_share * variance) {
      ++unknown_pixels;
      continue;
    }
    int held_here = 0;
    for (const Look* look : looks) {
      if (!look->has_noise[i]) continue;
      const ConfidenceInterval& interval = look->pixels[i];
      const double off = std::fabs(interval.mean - truth[i].mean);
      held_here += off <= interval.half_width ? 1 : 0;
      // Relative to the pixel's own variance, so that each counts alike.
      estimated += sqr(interval.half_width / t) / variance;
      squared_errors += off * off / variance;
    }
    truth_variance += truth[i].variance / variance * noisy;
    held += uint64_t(held_here);
    all += uint64_t(noisy);
    by_pixel.push_back(double(held_here) / noisy);
  }
  std::sort(by_pixel.begin(), by_pixel.end());
  if (by_pixel.empty()) return;
  const auto quantile = [&](double share) {
    return 100 * by_pixel[size_t(share * double(by_pixel.size() - 1))];
  };
  bench::report(
      name, 100 * double(held) / double(all), "% of pixels' 95 % intervals hold the truth",
      fmt::format("{}; {} intervals; pixel by pixel 1 %: {:.0f}, 10 %: {:.0f}, median {:.0f}; "
                  "variance that is told (bias with it) over squared error {:.3f}; truth's own "
                  "{:.3f}; left "
                  "out: {} without noise, {} of {} pixels whose truth is not known well enough",
                  about, all, quantile(0.01), quantile(0.1), quantile(0.5),
                  estimated / squared_errors, truth_variance / squared_errors, without_noise,
                  unknown_pixels, pixel_count));
}

void measure(const std::string& scene, const std::string& integrator,
             const std::vector<Known>& truth) {
  const std::vector<Looks> found = render(scene, integrator);
  const std::string name = fmt::format("coverage_{}_{}", scene, integrator);
  std::vector<double> errors;
  for (uint32_t passes = least_passes; passes <= most_passes; passes *= 2) {
    std::vector<const Look*> looks;
    double error = 0;
    for (const Looks& of_seed : found) {
      looks.push_back(&of_seed.at(passes));
      error += looks.back()->picture_error / double(seeds);
      if (passes == 2 * least_passes) errors.push_back(looks.back()->picture_error);
    }
    report(fmt::format("{}_{}", name, passes), looks, truth,
           fmt::format("{} passes, picture's error {:.3f}", passes, error));
  }
  // At the error that half of the seeds have after 32 passes, as Session looks at it.
  const double wanted = bench::median(errors);
  std::vector<const Look*> stopped;
  std::map<uint32_t, int> at;
  for (const Looks& of_seed : found)
    for (const auto& [passes, look] : of_seed)
      if (look.picture_error <= wanted || passes == most_passes) {
        stopped.push_back(&look);
        ++at[passes];
        break;
      }
  std::string when;
  for (const auto& [passes, count] : at) when += fmt::format(" {}: {}", passes, count);
  report(name + "_error", stopped, truth,
         fmt::format("stopped at an error of {:.3f}, seeds by passes:{}", wanted, when));
}

}  // namespace

/// Scenes and integrators by name, all of a kind without.
int main(int argc, char** argv) {
  const std::vector<std::string> wanted(argv + 1, argv + argc);
  const std::vector<std::string> integrators = {"path", "auto", "vcm"};
  const auto is_scene = [](const std::string& name) {
    return std::any_of(cases().begin(), cases().end(),
                       [&](const Case& one) { return one.scene == name; });
  };
  const auto is_integrator = [&](const std::string& name) {
    return std::find(integrators.begin(), integrators.end(), name) != integrators.end();
  };
  for (const std::string& name : wanted)
    if (!is_scene(name) && !is_integrator(name)) {
      fmt::print(stderr,
                 "coverage_tool: '{}' is no scene whose truth is known, nor one of the "
                 "integrators\n  remedy: name some of",
                 name);
      for (const Case& one : cases()) fmt::print(stderr, " {}", one.scene);
      fmt::print(stderr, " {}\n", fmt::join(integrators, " "));
      return 2;
    }
  const auto is_wanted = [&](const std::string& name, const auto& same_kind) {
    return std::find(wanted.begin(), wanted.end(), name) != wanted.end() ||
           std::none_of(wanted.begin(), wanted.end(), same_kind);
  };
  try {
    for (const Case& one : cases()) {
      if (!is_wanted(one.scene, is_scene)) continue;
      const std::vector<Known> truth = truth_of(one);
      for (const std::string& integrator : integrators)
        if (is_wanted(integrator, is_integrator)) measure(one.scene, integrator, truth);
    }
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
