// The experiments of Schregle's thesis (1998), repeated: `thesis [EXPERIMENT ...]` runs those
// named, or all whose results are not there yet, and writes docs/thesis/results.md from all
// results.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <fstream>
#include <sstream>

#include "benchmarks/report.h"
#include "kaustik/base/error.h"
#include "scene_run.h"

namespace kaustik::thesis {

const std::vector<Experiment>& experiments() {
  static const std::vector<Experiment> list{
      {"walkthrough", "Step by step", walkthrough},
      {"table", "Table 8.1: ten scenes", table_8_1},
      {"figure", "Figure 8.1: error over the number of gather rays", figure_8_1},
      {"stages", "Where the time goes", stages},
      {"cache", "The irradiance cache on and off", irradiance_cache},
      {"caustic", "Caustics: photons found and photons emitted", caustic_counts},
      {"cone", "The cone filter's constant", cone_constant},
      {"coupling", "Global photons found and emitted", global_coupling},
      {"parts", "Photons traced in parts and merged", photon_parts},
      {"maze", "The maze with a coarse and a fine irradiance cache", maze_cache_quality},
  };
  return list;
}

namespace {

std::filesystem::path fragment_path(const Workplace& place, const Experiment& experiment) {
  return place.work / "fragments" / (std::string(experiment.name) + ".md");
}

void run(const Workplace& place, const Experiment& experiment) {
  say(fmt::format("{}: {}", experiment.name, experiment.title));
  std::string text;
  const double seconds = bench::seconds_of([&] { text = experiment.run(place); });
  text += fmt::format("\n*`make thesis EXPERIMENTS={}` made this in {:.0f} s.*\n", experiment.name,
                      seconds);
  place.write_text(fragment_path(place, experiment), text);
  say(fmt::format("{}: done in {:.0f} s", experiment.name, seconds));
}

void compose_page(const Workplace& place) {
  std::string page =
      "# The thesis's experiments, repeated\n\n"
      "R. Schregle, *Rendering with Photon Maps*, Bonn 1998, chapter 8. `make thesis` makes this "
      "page: every figure on it was\nmeasured by the program in `benchmarks/thesis`, on two "
      "threads. Relative MSE is the mean over pixels and channels of\n(x − r)²/(r² + 0.01) without "
      "the worst 0.1 % of the pixels.\n";
  for (const Experiment& experiment : experiments())
    if (std::filesystem::exists(fragment_path(place, experiment)))
      page += fmt::format("\n## {}\n\n{}", experiment.title,
                          read_text(fragment_path(place, experiment)));
  place.write_text(place.docs / "results.md", page);
}

int run_all(int argc, char** argv) {
  Workplace place;
  place.docs = std::string(KAUSTIK_SOURCE_DIR) + "/docs/thesis";
  place.work = "build/thesis";
  std::vector<std::string> names;
  CLI::App app("Repeats the experiments of Schregle's thesis and writes their results as a page.");
  app.add_option("experiments", names,
                 "Which to run, anew [all that have no result in the work folder]");
  app.add_option("--docs", place.docs, "Folder of the page and its pictures")
      ->capture_default_str();
  app.add_option("--work", place.work, "Folder of references and results")->capture_default_str();
  app.add_option("--effort", place.effort, "Factor on samples, below 1 to try things out")
      ->check(CLI::Range(0.001, 100.0));
  app.add_option("--scenes", place.scenes,
                 "Scenes that table measures anew, others keep what was measured before [all]")
      ->delimiter(',');
  app.add_option("--threads", place.threads, "Threads [2]")->check(CLI::Range(1, 4096));
  CLI11_PARSE(app, argc, argv);
  for (const std::string& name : names)
    if (std::none_of(experiments().begin(), experiments().end(),
                     [&](const Experiment& e) { return e.name == name; }))
      throw Error(ErrorKind::input, "there is no experiment '" + name + "'",
                  "one of: walkthrough, table, figure, stages, cache, caustic, cone, coupling, "
                  "parts, maze");
  for (const Experiment& experiment : experiments()) {
    const bool named = std::find(names.begin(), names.end(), experiment.name) != names.end();
    if (named || (names.empty() && !std::filesystem::exists(fragment_path(place, experiment))))
      run(place, experiment);
    compose_page(place);
  }
  return 0;
}

}  // namespace
}  // namespace kaustik::thesis

int main(int argc, char** argv) {
  try {
    return kaustik::thesis::run_all(argc, argv);
  } catch (const kaustik::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
