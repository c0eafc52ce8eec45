// The tables that tell what becomes of bars.
#include <algorithm>
#include <map>

#include "benchmarks/comparisons/bench_scene.h"
#include "benchmarks/comparisons/table_cells.h"
#include "benchmarks/comparisons/tables.h"
#include "benchmarks/markdown_table.h"

namespace kaustik::bench {
namespace {

/// Of the headline's error over the least of all others', on each scene that ships and on average
/// over at least so many.
constexpr double scene_bar = 1.15, mean_bar = 1.0;
constexpr int least_scenes = 6;
/// Other methods that have to be measured on a scene; their least error may be compared with then.
constexpr int least_others = 4;

struct Best {
  std::string name;
  double relmse = 0;
};

/// Of the integrators but the headline; nothing if few were measured, or none had a picture.
std::optional<Best> best_other(const Results& results, const std::string& scene, double time) {
  Best best;
  int measured = 0;
  for (const std::string& integrator : results.integrators()) {
    if (integrator == headline_of(results)) continue;
    if (results.seed_count(scene, integrator, time) > 0) ++measured;
    const std::optional<double> error = results.relmse(scene, integrator, time);
    if (error && (best.name.empty() || *error < best.relmse)) best = {integrator, *error};
  }
  if (measured < least_others || best.name.empty()) return std::nullopt;
  return best;
}

PeerFigure best_peer(const BenchScene& scene) {
  return *std::min_element(
      scene.peers.begin(), scene.peers.end(),
      [](const PeerFigure& a, const PeerFigure& b) { return a.relmse < b.relmse; });
}

/// When others' figures are compared: at the time that they had, where ours was looked at then.
double time_beside_peers(const Results& results, const std::string& scene) {
  const std::vector<double> times = results.times(scene);
  const bool looked_then = std::find(times.begin(), times.end(), peer_seconds) != times.end();
  return looked_then ? peer_seconds : times.back();
}

std::string peer_bars(const BenchScene& scene, double time, const ErrorRatio& ratio) {
  if (time != peer_seconds) return fmt::format("not at {:g} s", peer_seconds);
  std::string text = fmt::format("{:g}: {}", scene.bar, text_of(at_least(ratio, scene.bar)));
  if (scene.aim > 0)
    text += fmt::format(" (aim {:g}: {})", scene.aim, text_of(at_least(ratio, scene.aim)));
  return text;
}

/// The headline's error over the least of the others', gathered scene by scene, time by time.
class BestTable {
 public:
  explicit BestTable(const Results& results)
      : results_(results),
        headline_(headline_of(results)),
        table_({"scene", "s", "best other", "its relative MSE", headline_, headline_ + " / best",
                "without the reference's noise", "bar", "kept?"}) {}

  void add(const std::string& scene) {
    for (const double time : results_.times(scene))
      if (const std::optional<Best> best = best_other(results_, scene, time))
        add(scene, time, *best);
  }

  std::string text() {
    for (const auto& [time, means] : means_) {
      const std::optional<ErrorRatio> mean = means.noiseless.value();
      const bool is_enough = mean && means.noiseless.count() >= least_scenes;
      table_.add({fmt::format("geometric mean of {}", means.noiseless.count()),
                  fmt::format("{:g}", time), "", "", "", cell(means.measured.value()), cell(mean),
                  fmt::format("{:g}", mean_bar),
                  is_enough ? text_of(at_most(*mean, mean_bar))
                            : fmt::format("fewer than {} scenes", least_scenes)});
    }
    return table_.text();
  }

 private:
  struct Means {
    GeometricMean measured, noiseless;
  };

