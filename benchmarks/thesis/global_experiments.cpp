// Diffuse indirect light of the Cornell box: figure 8.1, and the coupling of photons found and
// emitted.
#include <fmt/format.h>

#include "benchmarks/line_plot.h"
#include "benchmarks/markdown_table.h"
#include "error_split.h"
#include "scene_run.h"

namespace kaustik::thesis {
namespace {

constexpr int size = 128;

Image box_reference(const Workplace& place) {
  return reference(place, "cornell_box_indirect", [&] {
    const SceneRun run("cornell_box", {"path", {"integrator.components=indirect"}, size, size});
    return run.render(in_passes(uint32_t(place.scaled(8192)), 2, 999, place.threads)).image;
  });
}

/// Counts that the thesis couples.
struct GlobalCounts {
  int found, emitted;
};

/// How the sampling grid is used.
struct GridVariant {
  const char* label;
  const char* weight;
  const char* floor;
};
constexpr GridVariant grid_variants[] = {
    {"average, no floor (the thesis)", "average", "0"},
    {"sum, no floor", "sum", "0"},
    {"average, floor", "average", "0.25"},
    {"sum, floor (default)", "sum", "0.25"},
};

std::vector<std::string> thesis_settings(const GlobalCounts& counts) {
  return {"integrator.preset=thesis", "integrator.components=indirect",
          fmt::format("integrator.global_neighbors={}", counts.found),
          fmt::format("integrator.global_photons={}", counts.emitted)};
}

ErrorSplit indirect_error(const Workplace& place, const Image& truth,
                          const std::vector<std::string>& settings, uint32_t seeds) {
  const SceneRun run("cornell_box", {"photonmap", settings, size, size});
  std::vector<Image> pictures;
  for (uint32_t seed = 1; seed <= seeds; ++seed)
    pictures.push_back(run.render(in_passes(1, 1, seed, place.threads)).image);
  return split_error(pictures, truth, "indirect");
}

constexpr GlobalCounts thesis_counts[] = {{10, 5000}, {20, 10000}, {50, 20000}};

}  // namespace

std::string figure_8_1(const Workplace& place) {
  const Image truth = box_reference(place);
  const std::vector<std::string> colors{"#c0392b", "#2471a3", "#1e8449"};
  std::string text = fmt::format(
      "Diffuse indirect light of the Cornell box, {0}×{0} pixels with one camera ray each, no "
      "irradiance cache, one recursion level.\nThe thesis compares with 1024 stratified samples, "
      "we with path tracing, and its unit of the error is unknown. Without\na floor, cells that no "
      "photon came from are never sampled: what that costs is the bias, which no number of\nrays "
      "removes. The grid has no more cells than photons are found, so it is coarser with fewer.\n"
      "\n",
      size);
  bench::MarkdownTable table(
      {"sampling grid", "found, emitted", "10 rays", "30", "50", "100", "of which bias, 100"});
  for (const GridVariant& variant : grid_variants) {
    bench::LinePlot plot;
    plot.title = std::string("Sampling grid: ") + variant.label;
    plot.x_label = "numDiffuse (gather rays)";
    plot.y_label = "relative MSE of indirect light";
    for (size_t i = 0; i < std::size(thesis_counts); ++i) {
      const GlobalCounts& counts = thesis_counts[i];
      bench::Curve curve{fmt::format("{}, {}", counts.found, counts.emitted), {}, colors[i], false};
      std::vector<std::string> row{variant.label, curve.label};
      ErrorSplit last;
      for (int rays = 10; rays <= 100; rays += 10) {
        auto settings = thesis_settings(counts);
        settings.push_back(fmt::format("integrator.diffuse_samples={}", rays));
        settings.push_back(fmt::format("integrator.importance_weight={}", variant.weight));
        settings.push_back(fmt::format("integrator.importance_floor={}", variant.floor));
        last = indirect_error(place, truth, settings, uint32_t(place.scaled(2)) + 1);
        curve.points.push_back({rays, last.sum()});
        if (rays == 10 || rays == 30 || rays == 50 || rays == 100)
          row.push_back(fmt::format("{:.3g}", last.sum()));
      }
      say(fmt::format("figure: {}, {}: {}", variant.label, curve.label, row.back()));
      row.push_back(fmt::format("{:.2g}", last.bias));
      table.add(row);
      plot.curves.push_back(curve);
    }
    const std::string file = fmt::format("pictures/figure_8_1_{}{}.svg", variant.weight,
                                         variant.floor[1] != 0 ? "_floor" : "");
    place.write_text(place.docs / file, plot.svg());
    text += fmt::format("![{}]({})\n", plot.title, file);
  }
  return text + "\n" + table.text();
}

std::string global_coupling(const Workplace& place) {
  const Image truth = box_reference(place);
  const std::vector<int> emitted{5000, 20000, 80000, 320000};
  std::string text = fmt::format(
      "Diffuse indirect light of the Cornell box by 50 gather rays, {0}×{0} pixels, the thesis's "
      "preset with the sum in the sampling grid\nand a floor. Relative MSE = noise + squared bias, "
      "from four seeds.\n\n",
      size);
  std::vector<std::string> header{"`global_neighbors` \\ `global_photons`"};
  for (const int photons : emitted) header.push_back(fmt::format("{}", photons));
  bench::MarkdownTable table(header);
  for (const int found : {10, 20, 50, 100, 200}) {
    std::vector<std::string> row{fmt::format("{}", found)};
    for (const int photons : emitted) {
      auto settings = thesis_settings({found, photons});
      settings.push_back("integrator.importance_weight=sum");
      settings.push_back("integrator.importance_floor=0.25");
      const ErrorSplit error = indirect_error(place, truth, settings, 4);
      row.push_back(fmt::format("{:.2g} = {:.2g} + {:.2g}", error.sum(), error.noise, error.bias));
    }
    say(fmt::format("coupling: {} found", found));
    table.add(row);
  }
  return text + table.text();
}

}  // namespace kaustik::thesis
