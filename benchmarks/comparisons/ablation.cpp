#include "benchmarks/comparisons/ablation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "benchmarks/markdown_table.h"
#include "kaustik/base/statistics.h"

namespace kaustik::bench {
namespace {

constexpr double least_gain = 1.1, most_harm = 0.95;

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

/// "guiding=false" of "auto:guiding=false".
std::string setting_of(const std::string& variant) {
  return variant.substr(variant.rfind(setting_separator) + 1);
}

/// "auto" of that, "" of "auto".
std::string whole_of(const std::string& variant) {
  const size_t at = variant.rfind(setting_separator);
  return at == std::string::npos ? std::string() : variant.substr(0, at);
}

double last_error(const Measurement& m) {
  const std::optional<double> error = m.relmse_at(m.seconds.back());
  return error ? *error : std::nan("");
}

/// Without the reference's noise; NaN: too much of it is noise.
double own_error(const Measurement& m) {
  const double error = last_error(m);
  const double noise = std::isnan(m.reference_relmse) ? 0 : m.reference_relmse;
  return noise > error / 2 ? std::nan("") : error - noise;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / double(values.size());
}

std::string text_of(const Worth& worth) {
  return std::isfinite(worth.factor)
             ? fmt::format("{:.2f} ± {:.0f} %", worth.ratio, 100 * (worth.factor - 1))
             : fmt::format("{:.2f}", worth.ratio);
}

/// Which of the worths is at an end of the range, as text.
std::string text_of(const std::string& scene, const Worth& worth) {
  return fmt::format("{}: {}", scene, text_of(worth));
}

}  // namespace

Ablation::Ablation(const std::vector<Measurement>& in_order) {
  for (const Measurement& m : in_order) {
    if (!m.by_cpu_time) continue;
    add_once(scenes_, m.scene);
    std::erase_if(newest_, [&](const Measurement& old) {
      return old.scene == m.scene && old.integrator == m.integrator && old.seed == m.seed;
    });
    newest_.push_back(m);
  }
  const auto is_measured = [&](const std::string& integrator) {
    return std::any_of(newest_.begin(), newest_.end(),
                       [&](const Measurement& m) { return m.integrator == integrator; });
  };
  for (const Measurement& m : newest_)
    add_once(is_measured(whole_of(m.integrator)) ? variants_ : wholes_, m.integrator);
}

const Measurement* Ablation::find(const std::string& scene, const std::string& integrator,
                                  uint64_t seed) const {
  const auto found = std::find_if(newest_.begin(), newest_.end(), [&](const Measurement& m) {
    return m.scene == scene && m.integrator == integrator && m.seed == seed;
  });
  return found == newest_.end() ? nullptr : &*found;
}

std::optional<std::vector<double>> Ablation::logarithms(const std::string& scene,
                                                        const std::string& variant) const {
  std::vector<double> result;
  for (const Measurement& without : newest_) {
    if (without.scene != scene || without.integrator != variant) continue;
    const Measurement* with = find(scene, whole_of(variant), without.seed);
    if (!with || with->seconds.back() != without.seconds.back()) continue;
    result.push_back(std::log(own_error(without) / own_error(*with)));
    // Without this seed the others would be those that went badly.
    if (!std::isfinite(result.back())) return std::nullopt;
  }
  if (result.empty()) return std::nullopt;
  return result;
}

std::optional<Worth> Ablation::worth(const std::string& scene, const std::string& variant) const {
  const auto own = logarithms(scene, variant);
  if (!own) return std::nullopt;
  Worth worth;
  double squares = 0;
  for (const std::string& each : variants_) {
    const auto seeds = logarithms(scene, each);
    if (!seeds || whole_of(each) != whole_of(variant)) continue;
    const double mean = mean_of(*seeds);
    for (const double l : *seeds) squares += (l - mean) * (l - mean);
    worth.freedom += double(seeds->size() - 1);
  }
  worth.ratio = std::exp(mean_of(*own));
  worth.factor = worth.freedom > 0
                     ? std::exp(std::sqrt(squares / worth.freedom / double(own->size())))
                     : std::numeric_limits<double>::infinity();
  return worth;
}

std::optional<double> Ablation::reference_share(const std::string& scene) const {
  double error = 0, noise = std::nan("");
  int count = 0;
  for (const Measurement& m : newest_)
    if (m.scene == scene &&
        std::find(wholes_.begin(), wholes_.end(), m.integrator) != wholes_.end()) {
      error += last_error(m);
      noise = m.reference_relmse;
      ++count;
    }
  if (count == 0 || std::isnan(noise)) return std::nullopt;
  return noise / (error / count);
}

std::string verdict_of(const std::vector<Worth>& on_scenes) {
  bool helps = false, may_help = false, harms = false, may_harm = false;
  // One-sided, so that all scenes are right at once in 95 % of cases.
  const double quantile = std::pow(0.95, 1 / double(std::max<size_t>(1, on_scenes.size())));
  for (const Worth& worth : on_scenes) {
    const double margin = worth.freedom > 0
                              ? std::pow(worth.factor, student_t_quantile(quantile, worth.freedom))
                              : std::numeric_limits<double>::infinity();
    helps |= worth.ratio / margin >= least_gain;
    may_help |= worth.ratio * margin >= least_gain;
    harms |= worth.ratio * margin < most_harm;
    may_harm |= worth.ratio / margin < most_harm;
  }
  return fmt::format("{}, {}",
                     helps      ? "helps"
                     : may_help ? "whether it helps can't be told"
                                : "does not help",
                     harms      ? "harms"
                     : may_harm ? "whether it harms can't be told"
                                : "does not harm");
}

std::string worth_table(const Ablation& ablation) {
  std::vector<std::string> header{"scene"};
  for (const std::string& variant : ablation.variants()) header.push_back(setting_of(variant));
  header.emplace_back("reference's own error over that with all");
  MarkdownTable table(header);
  for (const std::string& scene : ablation.scenes()) {
    std::vector<std::string> row{scene};
    for (const std::string& variant : ablation.variants()) {
      const std::optional<Worth> worth = ablation.worth(scene, variant);
      row.push_back(worth ? text_of(*worth) : "–");
    }
    const std::optional<double> share = ablation.reference_share(scene);
    row.push_back(share ? fmt::format("{:.2g}", *share) : "–");
    table.add(row);
  }
  return table.text();
}

std::string verdict_table(const Ablation& ablation) {
  MarkdownTable table({"setting", "most", "least", "geometric mean", "the device"});
  for (const std::string& variant : ablation.variants()) {
    std::vector<std::pair<std::string, Worth>> known;
    for (const std::string& scene : ablation.scenes())
      if (const std::optional<Worth> worth = ablation.worth(scene, variant))
        known.emplace_back(scene, *worth);
    if (known.empty()) continue;
    const auto [least, most] = std::minmax_element(
        known.begin(), known.end(),
        [](const auto& a, const auto& b) { return a.second.ratio < b.second.ratio; });
    double sum = 0;
    std::vector<Worth> worths;
    for (const auto& [scene, worth] : known) {
      sum += std::log(worth.ratio);
      worths.push_back(worth);
    }
    table.add({setting_of(variant), text_of(most->first, most->second),
               text_of(least->first, least->second),
               fmt::format("{:.2f}", std::exp(sum / double(known.size()))), verdict_of(worths)});
  }
  return table.text();
}

}  // namespace kaustik::bench
