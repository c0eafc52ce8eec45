#include "benchmarks/comparisons/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "benchmarks/comparisons/bench_scene.h"
#include "benchmarks/markdown_table.h"

namespace kaustik::bench {
namespace {

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

/// In the order in which methods are told of, those that are not in it last.
void sort_integrators(std::vector<std::string>& names) {
  static const std::vector<std::string> order{"path", "bdpt", "ppm", "vcm", "photonmap", "auto"};
  std::stable_sort(names.begin(), names.end(), [&](const std::string& a, const std::string& b) {
    return std::find(order.begin(), order.end(), a) < std::find(order.begin(), order.end(), b);
  });
}

std::string cell(const std::optional<double>& value, const char* format = "{:.2g}") {
  return value ? fmt::format(fmt::runtime(format), *value) : "–";
}

std::optional<double> smallest(const std::vector<std::optional<double>>& values) {
  std::optional<double> least;
  for (const std::optional<double>& value : values)
    if (value && (!least || *value < *least)) least = value;
  return least;
}

/// How many times less the error is.
std::optional<double> ratio(const std::optional<double>& other, const std::optional<double>& ours) {
  if (!other || !ours || *ours == 0) return std::nullopt;
  return *other / *ours;
}

/// Over the ratios that there are.
class GeometricMean {
 public:
  void add(const std::optional<double>& value) {
    if (!value) return;
    sum_of_logarithms_ += std::log(*value);
    ++count_;
  }
  std::optional<double> value() const {
    if (count_ == 0) return std::nullopt;
    return std::exp(sum_of_logarithms_ / count_);
  }

