// Integrators on scenes over time: `bench_scenes` renders each for 5, 20 and 60 s (5 and 20 s
// on the scenes with references of others) on all cores and appends what came out to a results
// file, one line of JSON per run. What is there already from the same program, scene (with all
// files that it names), integrator and reference is not run again. `comparisons_page` makes tables
// and a page of it.
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <sstream>

#include "benchmarks/comparisons/bench_scene.h"
#include "benchmarks/comparisons/measurement.h"
#include "benchmarks/comparisons/timed_renders.h"
#include "kaustik/base/processors.h"
#include "kaustik/integrator/description_types.h"
#include "kaustik/integrator/registry.h"
#include "kaustik/loader/scene_format.h"
#include "kaustik/scene/description_digest.h"

namespace kaustik::bench {
namespace {

struct Options {
  std::vector<std::string> scenes = default_scene_names();
  std::vector<std::string> integrators{"path", "bdpt", "ppm", "vcm", "photonmap", "auto"};
  std::vector<double> seconds;  ///< empty: each scene's own
  std::vector<uint64_t> seeds;  ///< likewise
  int threads = 0;              ///< 0: all
  /// A folder whose references go before those that came with the scenes.
  std::string references = std::string(KAUSTIK_SOURCE_DIR) + "/benchmarks/references";
  std::string results = "out/bench_scenes.jsonl";
  bool any_program = false;
};

void say(const std::string& text) { fmt::print(stderr, "# {}\n", text); }

bool is_known(const std::string& integrator) {
  const std::string name = type_of(integrator);
  const std::vector<IntegratorType>& types = integrator_types();
  return std::any_of(types.begin(), types.end(),
                     [&](const IntegratorType& type) { return type.info.name == name; });
}

/// `integrator` may have settings: see type_of().
void set_integrator(Description& description, const std::string& integrator) {
  override_integrator(description, type_of(integrator));
  std::stringstream settings(integrator);
  std::string setting;
  std::getline(settings, setting, setting_separator);  // the type
  while (std::getline(settings, setting, setting_separator))
    override_property(description, "integrator." + setting);
}

/// Leaves out, and says so, what this program does not have.
std::vector<std::string> known_integrators(const std::vector<std::string>& names) {
  std::vector<std::string> known;
  for (const std::string& name : names)
    if (is_known(name))
      known.push_back(name);
    else
      say(fmt::format("there is no integrator '{}': left out", name));
  return known;
}

/// What a scene is compared with.
struct ChosenReference {
  std::string path;
  double mean_ratio = std::nan("");  ///< Measurement::reference_mean_ratio
};

/// The folder's file of the scene's name, and says how bright it is beside the one that came with
/// the scene; else that one; nothing and says so if there is neither.
std::optional<ChosenReference> choose_reference(const BenchScene& scene,
                                                const std::string& folder) {
  ChosenReference own{folder + "/" + scene.name + ".exr"};
  const bool has_other = std::filesystem::exists(scene.reference);
  if (std::filesystem::exists(own.path)) {
    if (has_other && !std::filesystem::equivalent(own.path, scene.reference)) {
      own.mean_ratio =
          ratio_of_means(compare_images(read_image(own.path), read_image(scene.reference)));
      say(fmt::format("{}: {} has {:.4f} of the light of {}", scene.name, own.path, own.mean_ratio,
                      scene.reference));
    }
    return own;
  }
  if (has_other) return ChosenReference{scene.reference};
  say(fmt::format("{}: left out, there is no {}; make it: make references SCENES={}", scene.name,
                  scene.reference, scene.name));
  return std::nullopt;
}

/// The scene's description in the size of its reference.
Description describe(const BenchScene& scene, const std::string& integrator,
                     const Image& reference) {
  Description description = load_scene(scene.file);
  set_integrator(description, integrator);
  override_property(description, fmt::format("film.width={}", reference.width()));
  override_property(description, fmt::format("film.height={}", reference.height()));
  return description;
}

double reference_noise(const Image& reference) {
  return reference.find_channel("error.R") >= 0 ? own_relative_mse(reference) : std::nan("");
}

/// Fills in what came out of a measurement of which scene, integrator, seed, seconds and threads
/// are known, and returns the last picture. Throws Error where the integrator refuses the scene.
Image measure(const BenchScene& scene, const Image& reference, Measurement& m) {
  const auto start = std::chrono::steady_clock::now();
  const Description description = describe(scene, m.integrator, reference);
  const auto built = build_scene(description);
  std::vector<std::string> warnings;
  const auto make_method = [&] { return make_integrator(description, *built, warnings); };
  m.load_seconds = seconds_since(start);
  SessionSettings settings;
  settings.seed = m.seed;
  settings.threads = m.threads;
  const TimedRenders taken = render_for(m.seconds, *built, make_method, settings, reference);
  for (const std::optional<ImageComparison>& picture : taken.pictures)
    m.relmse.push_back(picture ? error_of(*picture) : std::nan(""));
  m.seconds_taken = taken.seconds_taken;
  m.mean_ratio = taken.pictures.back() ? ratio_of_means(*taken.pictures.back()) : std::nan("");
  m.passes = taken.passes;
  m.samples_per_pass = taken.samples_per_pass;
  m.cpu_share = taken.cpu_share;
  m.reference_relmse = reference_noise(reference);
  return taken.last;
}

/// The measurements that are wanted of one scene, and those that there are.
class SceneBench {
 public:
  SceneBench(const Options& options, const BenchScene& scene, const ChosenReference& reference)
      : options_(options),
        scene_(scene),
        reference_(read_image(reference.path)),
        reference_mean_ratio_(reference.mean_ratio),
        program_(checksum_of_file("/proc/self/exe")),
        reference_checksum_(checksum_of_file(reference.path)),
        done_(read_measurements(options.results)) {}

