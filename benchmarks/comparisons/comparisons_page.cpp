// `comparisons_page [RESULTS]` prints the tables of what bench_scenes has measured; with --docs it
// writes them and plots of the error over time as a page.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <set>

#include "benchmarks/comparisons/bench_scene.h"
#include "benchmarks/comparisons/peer_result.h"
#include "benchmarks/comparisons/picture_strip.h"
#include "benchmarks/comparisons/tables.h"
#include "kaustik/base/error.h"
#include "kaustik/base/file.h"
#include "kaustik/image/image_io.h"

namespace kaustik::bench {
namespace {

/// With a smaller fraction of the processors' time, other programs had the rest, or the method
/// leaves processors idle.
constexpr double quiet_fraction = 0.9;
/// The page names references whose own noise is a larger fraction of the least error compared.
constexpr double low_noise_fraction = 0.1;

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  write_file_atomically(path.string(),
                        {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

std::string list_of(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : ", ") + item;
  return text;
}

/// Who has measured: which builds, if there are several.
std::string builds(const Results& results) {
  if (results.builds().size() <= 1) return "one build of the program";
  std::vector<std::string> names;
  for (size_t i = 0; i < results.builds().size(); ++i)
    names.push_back(fmt::format("{}: {}", letter_of(i), results.builds()[i]));
  return fmt::format("{} builds of the program ({})", names.size(), list_of(names));
}

/// Scenes whose reference is noisy beside the errors, or not the same for all.
std::string about_references(const Results& results) {
  std::vector<std::string> noisy, several, untold;
  for (const std::string& scene : results.scenes()) {
    std::optional<double> least;
    for (const std::string& integrator : results.integrators())
      if (const auto error = results.relmse(scene, integrator, results.last_time(scene)))
        least = std::min(error.value(), least.value_or(*error));
    const std::optional<double> own = results.reference_relmse(scene);
    if (!own) untold.push_back(scene);
    if (own && least && *own > low_noise_fraction * *least)
      noisy.push_back(fmt::format("{} ({:.0f} %)", scene, 100 * *own / *least));
    if (!results.has_one_reference(scene)) several.push_back(scene);
  }
  std::string text;
  if (!noisy.empty())
    text += fmt::format(
        "\nThe reference's own noise is more than a tenth of the least error at the last time for "
        "{}.\n",
        list_of(noisy));
  if (!untold.empty())
    text +=
        fmt::format("\nThese references have no estimate of their noise: {}.\n", list_of(untold));
  if (!several.empty())
    text += fmt::format("\nOn these scenes runs were compared with different references: {}.\n",
                        list_of(several));
  return text;
}

/// What bears on how far the figures can be trusted.
std::string circumstances(const Results& results) {
  std::set<int> threads;
  int disturbed = 0;
  double least_fraction = 1;
  for (const Measurement& m : results.all()) {
    threads.insert(m.threads);
    if (m.cpu_share < quiet_fraction) ++disturbed;
    least_fraction = std::min(least_fraction, m.cpu_share);
  }
  std::string text = fmt::format("{} runs on {} threads", results.all().size(), *threads.begin());
  if (threads.size() > 1) text += fmt::format(" to {}", *threads.rbegin());
  text += fmt::format(", by {}.", builds(results));
  if (disturbed > 0)
    text += fmt::format(
        " {} of them had less than {:.0f} % of the processors' time, the worst {:.0f} %: other "
        "programs ran, or the method leaves processors idle.",
        disturbed, 100 * quiet_fraction, 100 * least_fraction);
  return text;
}

std::string error_tables(const Results& results) {
  const std::string headline = headline_of(results);
  std::string text =
      "## Error\n\nA dash: the method has no sample of some pixels yet.\n\n" +
      error_table(results) + about_references(results) +
      "\nEach error includes the noise of the reference. The tables below give ratios as measured, "
      "and without that noise: it is\nsubtracted from both errors. Where the noise is more than "
      "half of an error, the difference says little. The ratio as measured\nis then a bound (>, "
      "<). Bars apply to ratios without the noise. Some cannot be decided by a bound.\n";
  text +=
      fmt::format(
          "\n## Beside the best of all other methods\n\nThe error of `{0}` over the least error "
          "of all other methods, `photonmap` included. On shipped scenes it must be\nat most "
          "1.15 on each and 1.0 on average, at each time.\n\n",
          headline) +
      best_table(results);
  return text +
         fmt::format("\n## Beside path tracing\n\nThe error of `path` over that of `{}`.\n\n",
                     headline) +
         path_table(results);
}

std::string tables_beside_others(const Results& results,
                                 const std::vector<PeerResult>& peer_results) {
  std::string text;
  const std::string peers = peer_table(results);
  if (!peers.empty())
    text +=
        "\n## Beside other renderers\n\nThe scenes and the figures of the other renderers are "
        "those "
        "of [benchmarks/peer_scenes](../benchmarks/peer_scenes/README.md),\nmeasured for 20 s on 2 "
        "cores of one machine. Ours are measured where this page was made. Their figures include "
        "the noise and\nthe bias of those references, ours the noise of our references. Nothing is "
        "subtracted. A bar of 3 asks for a third of the best\nerror.\n\n" +
        peers;
  if (!peer_results.empty())
    text +=
        "\n## At equal time beside Blender Cycles and POV-Ray\n\n`make bench-peers` gives all "
        "renderers the same geometry, lamps and materials on the same cores for the same time, "
        "without\ntheir start-up. POV-Ray is not calibrated and has no bar. Rooms named `plain_…` "
        "are shipped scenes whose materials and lamps every\nrenderer has: matt surfaces, clear "
        "glass, and lamps that are surfaces.\n\n" +
        peer_result_table(peer_results);
  return text;
}

std::string tables(const Results& results, const std::vector<PeerResult>& peer_results) {
  return error_tables(results) + tables_beside_others(results, peer_results) +
         "\n## Means\n\nThe mean of the picture over the mean of the reference.\n\n" +
         mean_table(results);
}

/// Of path tracing and of the headline beside the reference, as far as pictures were kept; else
/// what an earlier page has, or "".
std::string picture_of(const std::string& scene, const std::string& results_file,
                       const std::string& headline, const std::filesystem::path& docs) {
  std::vector<Image> pictures;
  std::string shown;
  const BenchScene known = bench_scene(scene);
  const std::string own =
      std::string(KAUSTIK_SOURCE_DIR) + "/benchmarks/references/" + scene + ".exr";
  const std::string reference = std::filesystem::exists(own) ? own : known.reference;
  for (const std::string& integrator : {std::string("path"), headline}) {
    const std::string path = picture_path(results_file, scene, integrator);
    if (!std::filesystem::exists(path)) continue;
    pictures.push_back(read_image(path));
    shown += "`" + integrator + "`, ";
  }
  const std::string file = "comparisons/" + scene + ".jpg";
  if (pictures.empty() || !std::filesystem::exists(reference))
    return std::filesystem::exists(docs / file)
               ? fmt::format("From an earlier page:\n\n![pictures of {}]({})\n\n", scene, file)
               : std::string();
  std::filesystem::create_directories((docs / file).parent_path());
  write_shown_image(picture_strip(pictures, read_image(reference)), (docs / file).string(), 90);
  return fmt::format("{}reference:\n\n![pictures of {}]({})\n\n", shown, scene, file);
}

std::string page(const Results& results, const std::vector<PeerResult>& peer_results,
                 const std::string& results_file, const std::filesystem::path& docs) {
  std::string text = fmt::format(
      "# Methods compared over time\n\n"
      "`make bench-scenes` measures, `make comparisons` writes this page.\n\n"
      "- **Error** is the relative MSE: the mean of (x − r)²/(r² + 0.01) over pixels and channels, "
      "without the worst 0.1 % of the pixels.\n"
      "- **References** r are made by `make references`, with [several "
      "methods](../benchmarks/README.md). What mirrors and glass show of focused light\n  is by "
      "long runs "
      "of "
      "`auto` itself. Scenes `peer_…` without such a reference have the one that came with them.\n"
      "- **Time** counts from the start of rendering. Each time is a render of its own that ends "
      "then, as\n  `kaustik render --time` does. Over several seeds the error is the "
      "mean.\n\n{}\n\n",
      circumstances(results));
  text +=
      tables(results, peer_results) +
      "\n## Scene by scene\n\nThe error over time, and the pictures at its end, all with the same "
      "exposure. Below each picture is the relative squared error\nof its pixels, from 10⁻⁶ (dark "
      "blue) to 1 (yellow).\n\n";
  for (const std::string& scene : results.scenes()) {
    const std::string file = "comparisons/" + scene + ".svg";
    write_text(docs / file, error_plot(results, scene).svg());
    text += fmt::format("### {}\n\n![error over time]({})\n\n", scene, file) +
            picture_of(scene, results_file, headline_of(results), docs);
  }
  return text;
}

int run(int argc, char** argv) {
  std::string path = "out/bench_scenes.jsonl", peers_path = "out/bench_peers.jsonl", docs;
  CLI::App app("Tables, and a page with --docs, of what bench_scenes has measured.");
  app.add_option("results", path, "What bench_scenes wrote")->capture_default_str();
  app.add_option("--peers", peers_path, "What bench_peers wrote, if it did")->capture_default_str();
  app.add_option("--docs", docs, "Folder that comparisons.md and its plots go into [only print]");
  CLI11_PARSE(app, argc, argv);
  const Results results(read_measurements(path));
  if (results.all().empty())
    throw Error(ErrorKind::input, path + " holds no results", "make some: make bench-scenes");
  const std::vector<PeerResult> peer_results = read_peer_results(peers_path);
  fmt::print("{}\n\n{}", circumstances(results), tables(results, peer_results));
  if (docs.empty()) return 0;
  const std::filesystem::path page_path = std::filesystem::path(docs) / "comparisons.md";
  write_text(page_path, page(results, peer_results, path, docs));
  fmt::print("\nwritten: {}\n", page_path.string());
  return 0;
}

}  // namespace
}  // namespace kaustik::bench

int main(int argc, char** argv) {
  try {
    return kaustik::bench::run(argc, argv);
  } catch (const kaustik::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
