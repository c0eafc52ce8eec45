#include "benchmarks/comparisons/timed_renders.h"

#include <sys/resource.h>

namespace kaustik::bench {
namespace {

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

Image colors_of(const Image& image) {
  const std::vector<std::string> names = {"R", "G", "B"};
  Image result(image.width(), image.height(), names);
  for (int c = 0; c < int(names.size()); ++c) {
    const int channel = image.find_channel(names[size_t(c)]);
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x) result.at(x, y, c) = image.at(x, y, channel);
  }
  return result;
}

/// Adds the render that ends after `seconds`.
void add_render(TimedRenders& result, double seconds, const Scene& scene,
                const Integrator& integrator, SessionSettings settings, const Image& reference) {
  settings.seconds = seconds;
  Session session(scene, integrator, settings);
  const SessionReport report = session.run();
  result.seconds_taken.push_back(report.seconds);
  result.pictures.emplace_back();
  result.passes = report.incomplete_pass ? 0 : report.passes;
  result.samples_per_pass = report.samples_per_pass;
  result.last = {};
  if (session.film().pass_count() == 0) return;
  const Image picture = session.image(false);
  result.pictures.back() = compare_images(picture, reference);
  result.last = colors_of(picture);
}

}  // namespace

TimedRenders render_for(const std::vector<double>& times, const Scene& scene,
                        const IntegratorMaker& make_integrator, const SessionSettings& settings,
                        const Image& reference) {
  TimedRenders result;
  double cpu = 0, taken = 0;
  for (const double seconds : times) {
    const double cpu_before = cpu_seconds();
    const auto integrator = make_integrator();
    add_render(result, seconds, scene, *integrator, settings, reference);
    cpu += cpu_seconds() - cpu_before;
    taken += result.seconds_taken.back();
  }
  result.cpu_share = cpu / (taken * std::max(1, settings.threads));
  return result;
}

}  // namespace kaustik::bench
