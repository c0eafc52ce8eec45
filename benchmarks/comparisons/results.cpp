#include "benchmarks/comparisons/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace kaustik::bench {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (!contains(names, name)) names.push_back(name);
}

/// In the order in which methods are told of, those that are not in it last.
void sort_integrators(std::vector<std::string>& names) {
  static const std::vector<std::string> order{"path", "bdpt", "ppm", "vcm", "photonmap", "auto"};
  std::stable_sort(names.begin(), names.end(), [&](const std::string& a, const std::string& b) {
    return std::find(order.begin(), order.end(), a) < std::find(order.begin(), order.end(), b);
  });
}

}  // namespace

std::string letter_of(size_t build) {
  return build < 26 ? std::string(1, char('A' + build)) : fmt::format("A{}", build);
}

Results::Results(const std::vector<Measurement>& in_order) {
  for (const Measurement& m : in_order) {
    if (type_of(m.integrator) != m.integrator) continue;
    add_once(scenes_, m.scene);
    add_once(integrators_, m.integrator);
    std::erase_if(newest_, [&](const Measurement& old) {
      return old.scene == m.scene && old.integrator == m.integrator && old.seed == m.seed;
    });
    newest_.push_back(m);
  }
  sort_integrators(integrators_);
  for (const Measurement& m : newest_) add_once(builds_, m.program);
}

bool Results::has(const std::string& integrator) const {
  return contains(integrators_, integrator);
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

std::optional<double> Results::seconds_per_pass(const std::string& scene,
                                                const std::string& integrator) const {
  return mean_over_seeds(scene, integrator, [](const Measurement& m) -> std::optional<double> {
    if (m.passes == 0) return std::nullopt;
    return m.seconds.back() / m.passes;
  });
}

std::optional<double> Results::newest_of(
    const std::string& scene, const std::function<double(const Measurement&)>& value) const {
  for (auto m = newest_.rbegin(); m != newest_.rend(); ++m)
    if (m->scene == scene && !std::isnan(value(*m))) return value(*m);
  return std::nullopt;
}

std::optional<double> Results::reference_relmse(const std::string& scene) const {
  return newest_of(scene, [](const Measurement& m) { return m.reference_relmse; });
}

std::optional<double> Results::reference_mean_ratio(const std::string& scene) const {
  return newest_of(scene, [](const Measurement& m) { return m.reference_mean_ratio; });
}

bool Results::has_one_reference(const std::string& scene) const {
  std::set<std::string> references;
  for (const Measurement& m : newest_)
    if (m.scene == scene) references.insert(m.inputs.substr(m.inputs.rfind(' ') + 1));
  return references.size() <= 1;
}

int Results::seed_count(const std::string& scene, const std::string& integrator,
                        double time) const {
  return int(std::count_if(newest_.begin(), newest_.end(), [&](const Measurement& m) {
    return m.scene == scene && m.integrator == integrator && m.relmse_at(time);
  }));
}

std::string Results::builds_of(const std::string& scene,
                               const std::vector<std::string>& integrators) const {
  std::string letters;
  for (size_t i = 0; i < builds_.size(); ++i)
    if (std::any_of(newest_.begin(), newest_.end(), [&](const Measurement& m) {
          return m.scene == scene && m.program == builds_[i] && contains(integrators, m.integrator);
        }))
      letters += (letters.empty() ? "" : ", ") + letter_of(i);
  return letters;
}

std::string headline_of(const Results& results) {
  return results.has("auto") ? "auto" : "photonmap";
}

}  // namespace kaustik::bench