  void add(const std::string& scene, double time, const Best& best) {
    const std::optional<double> ours = results_.relmse(scene, headline_, time);
    const auto measured = measured_ratio(ours, best.relmse),
               noiseless = noiseless_ratio(ours, best.relmse, results_.reference_relmse(scene));
    const bool ships = !bench_scene(scene).is_peer();
    if (ships) {
      means_[time].measured.add(measured);
      means_[time].noiseless.add(noiseless);
    }
    const std::string kept = noiseless ? text_of(at_most(*noiseless, scene_bar)) : "no picture";
    table_.add({scene, fmt::format("{:g}", time), best.name, cell(best.relmse), cell(ours),
                cell(measured), cell(noiseless), ships ? fmt::format("{:g}", scene_bar) : "–",
                ships ? kept : "–"});
  }

  const Results& results_;
  const std::string headline_;
  MarkdownTable table_;
  std::map<double, Means> means_;  ///< by the time, over the scenes that ship
};

}  // namespace

std::string best_table(const Results& results) {
  if (!results.has(headline_of(results))) return {};
  BestTable table(results);
  for (const std::string& scene : results.scenes()) table.add(scene);
  return table.text();
}

std::string path_table(const Results& results) {
  const std::string headline = headline_of(results);
  MarkdownTable table({"scene", "s", "path", headline, "path / " + headline,
                       "without the reference's noise", "bar", "kept?"});
  GeometricMean measured_mean, noiseless_mean;
  for (const std::string& scene : results.scenes()) {
    const double time = results.last_time(scene);
    const auto path = results.relmse(scene, "path", time),
               ours = results.relmse(scene, headline, time);
    const auto measured = measured_ratio(path, ours),
               noiseless = noiseless_ratio(path, ours, results.reference_relmse(scene));
    measured_mean.add(measured);
    noiseless_mean.add(noiseless);
    const BenchScene known = bench_scene(scene);
    const bool has_bar = known.bar > 0 && !known.is_peer();
    std::string kept = "–";
    if (has_bar && noiseless)
      kept = time == bar_seconds ? text_of(at_least(*noiseless, known.bar))
                                 : fmt::format("not at {:g} s", bar_seconds);
    table.add({scene, fmt::format("{:g}", time), cell(path), cell(ours), cell(measured),
               cell(noiseless), has_bar ? fmt::format("{:g}", known.bar) : "–", kept});
  }
  table.add({"geometric mean", "", "", "", cell(measured_mean.value()),
             cell(noiseless_mean.value()), "–", "–"});
  return table.text();
}

std::string peer_table(const Results& results) {
  const std::string headline = headline_of(results);
  std::vector<std::string> header{"scene", "s"};
  const size_t figures = bench_scene("peer_ring").peers.size();
  for (const PeerFigure& peer : bench_scene("peer_ring").peers) header.push_back(peer.renderer);
  header.insert(header.end(), {"best of them", "Kaustik " + headline, "best of them / " + headline,
                               "bar", "our reference's mean / theirs"});
  MarkdownTable table(header);
  GeometricMean mean;
  bool is_empty = true;
  for (const std::string& name : results.scenes()) {
    const BenchScene scene = bench_scene(name);
    if (!scene.is_peer()) continue;
    is_empty = false;
    const double time = time_beside_peers(results, name);
    std::vector<std::string> row{name, fmt::format("{:g}", time)};
    for (const PeerFigure& peer : scene.peers) row.push_back(cell(peer.relmse));
    const double best = best_peer(scene).relmse;
    const std::optional<double> ours = results.relmse(name, headline, time);
    const std::optional<ErrorRatio> ratio = measured_ratio(best, ours);
    mean.add(ratio);
    row.insert(row.end(),
               {cell(best), cell(ours), cell(ratio), ratio ? peer_bars(scene, time, *ratio) : "–",
                cell(results.reference_mean_ratio(name), "{:.4f}")});
    table.add(row);
  }
  if (is_empty) return {};
  std::vector<std::string> last{"geometric mean"};
  last.resize(2 + figures + 2);
  last.insert(last.end(), {cell(mean.value()), "–", ""});
  table.add(last);
  return table.text();
}

}  // namespace kaustik::bench
