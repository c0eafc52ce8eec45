// Kaustik beside Blender Cycles and POV-Ray: `bench_peers` renders three scenes that ship, and
// three of them as plain rooms (plain_room.h, Cycles alone), with each of them for the same time on
// the same threads, start-up excluded, and prints the errors against the stored references, one
// line of JSON per pair, which it also appends to a results file, then a table; comparisons_page
// makes a page of the file. Exit status 1: a bar is not kept, or cannot be told. The peers get the
// scene as Kaustik has loaded it. Cycles' picture has to have our mean; POV-Ray is not calibrated.
#include <CLI/CLI.hpp>

#include "benchmarks/comparisons/measurement.h"
#include "benchmarks/comparisons/peer_result.h"
#include "benchmarks/comparisons/timed_renders.h"
#include "benchmarks/peers/cycles.h"
#include "benchmarks/peers/plain_room.h"
#include "benchmarks/peers/povray.h"
#include "kaustik/base/file.h"
#include "kaustik/base/processors.h"
#include "kaustik/integrator/registry.h"
#include "kaustik/loader/mitsuba_writer.h"
#include "kaustik/scene/type_tables.h"

namespace kaustik::bench {
namespace {

struct PeerBench {
  const char* scene;
  double bar;  ///< how many times less than Cycles' our error has to be
  double aim;  ///< and should be
  bool is_plain_room() const { return std::string_view(scene).starts_with(plain_prefix); }
  Description description() const {
    if (!is_plain_room()) return load_shipped(scene);
    return plain_room(load_shipped(scene + plain_prefix.size()));
  }
  static constexpr std::string_view plain_prefix = "plain_";
};

constexpr std::array peer_benches{
    PeerBench{"cornell_box", 2, 3},     PeerBench{"cornell_spheres", 5, 5},
    PeerBench{"metal_ring", 50, 50},    PeerBench{"plain_museum", 5, 5},
    PeerBench{"plain_gallery_1", 5, 5}, PeerBench{"plain_atrium", 5, 5}};

struct Options {
  std::vector<std::string> scenes, peers{"cycles", "povray"};
  std::string integrator;  ///< empty: the one that scenes get by default
  double seconds = 30;
  int threads = 0;
  uint64_t seed = 1;
  std::string references;  ///< a folder whose references go before the stored ones
  std::string results = "out/bench_peers.jsonl";
  std::string folder;  ///< where plain rooms are written to, instead of being rendered; "": nowhere
};

std::string default_integrator() {
  for (const IntegratorType& type : integrator_types())
    if (type.info.name == "auto") return "auto";
  return "photonmap";
}

/// One scene as all renderers get it.
class PeerComparison {
 public:
  PeerComparison(const PeerBench& bench, const Options& options, const Image& reference)
      : bench_(bench), options_(options), reference_(reference), description_(bench.description()) {
    use_peer_filter(description_);
    override_property(description_, fmt::format("film.width={}", reference.width()));
    override_property(description_, fmt::format("film.height={}", reference.height()));
    override_integrator(description_, options.integrator);
    const auto start = std::chrono::steady_clock::now();
    scene_ = build_scene(description_);
    (void)our_integrator();
    load_seconds_ = seconds_since(start);
  }

  PeerResult with_cycles() const {
    PeerResult result =
        compare("cycles", render_with_cycles(peer_scene_of(*scene_), options_.seconds,
                                             options_.threads, int(options_.seed)));
    result.bar = bench_.bar;
    result.aim = bench_.aim;
    if (!result.has_our_mean())
      fmt::print(stderr,
                 "# {}: the mean of Cycles' picture is {:.3f} of ours: too few samples of what it "
                 "finds by chance, or not the same scene\n",
                 bench_.scene, result.mean_ratio);
    return result;
  }

  PeerResult with_povray() const {
    return compare("povray",
                   render_with_povray(peer_scene_of(*scene_), options_.seconds, options_.threads));
  }

 private:
  std::unique_ptr<Integrator> our_integrator() const {
    std::vector<std::string> warnings;
    return make_integrator(description_, *scene_, warnings);
  }

