// How often the 95 % intervals of single pixels hold the truth, in small pictures with some seeds:
// after 16, 32, 64 and 128 passes, and where `--error` has stopped.
#include <atomic>
#include <map>
#include <thread>

#include "benchmarks/coverage_scenes.h"
#include "benchmarks/report.h"
#include "kaustik/base/processors.h"
#include "kaustik/base/statistics.h"
#include "kaustik/render/film_errors.h"
#include "kaustik/render/session.h"

namespace {

using namespace kaustik;
using bench::CoverageScene, bench::CoverageSetup, bench::KnownPixel;

constexpr uint32_t least_passes = 16, most_passes = 128, samples_per_pass = 4;
/// Pixels whose truth has more of the variance than that of what is tested are left out.
constexpr double largest_truth_share = 0.05;
/// So are those of which fewer pictures have noise, which would tell no variance.
constexpr int least_seeds_with_noise = 4;
/// What an error is to be asked for is seen in pictures of other seeds, after so many passes.
constexpr uint64_t first_trial_seed = 1001, trial_seeds = 8;
constexpr uint32_t trial_passes = 32;

const std::vector<std::string> analytic_integrators = {"path", "bdpt", "ppm", "vcm", "auto"};
const std::vector<std::string> shipped_integrators = {"path", "vcm", "auto"};

/// Pictures of scenes that ship have more pixels.
uint64_t seeds_of(const CoverageScene& scene) { return scene.is_analytic() ? 64 : 10; }

/// Shares in percent that are asked for.
struct Bar {
  double least, most;
  bool is_kept(double share) const { return share >= least && share <= most; }
  std::string text() const {
    return most < 100 ? fmt::format("{} to {} %", least, most)
                      : fmt::format("{} % at least", least);
  }
};
Bar bar_of(const CoverageScene& scene) { return scene.is_analytic() ? Bar{93, 97} : Bar{90, 100}; }
/// Whether a miss makes the program fail; others are told.
bool is_asked(const CoverageScene& scene, const std::string& integrator) {
  return scene.is_analytic() || integrator == "auto";
}

/// A seed's picture after some passes.
struct Look {
  double picture_error = 0, freedom = 1;  ///< of all pixels' noise
  std::vector<ConfidenceInterval> pixels;
  std::vector<bool> has_noise;
};
struct Looks {
  std::map<uint32_t, Look> by_passes;
  uint32_t stopped_at = 0;  ///< passes, by the error
};

Look look_at(const Film& film) {
  const FilmErrors errors(film);
  Look result;
  result.picture_error = errors.of_picture();
  result.freedom = errors.freedom();
  const double n = film.pass_count();
  for (size_t i = 0; i < film.pixel_count(); ++i) {
    result.pixels.push_back(errors.luminance(i));
    const double mean_square = film.luminance_squares(i) / n;
    result.has_noise.push_back(mean_square - sqr(result.pixels[i].mean) > 1e-12 * mean_square);
  }
  return result;
}

SessionSettings settings_of(uint64_t seed, uint32_t passes) {
  SessionSettings settings;
  settings.seed = seed;
  settings.threads = 1;
  settings.passes = passes;
  settings.samples_per_pass = samples_per_pass;
  return settings;
}

/// `work(setup, i)` for all i below `count`. Learning belongs to a seed, so each thread has its
/// own setup.
template <typename Work>
void for_each_seed(const CoverageScene& scene, const std::string& integrator, uint64_t count,
                   const Work& work) {
  std::atomic<uint64_t> next{0};
  std::vector<std::jthread> threads;
  for (int i = 0; i < usable_processors(); ++i)
    threads.emplace_back([&] {
      const CoverageSetup setup(scene, integrator);
      for (uint64_t k = next++; k < count; k = next++) work(setup, k);
    });
}

/// The error that half of some pictures have, so that it stops others at different passes.
double error_to_ask_for(const CoverageScene& scene, const std::string& integrator) {
  std::vector<double> errors(trial_seeds);
  for_each_seed(scene, integrator, trial_seeds, [&](const CoverageSetup& setup, uint64_t i) {
    Session session(*setup.scene, *setup.integrator,
                    settings_of(first_trial_seed + i, trial_passes));
    session.run();
    errors[i] = FilmErrors(session.film()).of_picture();
  });
  return bench::median(errors);
}

/// Renders until the error is small enough, and then what is left, which is the same picture as
/// without a stop.
Looks render(const CoverageSetup& setup, uint64_t seed, double error) {
  Looks result;
  SessionSettings settings = settings_of(seed, most_passes);
  const auto run = [&](Session& session) {
    session.run({}, {}, [&] {
      const uint32_t passes = session.film().pass_count();
      if (passes >= least_passes && std::has_single_bit(passes))
        result.by_passes[passes] = look_at(session.film());
    });
  };
  settings.error = error;
  Session until_stopped(*setup.scene, *setup.integrator, settings);
  run(until_stopped);
  result.stopped_at = until_stopped.film().pass_count();
  settings.error.reset();
  Session rest(*setup.scene, *setup.integrator, settings, until_stopped.film());
  run(rest);
  return result;
}

/// Of the intervals of all pixels and seeds.
struct Coverage {
  uint64_t held = 0, all = 0;
  RunningStatistics by_seed;  ///< shares
  uint64_t without_noise = 0;
  size_t unknown_pixels = 0, quiet_pixels = 0;
  /// Relative to each pixel's own variance, so that all count alike.
  double told = 0, squared_errors = 0, bias_sq = 0, truth_variance = 0;
  std::vector<double> by_pixel;  ///< shares, sorted
  double share() const { return 100 * double(held) / double(all); }
  double quantile(double share) const {
    return 100 * by_pixel[size_t(share * double(by_pixel.size() - 1))];
  }
};

/// One look per seed.
Coverage coverage_of(const std::vector<const Look*>& looks, const std::vector<KnownPixel>& truth) {
  const double t = student_t_quantile(0.975, looks.front()->freedom);
  Coverage result;
  std::vector<uint64_t> held_by_seed(looks.size()), all_by_seed(looks.size());
  for (size_t i = 0; i < truth.size(); ++i) {
    int noisy = 0;
    double variance = 0;
    for (const Look* look : looks)
      if (look->has_noise[i]) ++noisy, variance += sqr(look->pixels[i].half_width / t);
    result.without_noise += looks.size() - size_t(noisy);
    variance /= std::max(1, noisy);
    const bool is_quiet = noisy < least_seeds_with_noise;
    if (is_quiet || truth[i].variance > largest_truth_share * variance) {
      ++(is_quiet ? result.quiet_pixels : result.unknown_pixels);
      continue;
    }
    int held_here = 0;
    double errors = 0, squared_errors = 0;
    for (size_t seed = 0; seed < looks.size(); ++seed) {
      if (!looks[seed]->has_noise[i]) continue;
      const ConfidenceInterval& interval = looks[seed]->pixels[i];
      const double off = interval.mean - truth[i].mean;
      const int held = std::fabs(off) <= interval.half_width ? 1 : 0;
      held_here += held;
      held_by_seed[seed] += uint64_t(held);
      ++all_by_seed[seed];
      result.told += sqr(interval.half_width / t) / variance;
      errors += off, squared_errors += off * off;
    }
    result.squared_errors += squared_errors / variance;
    // What errors of two seeds have in common.
    result.bias_sq += (errors * errors - squared_errors) / (noisy - 1) / variance;
    result.truth_variance += truth[i].variance / variance * noisy;
    result.held += uint64_t(held_here);
    result.all += uint64_t(noisy);
    result.by_pixel.push_back(double(held_here) / noisy);
  }
  for (size_t seed = 0; seed < looks.size(); ++seed)
    if (all_by_seed[seed] > 0)
      result.by_seed.add(100 * double(held_by_seed[seed]) / double(all_by_seed[seed]));
  std::sort(result.by_pixel.begin(), result.by_pixel.end());
  return result;
}

/// Whether the bar is kept, or there is nothing to be held by it.
bool report(const std::string& name, const Coverage& of, const Bar& bar, const std::string& about) {
  if (of.all == 0) {
    fmt::print(stderr, "{}: no pixel that has noise and is known well enough\n", name);
    return true;
  }
  const bool is_kept = bar.is_kept(of.share());
  bench::report(
      name, of.share(), "% of pixels' 95 % intervals hold the truth",
      fmt::format(
          "{}: {}; {}; {} intervals, standard error over seeds {:.2f}; pixel by pixel 1 %: {:.0f}, "
          "10 %: {:.0f}, median {:.0f}; variance that is told (bias with it) over squared error "
          "{:.3f}; of this, errors that all seeds share {:.3f}, truth's own {:.3f}; left out: {} "
          "without noise, {} pixels with too little, {} "
          "whose truth is not known well enough",
          bar.text(), is_kept ? "kept" : "missed", about, of.all, of.by_seed.standard_error(),
          of.quantile(0.01), of.quantile(0.1), of.quantile(0.5), of.told / of.squared_errors,
          of.bias_sq / of.squared_errors, of.truth_variance / of.squared_errors, of.without_noise,
          of.quiet_pixels, of.unknown_pixels));
  return is_kept;
}

/// Whether all bars are kept.
bool measure(const CoverageScene& scene, const std::string& integrator,
             const std::vector<KnownPixel>& truth) {
  const double error = error_to_ask_for(scene, integrator);
  const uint64_t seeds = seeds_of(scene);
  std::vector<Looks> found(seeds);
  for_each_seed(scene, integrator, seeds, [&](const CoverageSetup& setup, uint64_t i) {
    found[i] = render(setup, i + 1, error);
  });
  const std::string name = fmt::format("coverage_{}_{}", scene.name, integrator);
  const Bar bar = bar_of(scene);
  bool is_kept = true;
  for (uint32_t passes = least_passes; passes <= most_passes; passes *= 2) {
    std::vector<const Look*> looks;
    double mean_error = 0;
    for (const Looks& of_seed : found) {
      looks.push_back(&of_seed.by_passes.at(passes));
      mean_error += looks.back()->picture_error / double(seeds);
    }
    is_kept &= report(fmt::format("{}_{}", name, passes), coverage_of(looks, truth), bar,
                      fmt::format("{} passes, picture's error {:.3f}", passes, mean_error));
  }
  std::vector<const Look*> stopped;
  std::map<uint32_t, int> counts;
  for (const Looks& of_seed : found) {
    stopped.push_back(&of_seed.by_passes.at(of_seed.stopped_at));
    ++counts[of_seed.stopped_at];
  }
  std::string when;
  for (const auto& [passes, count] : counts) when += fmt::format(" {}: {}", passes, count);
  is_kept &= report(name + "_error", coverage_of(stopped, truth), bar,
                    fmt::format("stopped by an error of {:.4f}, seeds by passes:{}", error, when));
  return is_kept;
}

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}
bool is_scene(const std::string& name) {
  return std::any_of(bench::coverage_scenes().begin(), bench::coverage_scenes().end(),
                     [&](const CoverageScene& one) { return one.name == name; });
}
bool is_integrator(const std::string& name) { return holds(analytic_integrators, name); }

