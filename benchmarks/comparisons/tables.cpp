#include "benchmarks/comparisons/tables.h"

#include <algorithm>

#include "benchmarks/comparisons/table_cells.h"
#include "benchmarks/markdown_table.h"

namespace kaustik::bench {
namespace {

/// Of all integrators without settings: "2", or "1 – 3".
std::string seeds_of(const Results& results, const std::string& scene, double time) {
  int least = 0, most = 0;
  for (const std::string& integrator : results.integrators()) {
    const int count = results.seed_count(scene, integrator, time);
    if (count == 0) continue;
    least = least == 0 ? count : std::min(least, count);
    most = std::max(most, count);
  }
  return least == most ? fmt::format("{}", most) : fmt::format("{} – {}", least, most);
}

}  // namespace

std::string error_table(const Results& results) {
  const bool several_builds = results.builds().size() > 1;
  std::vector<std::string> header{"scene", "s", "seeds"};
  for (const std::string& integrator : results.integrators()) header.push_back(integrator);
  header.emplace_back("reference's own");
  if (several_builds) header.emplace_back("build");
  MarkdownTable table(header);
  for (const std::string& scene : results.scenes()) {
    for (const double time : results.times(scene)) {
      std::vector<std::string> row{scene, fmt::format("{:g}", time),
                                   seeds_of(results, scene, time)};
      for (const std::string& integrator : results.integrators())
        row.push_back(cell(results.relmse(scene, integrator, time)));
      row.push_back(cell(results.reference_relmse(scene)));
      if (several_builds) row.push_back(results.builds_of(scene, results.integrators()));
      table.add(row);
    }
  }
  return table.text();
}

std::string mean_table(const Results& results) {
  std::vector<std::string> header{"scene"};
  for (const std::string& integrator : results.integrators()) header.push_back(integrator);
  MarkdownTable table(header);
  for (const std::string& scene : results.scenes()) {
    std::vector<std::string> row{scene};
    for (const std::string& integrator : results.integrators())
      row.push_back(cell(results.mean_ratio(scene, integrator), "{:.4f}"));
    table.add(row);
  }
  return table.text();
}

LinePlot error_plot(const Results& results, const std::string& scene) {
  static const std::vector<std::string> colors{"#c0392b", "#2471a3", "#1e8449", "#af601a",
                                               "#7d3c98", "#212f3d", "#b7950b", "#148f77"};
  LinePlot plot;
  plot.title = scene;
  plot.x_label = "seconds";
  plot.y_label = "relative MSE";
  plot.logarithmic = true;
  for (size_t i = 0; i < results.integrators().size(); ++i) {
    const std::string& integrator = results.integrators()[i];
    Curve curve{integrator, {}, colors[i % colors.size()], i >= colors.size()};
    for (const double time : results.times(scene))
      if (const auto error = results.relmse(scene, integrator, time))
        curve.points.emplace_back(time, *error);
    if (!curve.points.empty()) plot.curves.push_back(curve);
  }
  return plot;
}

}  // namespace kaustik::bench