  /// Renders as long as the peer has, and tells how both stand; no bar yet.
  PeerResult compare(const std::string& peer, const PeerPicture& theirs) const {
    SessionSettings settings;
    settings.seed = options_.seed;
    settings.threads = options_.threads;
    const TimedRenders ours = render_for(
        {theirs.seconds}, *scene_, [&] { return our_integrator(); }, settings, reference_);
    if (!ours.pictures.back())
      throw Error(ErrorKind::system, "there was no picture in time", "ask for more seconds");
    const ImageComparison& our_picture = *ours.pictures.back();
    const ImageComparison their_picture = compare_images(theirs.image, reference_);
    PeerResult result;
    result.scene = bench_.scene;
    result.peer = peer;
    result.seconds = theirs.seconds;
    result.start_up_seconds = theirs.start_up_seconds;
    result.effort = theirs.effort;
    result.relmse = error_of(their_picture);
    result.integrator = options_.integrator;
    result.our_relmse = error_of(our_picture);
    result.our_passes = ours.passes;
    result.our_load_seconds = load_seconds_;
    result.mean_ratio = ratio_of_means(their_picture) / ratio_of_means(our_picture);
    result.reference_relmse = own_relative_mse(reference_);
    result.threads = options_.threads;
    result.seed = options_.seed;
    result.program = checksum_of_file("/proc/self/exe");
    return result;
  }

  const PeerBench& bench_;
  const Options& options_;
  const Image& reference_;
  Description description_;
  std::shared_ptr<const Scene> scene_;
  double load_seconds_ = 0;
};

std::optional<Image> find_reference(const std::string& scene, const Options& options) {
  const std::string own = options.references + "/" + scene + ".exr";
  if (!options.references.empty() && std::filesystem::exists(own)) return read_image(own);
  return reference_of(scene);
}

bool wants(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

/// Adds a result to the file and to those of this run.
void keep(const Options& options, const PeerResult& result, std::vector<PeerResult>& results) {
  append_line(options.results, result.to_json_line());
  fmt::print("{}\n", result.to_json_line());
  std::fflush(stdout);
  results.push_back(result);
}

/// Whether a peer is asked for and there; says so if it is only asked for.
bool has_peer(const Options& options, const std::string& name, const std::string& program) {
  if (!wants(options.peers, name)) return false;
  if (is_installed(program)) return true;
  fmt::print(stderr, "# there is no {0} to compare with; on Debian: apt-get install {0}\n",
             program);
  return false;
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const PeerBench& bench : peer_benches) names.emplace_back(bench.scene);
  return names;
}

void add_options(CLI::App& app, Options& options) {
  app.add_option("--scenes", options.scenes, "Which [all]")
      ->delimiter(',')
      ->check(CLI::IsMember(scene_names()));
  app.add_option("--peers", options.peers, "Of cycles, povray")
      ->delimiter(',')
      ->check(CLI::IsMember({"cycles", "povray"}))
      ->capture_default_str();
  app.add_option("--integrator", options.integrator, "Ours")->capture_default_str();
  app.add_option("--seconds", options.seconds, "Of each picture")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--threads", options.threads, "Threads [all]")->check(CLI::Range(1, 4096));
  app.add_option("--seed", options.seed, "Of ours and Cycles'")->capture_default_str();
  app.add_option("--references", options.references,
                 "Folder whose SCENE.exr are compared with instead of the stored references")
      ->check(CLI::ExistingDirectory);
  app.add_option("--results", options.results, "File that results are appended to")
      ->capture_default_str();
  app.add_option("--write", options.folder,
                 "Only write the plain rooms, as plain_NAME.xml into this folder")
      ->check(CLI::ExistingDirectory);
}

void write_plain_rooms(const Options& options) {
  for (const PeerBench& bench : peer_benches) {
    if (!bench.is_plain_room() || !wants(options.scenes, bench.scene)) continue;
    const std::string text = mitsuba_xml(bench.description(), scene_types(), options.folder);
    write_file_atomically(fmt::format("{}/{}.xml", options.folder, bench.scene),
                          {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
  }
}

int run_all(int argc, char** argv) {
  Options options;
  options.integrator = default_integrator();
  CLI::App app("Compares with Blender Cycles and POV-Ray at equal time.");
  add_options(app, options);
  CLI11_PARSE(app, argc, argv);
  if (options.threads == 0) options.threads = usable_processors();
  if (!options.folder.empty()) {
    write_plain_rooms(options);
    return 0;
  }
  const bool cycles = has_peer(options, "cycles", "blender");
  const bool povray = has_peer(options, "povray", "povray");
  std::vector<PeerResult> results;
  for (const PeerBench& bench : peer_benches) {
    if (!wants(options.scenes, bench.scene)) continue;
    const std::optional<Image> reference = find_reference(bench.scene, options);
    if (!reference) continue;
    const PeerComparison comparison(bench, options, *reference);
    if (cycles) keep(options, comparison.with_cycles(), results);
    if (povray && !bench.is_plain_room()) keep(options, comparison.with_povray(), results);
  }
  fmt::print("\n{}", peer_result_table(results));
  const bool cycles_is_missing = wants(options.peers, "cycles") && !cycles;
  return all_bars_kept(results) && !cycles_is_missing ? 0 : 1;
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
