// `comparisons_page [RESULTS]` prints the tables of what bench_scenes has measured; with --docs it
// writes them and plots of the error over time as a page.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <filesystem>
#include <set>

#include "benchmarks/comparisons/bench_scene.h"
#include "benchmarks/comparisons/picture_strip.h"
#include "benchmarks/comparisons/tables.h"
#include "kaustik/base/error.h"
#include "kaustik/base/file.h"
#include "kaustik/image/image_io.h"

namespace kaustik::bench {
namespace {

/// Less than this share of the processors' time: somebody else had the rest, or the method leaves
/// processors idle.
constexpr double quiet_share = 0.9;

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  write_file_atomically(path.string(),
                        {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

/// What bears on how far the figures can be trusted.
std::string circumstances(const Results& results) {
  std::set<std::string> programs;
  std::set<int> threads;
  int disturbed = 0;
  double least_share = 1;
  for (const Measurement& m : results.all()) {
    programs.insert(m.program);
    threads.insert(m.threads);
    if (m.cpu_share < quiet_share) ++disturbed;
    least_share = std::min(least_share, m.cpu_share);
  }
  std::string text = fmt::format("{} runs on {} threads", results.all().size(), *threads.begin());
  if (threads.size() > 1) text += fmt::format(" to {}", *threads.rbegin());
  text +=
      fmt::format(", by {} of the program.",
                  programs.size() == 1 ? "one build" : fmt::format("{} builds", programs.size()));
  if (disturbed > 0)
    text += fmt::format(
        " {} of them had less than {:.0f} % of the processors' time, the worst {:.0f} %: others "
        "ran "
        "beside them, or the method leaves processors idle.",
        disturbed, 100 * quiet_share, 100 * least_share);
  return text;
}

std::string tables(const Results& results) {
  std::string text = "## Error\n\n" + error_table(results);
  const std::string peers = peer_table(results);
  if (!peers.empty())
    text +=
        "\n## Beside other renderers\n\nThe scenes and the others' figures are those of "
        "[benchmarks/peer_scenes](../benchmarks/peer_scenes/README.md), which were measured\n"
        "on 2 cores of one machine at 20 s; ours are measured where this page was made.\n\n" +
        peers;
  const std::string early = early_table(results);
  if (!early.empty())
    text +=
        "\n## The first seconds\n\n`photonmap` gathers from maps through an irradiance cache: a "
        "smooth picture soon, with a bias that stays visible longer.\nWhere it is ahead it is told "
        "here.\n\n" +
        early;
  const std::string ablation = ablation_table(results);
  if (!ablation.empty())
    text +=
        "\n## Each device off\n\nThe error with a setting changed over that without at equal "
        "time, in parentheses the same of the time that a pass takes\n(`make ablation`).\n\n" +
        ablation;
  return text + "\n## Means\n\nMean of the picture over that of the reference.\n\n" +
         mean_table(results);
}

/// Of path tracing and of the headline beside the reference, as far as pictures were kept; "":
/// none.
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
  if (pictures.empty() || !std::filesystem::exists(reference)) return {};
  const std::string file = "comparisons/" + scene + ".jpg";
  std::filesystem::create_directories((docs / file).parent_path());
  write_shown_image(picture_strip(pictures, read_image(reference)), (docs / file).string(), 90);
  return fmt::format("{}reference:\n\n![pictures of {}]({})\n\n", shown, scene, file);
}

std::string page(const Results& results, const std::string& results_file,
                 const std::filesystem::path& docs) {
  std::string text = fmt::format(
      "# Methods compared over time\n\n"
      "`make bench-scenes` measures this, `make comparisons` writes the page. Relative MSE is the "
      "mean over pixels and channels of\n(x − r)²/(r² + 0.01) without the worst 0.1 % of the "
      "pixels, against references that `make references` makes (of `peer_…`: where\nthere are "
      "any, else those that other renderers have made). In these, what mirrors and glass show of "
      "focused light is by `auto`\nitself, of long runs; see benchmarks/README.md. Time counts "
      "from the start of rendering; a "
      "picture counts from the end of its "
      "last pass.\nWhere there are several seeds, errors are means over them. Ratios above 1 say "
      "how many times less the error of `{}` is.\n\n{}\n\n",
      headline_of(results), circumstances(results));
  text +=
      tables(results) +
      "\n## Scene by scene\n\nThe error over time; the pictures at the end of it, all brought to "
      "the display by the same factor, and below each the relative\nsquared error of its "
      "pixels, from 10⁻⁶ (dark blue) to 1 (yellow).\n\n";
  for (const std::string& scene : results.scenes()) {
    const std::string file = "comparisons/" + scene + ".svg";
    write_text(docs / file, error_plot(results, scene).svg());
    text += fmt::format("### {}\n\n![error over time]({})\n\n", scene, file) +
            picture_of(scene, results_file, headline_of(results), docs);
  }
  return text;
}

int run(int argc, char** argv) {
  std::string path = "out/bench_scenes.jsonl", docs;
  CLI::App app("Tables, and a page with --docs, of what bench_scenes has measured.");
  app.add_option("results", path, "What bench_scenes wrote")->capture_default_str();
  app.add_option("--docs", docs, "Folder that comparisons.md and its plots go into [only print]");
  CLI11_PARSE(app, argc, argv);
  const Results results(read_measurements(path));
  if (results.all().empty())
    throw Error(ErrorKind::input, path + " holds no results", "make some: make bench-scenes");
  fmt::print("{}\n\n{}", circumstances(results), tables(results));
  if (docs.empty()) return 0;
  const std::filesystem::path page_path = std::filesystem::path(docs) / "comparisons.md";
  write_text(page_path, page(results, path, docs));
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
