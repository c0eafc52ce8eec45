#include "meter_values.h"

#include <cmath>
#include <string>
#include <vector>

#include "events.h"
#include "kaustik/render/measurements.h"
#include "screen.h"

namespace kaustik::app {
namespace {

/// Half the interval over the value from which on it is worth a warning.
constexpr double wide = 0.1;

bool is_wide(const Measurement& one) { return !(one.half_width <= wide * std::abs(one.value)); }

JsonObject facts_of(const Measurement& one, const std::string& unit) {
  JsonObject facts;
  facts.add("x", double(one.position.x)).add("y", double(one.position.y));
  facts.add("z", double(one.position.z));
  return facts.add("value", one.value).add("half_width", one.half_width).add("unit", unit);
}

/// "299.0330 ± 0.0013", "7500 ± 5200": both to the second digit of half the interval.
std::string interval_text(const Measurement& one) {
  if (!std::isfinite(one.half_width)) return fmt::format("{:.6g} ± unknown", one.value);
  constexpr double least_share = 1e-9;
  if (!(one.half_width > least_share * std::abs(one.value)))
    return fmt::format("{:.6g} ± {:.2g}", one.value, one.half_width);
  const int exponent = int(std::floor(std::log10(one.half_width))) - 1;
  const double step = std::pow(10.0, exponent);
  const auto rounded = [&](double number) { return std::round(number / step) * step; };
  return fmt::format("{0:.{2}f} ± {1:.{2}f}", rounded(one.value), rounded(one.half_width),
                     std::max(0, -exponent));
}

void print_values(const std::vector<Measurement>& list, const std::string& quantity,
                  const std::string& unit, uint32_t passes) {
  const std::string known = fmt::format("95 % confidence, {} passes", passes);
  if (list.size() == 1) return say("{}: {} {} ({})", quantity, interval_text(list[0]), unit, known);
  say("{} in {} ({}):", quantity, unit, known);
  say("{:>10} {:>10} {:>10}  {}", "x", "y", "z", unit);
  for (const Measurement& one : list)
    say("{:10.4g} {:10.4g} {:10.4g}  {}", one.position.x, one.position.y, one.position.z,
        interval_text(one));
}

void warn_of_wide(const std::vector<Measurement>& list) {
  size_t count = 0;
  for (const Measurement& one : list) count += is_wide(one);
  if (count == 0) return;
  const std::string which = list.size() == 1
                                ? "the interval of the value is"
                                : fmt::format("{} of {} intervals are", count, list.size());
  warn(
      fmt::format("{} wider than ± {:g} %: render longer (--time, --passes), or until it is known "
                  "well enough: --error 2%",
                  which, 100 * wide));
}

}  // namespace

void tell_measurements(const Scene& scene, const Film& film, bool quiet) {
  const std::string& unit = scene.camera().traits().meter_unit;
  const std::vector<Measurement> list = measurements(scene, film);
  for (const Measurement& one : list) events().measured(facts_of(one, unit));
  if (!quiet)
    print_values(list, unit == "lx" ? "illuminance" : "luminance", unit, film.pass_count());
  warn_of_wide(list);
}

}  // namespace kaustik::app
