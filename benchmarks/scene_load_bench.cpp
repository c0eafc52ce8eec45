// How fast the text of a scene with large meshes is read on one core, beside what limits that on
// the same machine: finding the values of as many numbers in memory by the same function.
//
// "scene-pbrt-text" is from the text in memory to the description, whose meshes hold all vertices
// and faces.
//
// `scene_load_bench [MEGABYTES]`: of text, 100 if it is not told.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <functional>

#include "benchmarks/report.h"
#include "kaustik/base/decimal.h"
#include "kaustik/loader/pbrt_scene.h"

namespace {

using namespace kaustik;

constexpr double speed_bar_mb = 100;
constexpr int repeats = 5;

/// A sheet of waves as an inline mesh, as exporters write it.
std::string sheet(double megabytes) {
  const auto side = int(std::sqrt(megabytes * 1e6 / 70)) + 2;
  std::string text = "WorldBegin\nShape \"trianglemesh\"\n\"integer indices\" [\n";
  for (int y = 0; y + 1 < side; ++y)
    for (int x = 0; x + 1 < side; ++x) {
      const int a = y * side + x, b = a + 1, c = a + side, d = c + 1;
      text += fmt::format("{} {} {} {} {} {}\n", a, b, d, a, d, c);
    }
  text += "]\n\"point3 P\" [\n";
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      text += fmt::format("{:.6f} {:.6f} {:.6f}\n", 0.01 * x, 0.01 * y,
                          0.1 * std::sin(0.03 * x) * std::cos(0.05 * y));
  return text + "]\n";
}

double median_seconds(const std::function<void()>& body) {
  std::vector<double> seconds;
  for (int i = 0; i < repeats; ++i) seconds.push_back(bench::seconds_of(body));
  return bench::median(seconds);
}

/// The sum of all numbers of the text.
double sum_of_numbers(std::string_view text) {
  double sum = 0;
  while (!text.empty()) {
    double number = 0;
    if (take_decimal(text, number))
      sum += number;
    else
      text.remove_prefix(1);
  }
  return sum;
}

}  // namespace

int main(int argc, char** argv) {
  const double megabytes = argc > 1 ? std::atof(argv[1]) : 100;
  if (!(megabytes >= 1)) {
    fmt::print(stderr, "usage: scene_load_bench [MEGABYTES], at least 1\n");
    return 2;
  }
  const std::string text = sheet(megabytes);
  double checked = 0;
  const double limit = median_seconds([&] { checked += sum_of_numbers(text); });
  const double seconds =
      median_seconds([&] { checked += double(parse_pbrt(text, "sheet", "").sources.size()); });
  bench::report("scene-pbrt-text", double(text.size()) / seconds / 1e6, "MB/s",
                fmt::format("{:.0f} MB/s: finding the values of its numbers ({:g})",
                            double(text.size()) / limit / 1e6, checked),
                {speed_bar_mb, 2 * speed_bar_mb});
  return 0;
}
