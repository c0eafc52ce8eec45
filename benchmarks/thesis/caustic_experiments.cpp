// What numbers of caustic photons do to the metal ring, and the cone filter's constant.
#include <fmt/format.h>

#include "benchmarks/markdown_table.h"
#include "error_split.h"
#include "scene_run.h"

namespace kaustik::thesis {
namespace {

constexpr int size = 300;
constexpr uint32_t seeds = 4;

Image ring_reference(const Workplace& place) {
  return reference(place, "metal_ring_caustic", [&] {
    const SceneRun run("metal_ring",
                       {"lighttracer", {"integrator.components=caustic"}, size, size});
    return run.render(in_passes(uint32_t(place.scaled(512)), 4, 999, place.threads)).image;
  });
}

/// One light pass each, with the radius that the photons found set.
ErrorSplit caustic_error(const Workplace& place, const Image& truth,
                         const std::vector<std::string>& settings) {
  Changes changes{"photonmap", settings, size, size};
  changes.settings.push_back("integrator.components=caustic");
  // The search is bounded by nothing but the number to find, as in the thesis.
  changes.settings.push_back("integrator.caustic_radius=10");
  const SceneRun run("metal_ring", changes);
  std::vector<Image> pictures;
  for (uint32_t seed = 1; seed <= seeds; ++seed)
    pictures.push_back(run.render(in_passes(16, 1, seed, place.threads)).image);
  return split_error(pictures, truth, "caustic");
}

std::string in_table(const ErrorSplit& error) {
  return fmt::format("{:.2g} = {:.2g} + {:.2g}", error.sum(), error.noise, error.bias);
}

}  // namespace

std::string caustic_counts(const Workplace& place) {
  const Image truth = ring_reference(place);
  const std::vector<int> found{20, 50, 80, 200, 500};
  const std::vector<int> emitted{25000, 250000, 2500000};
  std::string text = fmt::format(
      "The metal ring's caustic, {0}×{0} pixels, one light pass, cone filter with k = 1. Relative "
      "MSE = noise + squared bias (blur),\nfrom {1} seeds, against light tracing. Noise falls with "
      "the photons found, blur rises with them; both fall with the photons emitted.\n\n",
      size, seeds);
  std::vector<std::string> header{"`caustic_neighbors` \\ `caustic_photons`"};
  for (const int photons : emitted) header.push_back(fmt::format("{}", photons));
  bench::MarkdownTable table(header);
  std::vector<std::pair<double, int>> best(emitted.size(), {1e30, 0});
  for (const int neighbors : found) {
    std::vector<std::string> row{fmt::format("{}", neighbors)};
    for (size_t i = 0; i < emitted.size(); ++i) {
      say(fmt::format("caustic: {} of {}", neighbors, emitted[i]));
      const ErrorSplit error =
          caustic_error(place, truth,
                        {fmt::format("integrator.caustic_neighbors={}", neighbors),
                         fmt::format("integrator.caustic_photons={}", emitted[i])});
      best[i] = std::min(best[i], {error.sum(), neighbors});
      row.push_back(in_table(error));
    }
    table.add(row);
  }
  text += table.text() + "\nThe number to find with the least error:";
  for (size_t i = 0; i < emitted.size(); ++i)
    text += fmt::format("{} {} of {} photons", i == 0 ? "" : ",", best[i].second, emitted[i]);
  return text + ".\n";
}

std::string cone_constant(const Workplace& place) {
  const Image truth = ring_reference(place);
  std::string text = fmt::format(
      "The same picture with 250000 photons, 50 and 200 found, by the cone filter's constant k. A "
      "larger k is flatter: less noise, more blur.\nRelative MSE = noise + squared bias, {} "
      "seeds.\n\n",
      seeds);
  bench::MarkdownTable table({"kernel", "50 found", "200 found"});
  const auto row = [&](const std::string& title, const std::vector<std::string>& settings) {
    std::vector<std::string> cells{title};
    for (const int neighbors : {50, 200}) {
      auto all = settings;
      all.push_back(fmt::format("integrator.caustic_neighbors={}", neighbors));
      all.push_back("integrator.caustic_photons=250000");
      cells.push_back(in_table(caustic_error(place, truth, all)));
    }
    table.add(cells);
  };
  for (const char* k : {"1", "1.1", "1.5", "2", "4"})
    row(fmt::format("cone, k = {}", k),
        {"integrator.caustic_kernel=cone", fmt::format("integrator.caustic_filter={}", k)});
  row("constant (k = ∞)", {"integrator.caustic_kernel=constant"});
  row("Epanechnikov's", {"integrator.caustic_kernel=epanechnikov"});
  return text + table.text();
}

}  // namespace kaustik::thesis