 private:
  double sum_of_logarithms_ = 0;
  int count_ = 0;
};

/// When others' figures are compared: at the time that they had, where ours was looked at then.
double time_beside_peers(const Results& results, const std::string& scene) {
  const std::vector<double> times = results.times(scene);
  const bool looked_then = std::find(times.begin(), times.end(), peer_seconds) != times.end();
  return looked_then ? peer_seconds : times.back();
}

std::optional<double> best_of_four(const Results& results, const std::string& scene, double time) {
  std::vector<std::optional<double>> errors;
  for (const char* integrator : {"path", "bdpt", "ppm", "vcm"})
    errors.push_back(results.relmse(scene, integrator, time));
  return smallest(errors);
}

}  // namespace

Results::Results(const std::vector<Measurement>& in_order) {
  for (const Measurement& m : in_order) {
    add_once(scenes_, m.scene);
    add_once(type_of(m.integrator) == m.integrator ? integrators_ : variants_, m.integrator);
    std::erase_if(newest_, [&](const Measurement& old) {
      return old.scene == m.scene && old.integrator == m.integrator && old.seed == m.seed;
    });
    newest_.push_back(m);
  }
  sort_integrators(integrators_);
}

bool Results::has(const std::string& integrator) const {
  return std::find(integrators_.begin(), integrators_.end(), integrator) != integrators_.end();
}

std::vector<double> Results::times(const std::string& scene) const {
  std::set<double> times;
  for (const Measurement& m : newest_)
    if (m.scene == scene) times.insert(m.seconds.begin(), m.seconds.end());
  return {times.begin(), times.end()};
}

std::optional<double> Results::mean_over_seeds(
    const std::string& scene, const std::string& integrator,
    const std::function<std::optional<double>(const Measurement&)>& value) const {
  double sum = 0;
  int count = 0;
  for (const Measurement& m : newest_)
    if (m.scene == scene && m.integrator == integrator)
      if (const std::optional<double> v = value(m)) {
        sum += *v;
        ++count;
      }
  if (count == 0 || std::isnan(sum)) return std::nullopt;
  return sum / count;
}

std::optional<double> Results::relmse(const std::string& scene, const std::string& integrator,
                                      double time) const {
  return mean_over_seeds(scene, integrator,
                         [&](const Measurement& m) { return m.relmse_at(time); });
}

std::optional<double> Results::mean_ratio(const std::string& scene,
                                          const std::string& integrator) const {
  return mean_over_seeds(scene, integrator, [](const Measurement& m) { return m.mean_ratio; });
}

std::optional<double> Results::passes(const std::string& scene,
                                      const std::string& integrator) const {
  return mean_over_seeds(scene, integrator, [](const Measurement& m) { return double(m.passes); });
}

std::optional<double> Results::reference_relmse(const std::string& scene) const {
  for (const Measurement& m : newest_)
    if (m.scene == scene && !std::isnan(m.reference_relmse)) return m.reference_relmse;
  return std::nullopt;
}

std::string headline_of(const Results& results) {
  return results.has("auto") ? "auto" : "photonmap";
}

std::string error_table(const Results& results) {
  const std::string headline = headline_of(results);
  std::vector<std::string> header{"scene", "s"};
  for (const std::string& integrator : results.integrators()) header.push_back(integrator);
  header.push_back("best of path, bdpt, ppm, vcm / " + headline);
  header.push_back("path / " + headline);
  header.emplace_back("reference's own");
  MarkdownTable table(header);
  GeometricMean to_best, to_path;
  for (const std::string& scene : results.scenes()) {
    const double time = results.last_time(scene);
    std::vector<std::string> row{scene, fmt::format("{:g}", time)};
    for (const std::string& integrator : results.integrators())
      row.push_back(cell(results.relmse(scene, integrator, time)));
    const std::optional<double> ours = results.relmse(scene, headline, time);
    const std::optional<double> best_ratio = ratio(best_of_four(results, scene, time), ours);
    const std::optional<double> path_ratio = ratio(results.relmse(scene, "path", time), ours);
    to_best.add(best_ratio);
    to_path.add(path_ratio);
    row.push_back(cell(best_ratio, "{:.3g}"));
    row.push_back(cell(path_ratio, "{:.3g}"));
    row.push_back(cell(results.reference_relmse(scene)));
    table.add(row);
  }
  std::vector<std::string> means{"geometric mean", ""};
  means.resize(2 + results.integrators().size());
  means.push_back(cell(to_best.value(), "{:.3g}"));
  means.push_back(cell(to_path.value(), "{:.3g}"));
  table.add(means);
  return table.text();
}

std::string early_table(const Results& results) {
  const std::string headline = headline_of(results), rival = "photonmap";
  if (headline == rival || !results.has(rival)) return {};
  MarkdownTable table({"scene", "s", rival, headline, rival + " / " + headline, "ahead"});
  GeometricMean mean;
  for (const std::string& scene : results.scenes()) {
    const double time = results.times(scene).front();
    const auto theirs = results.relmse(scene, rival, time),
               ours = results.relmse(scene, headline, time);
    const std::optional<double> gain = ratio(theirs, ours);
    if (!gain) continue;
    mean.add(gain);
    table.add({scene, fmt::format("{:g}", time), cell(theirs), cell(ours), cell(gain, "{:.3g}"),
               *gain < 1 ? rival : headline});
  }
  table.add({"geometric mean", "", "", "", cell(mean.value(), "{:.3g}"), ""});
  return table.text();
}

std::string ablation_table(const Results& results) {
  if (results.variants().empty()) return {};
  std::vector<std::string> header{"scene", "s"};
  for (const std::string& variant : results.variants()) header.push_back(variant);
  MarkdownTable table(header);
  std::vector<GeometricMean> means(results.variants().size());
  for (const std::string& scene : results.scenes()) {
    // Devices may have been measured for less time than integrators.
    std::vector<double> times = results.times(scene);
    const auto has_variant = [&](double time) {
      return std::any_of(
          results.variants().begin(), results.variants().end(),
          [&](const std::string& variant) { return results.relmse(scene, variant, time); });
    };
    while (!times.empty() && !has_variant(times.back())) times.pop_back();
    if (times.empty()) continue;
    const double time = times.back();
    std::vector<std::string> row{scene, fmt::format("{:g}", time)};
    bool is_measured = false;
    for (size_t i = 0; i < results.variants().size(); ++i) {
      const std::string& variant = results.variants()[i];
      const std::string whole = type_of(variant);
      const std::optional<double> error =
          ratio(results.relmse(scene, variant, time), results.relmse(scene, whole, time));
      const std::optional<double> cost =
          ratio(results.passes(scene, whole), results.passes(scene, variant));
      means[i].add(error);
      is_measured = is_measured || error;
      row.push_back(cell(error, "{:.3g}") + " (" + cell(cost) + ")");
    }
    if (is_measured) table.add(row);
  }
  std::vector<std::string> last{"geometric mean", ""};
  for (const GeometricMean& mean : means) last.push_back(cell(mean.value(), "{:.3g}"));
  table.add(last);
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

std::string peer_table(const Results& results) {
  const std::string headline = headline_of(results);
  std::optional<MarkdownTable> table;
  GeometricMean to_best;
  for (const std::string& name : results.scenes()) {
    const BenchScene scene = bench_scene(name);
    if (!scene.is_peer()) continue;
    if (!table) {
      std::vector<std::string> header{"scene", "s"};
      for (const PeerFigure& peer : scene.peers) header.push_back(peer.renderer);
      for (const char* title : {"best of them", "Kaustik "}) header.emplace_back(title);
      header.back() += headline;
      header.push_back("best of them / " + headline);
      table.emplace(header);
    }
    const double time = time_beside_peers(results, name);
    std::vector<std::string> row{name, fmt::format("{:g}", time)};
    std::vector<std::optional<double>> figures;
    for (const PeerFigure& peer : scene.peers) {
      figures.emplace_back(peer.relmse);
      row.push_back(cell(peer.relmse));
    }
    const std::optional<double> best = smallest(figures),
                                ours = results.relmse(name, headline, time);
    to_best.add(ratio(best, ours));
    for (const std::optional<double>& value : {best, ours}) row.push_back(cell(value));
    row.push_back(cell(ratio(best, ours), "{:.3g}"));
    table->add(row);
  }
  if (!table) return {};
  const size_t figures = bench_scene("peer_ring").peers.size();
  std::vector<std::string> means{"geometric mean"};
  means.resize(2 + figures + 2);
  means.push_back(cell(to_best.value(), "{:.3g}"));
  table->add(means);
  return table->text();
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
