// The tables that tell what becomes of bars.
#include <algorithm>

#include "benchmarks/comparisons/bench_scene.h"
#include "benchmarks/comparisons/table_cells.h"
#include "benchmarks/comparisons/tables.h"
#include "benchmarks/markdown_table.h"

namespace kaustik::bench {
namespace {

/// Of the headline's error over the least of four, on each scene that ships and on average over
/// at least so many.
constexpr double scene_bar = 1.3, mean_bar = 1.1;
constexpr int least_scenes = 6;

const std::vector<std::string> four{"path", "bdpt", "ppm", "vcm"};

struct Best {
  std::string name;
  double relmse = 0;
};

/// Of those integrators; nothing unless all were measured.
std::optional<Best> best_of(const Results& results, const std::vector<std::string>& integrators,
                            const std::string& scene, double time) {
  Best best;
  for (const std::string& integrator : integrators) {
    const std::optional<double> error = results.relmse(scene, integrator, time);
    if (!error) return std::nullopt;
    if (best.name.empty() || *error < best.relmse) best = {integrator, *error};
  }
  return best;
}

/// Why a bar cannot be applied to a scene that ships; "" if it can.
std::string hindrance(const Results& results, const std::string& scene,
                      const std::vector<std::string>& integrators) {
  if (results.last_time(scene) != bar_seconds) return fmt::format("not at {:g} s", bar_seconds);
  for (const std::string& integrator : integrators)
    if (results.seed_count(scene, integrator, bar_seconds) < bar_seeds)
      return fmt::format("fewer than {} seeds", bar_seeds);
  return {};
}

/// What becomes of a bar: why it cannot be applied, or its verdict.
std::string outcome(const std::string& hindrance, const Verdict& verdict) {
  return hindrance.empty() ? text_of(verdict) : hindrance;
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

/// The headline's error over the best of four, gathered scene by scene.
class BestTable {
 public:
  explicit BestTable(const Results& results)
      : results_(results),
        headline_(headline_of(results)),
        table_({"scene", "s", "best of four", "its relative MSE", headline_, headline_ + " / best",
                "without the reference's noise", "bar", "kept?"}) {}

  void add(const std::string& scene) {
    const double time = results_.last_time(scene);
    const std::optional<Best> best = best_of(results_, four, scene, time);
    const std::optional<double> ours = results_.relmse(scene, headline_, time);
    std::vector<std::string> row{scene, fmt::format("{:g}", time), "–", "–", cell(ours)};
    if (best && ours) {
      const auto measured = measured_ratio(ours, best->relmse),
                 noiseless = noiseless_ratio(ours, best->relmse, results_.reference_relmse(scene));
      row[2] = best->name;
      row[3] = cell(best->relmse);
      for (const auto& ratio : {measured, noiseless}) row.push_back(cell(ratio));
      all_.add(measured, noiseless);
      if (!bench_scene(scene).is_peer() && noiseless) apply_bar(scene, measured, *noiseless, row);
    }
    row.resize(9, "–");
    table_.add(row);
  }

  std::string text() {
    const std::optional<ErrorRatio> mean = shipped_.noiseless.value();
    std::string kept = "–";
    if (shipped_.noiseless.count() < least_scenes)
      kept = fmt::format("fewer than {} scenes", least_scenes);
    else if (mean)
      kept = outcome(mean_hindrance_, at_most(*mean, mean_bar));
    table_.add({fmt::format("geometric mean of {} that ship", shipped_.noiseless.count()), "", "",
                "", "", cell(shipped_.measured.value()), cell(mean), fmt::format("{:g}", mean_bar),
                kept});
    if (all_.measured.count() > shipped_.measured.count())
      table_.add({fmt::format("geometric mean of all {}", all_.measured.count()), "", "", "", "",
                  cell(all_.measured.value()), cell(all_.noiseless.value()), "–", "–"});
    return table_.text();
  }

 private:
  struct Means {
    void add(const std::optional<ErrorRatio>& as_measured,
             const std::optional<ErrorRatio>& without_noise) {
      measured.add(as_measured);
      noiseless.add(without_noise);
    }
    GeometricMean measured, noiseless;
  };

  void apply_bar(const std::string& scene, const std::optional<ErrorRatio>& measured,
                 const ErrorRatio& noiseless, std::vector<std::string>& row) {
    std::vector<std::string> compared = four;
    compared.push_back(headline_);
    const std::string why_not = hindrance(results_, scene, compared);
    if (!why_not.empty()) mean_hindrance_ = why_not;
    shipped_.add(measured, noiseless);
    row.push_back(fmt::format("{:g}", scene_bar));
    row.push_back(outcome(why_not, at_most(noiseless, scene_bar)));
  }

  const Results& results_;
  const std::string headline_;
  MarkdownTable table_;
  Means shipped_, all_;
  std::string mean_hindrance_;  ///< of the last scene that has one
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
      kept =
          outcome(hindrance(results, scene, {"path", headline}), at_least(*noiseless, known.bar));
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