  void run(const std::vector<std::string>& integrators) const {
    for (const uint64_t seed : options_.seeds.empty() ? scene_.seeds : options_.seeds)
      for (const std::string& integrator : integrators) run_unless_done(wanted(integrator, seed));
  }

 private:
  Measurement wanted(const std::string& integrator, uint64_t seed) const {
    Measurement m;
    m.scene = scene_.name;
    m.integrator = integrator;
    m.seed = seed;
    m.seconds = options_.seconds.empty() ? scene_.seconds : options_.seconds;
    m.threads = options_.threads;
    m.program = program_;
    m.reference_mean_ratio = reference_mean_ratio_;
    const DescriptionDigest digest =
        description_digest(describe(scene_, integrator, reference_), description_types());
    m.inputs =
        fmt::format("{:016x} {:016x} {}", digest.scene, digest.integrator, reference_checksum_);
    return m;
  }

  bool covers(const Measurement& old, const Measurement& m) const {
    return old.scene == m.scene && old.integrator == m.integrator && old.seed == m.seed &&
           old.threads == m.threads && old.inputs == m.inputs &&
           (old.program == m.program || options_.any_program) &&
           std::all_of(m.seconds.begin(), m.seconds.end(),
                       [&](double t) { return old.relmse_at(t).has_value(); });
  }

  void run_unless_done(Measurement m) const {
    if (std::any_of(done_.begin(), done_.end(),
                    [&](const Measurement& old) { return covers(old, m); })) {
      say(fmt::format("{}, {}, seed {}: there already", m.scene, m.integrator, m.seed));
      return;
    }
    say(fmt::format("{}, {}, seed {}: {:g} s", m.scene, m.integrator, m.seed,
                    fmt::join(m.seconds, ", ")));
    try {
      keep(m, measure(scene_, reference_, m));
    } catch (const Error& error) {
      say(fmt::format("{}, {}: left out: {}", m.scene, m.integrator, error.what()));
      return;
    }
    append_line(options_.results, m.to_json_line());
    fmt::print("{}\n", m.to_json_line());
    std::fflush(stdout);
  }

  /// Pictures of one seed are enough to look at.
  void keep(const Measurement& m, const Image& picture) const {
    const auto& seeds = options_.seeds.empty() ? scene_.seeds : options_.seeds;
    if (picture.width() == 0 || m.seed != seeds.front()) return;
    const std::string path = picture_path(options_.results, m.scene, m.integrator);
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    write_image(picture, path);
  }

  const Options& options_;
  const BenchScene& scene_;
  Image reference_;
  double reference_mean_ratio_;
  std::string program_, reference_checksum_;
  std::vector<Measurement> done_;
};

void add_options(CLI::App& app, Options& options) {
  app.add_option("--scenes", options.scenes,
                 "Folders of scenes/, files of benchmarks/scenes/, or peer_NAME")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--integrators", options.integrators,
                 "Which to measure; with settings: ppm:guiding=false:aim=none")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--seconds", options.seconds, "One render for each [5,20,60; of peer_NAME 5,20]")
      ->delimiter(',')
      ->check(CLI::PositiveNumber);
  app.add_option("--seeds", options.seeds, "One run per seed [1,2; of peer_NAME 1,2,3]")
      ->delimiter(',');
  app.add_option("--threads", options.threads, "Threads [all]")->check(CLI::Range(1, 4096));
  app.add_option(
         "--references", options.references,
         "Folder whose SCENE.exr are compared with instead of those that came with the scene")
      ->check(CLI::ExistingDirectory)
      ->capture_default_str();
  app.add_option("--results", options.results, "File that results are appended to")
      ->capture_default_str();
  app.add_flag("--any-program", options.any_program,
               "What another build has measured is not run again either");
}

int run_all(int argc, char** argv) {
  Options options;
  CLI::App app("Measures the error of integrators on scenes over time.");
  add_options(app, options);
  CLI11_PARSE(app, argc, argv);
  std::sort(options.seconds.begin(), options.seconds.end());
  if (options.threads == 0) options.threads = usable_processors();
  std::vector<BenchScene> scenes;
  for (const std::string& name : options.scenes) scenes.push_back(bench_scene(name));
  const std::vector<std::string> integrators = known_integrators(options.integrators);
  for (const BenchScene& scene : scenes) {
    if (const auto reference = choose_reference(scene, options.references))
      SceneBench(options, scene, *reference).run(integrators);
  }
  return 0;
}

}  // namespace
}  // namespace kaustik::bench

int main(int argc, char** argv) {
  try {
    return kaustik::bench::run_all(argc, argv);
  } catch (const kaustik::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