/// Whether a name of this kind is asked for: if it is given, or none of its kind.
template <typename Kind>
bool is_wanted(const std::vector<std::string>& wanted, const std::string& name, const Kind& kind) {
  return holds(wanted, name) || std::none_of(wanted.begin(), wanted.end(), kind);
}

int explain(const std::string& name) {
  fmt::print(stderr,
             "coverage_tool: '{}' is no scene whose truth is known, nor one of the integrators\n"
             "  remedy: name some of",
             name);
  for (const CoverageScene& one : bench::coverage_scenes()) fmt::print(stderr, " {}", one.name);
  fmt::print(stderr, " {}\n", fmt::join(analytic_integrators, " "));
  return 2;
}

}  // namespace

/// Scenes and integrators by name, all of a kind without. 1: a bar is missed that is asked for.
int main(int argc, char** argv) {
  const std::vector<std::string> wanted(argv + 1, argv + argc);
  for (const std::string& name : wanted)
    if (!is_scene(name) && !is_integrator(name)) return explain(name);
  bool is_kept = true;
  try {
    for (const CoverageScene& scene : bench::coverage_scenes()) {
      if (!is_wanted(wanted, scene.name, is_scene)) continue;
      const std::vector<KnownPixel> truth = truth_of(scene);
      for (const std::string& integrator :
           scene.is_analytic() ? analytic_integrators : shipped_integrators)
        if (is_wanted(wanted, integrator, is_integrator))
          is_kept &= measure(scene, integrator, truth) || !is_asked(scene, integrator);
    }
  } catch (const Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
  return is_kept ? 0 : 1;
}
