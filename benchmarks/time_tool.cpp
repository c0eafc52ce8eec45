// How well renders keep to the time that they are given, reading the scene included:
//   time_tool [--size N] [NAME ...]   scenes, integrators and times by name ("10s"); all without
// Prints the time asked for, the time taken, when the first picture, or look, was there for a
// snapshot, the passes and the share of another one, and the processor time over the threads (what
// a machine takes that does nothing else, if all is parallel).
#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "kaustik/integrator/override_integrator.h"
#include "kaustik/integrator/registry.h"
#include "kaustik/loader/scene_format.h"
#include "kaustik/render/job.h"
#include "kaustik/scene/overrides.h"

namespace {

using namespace kaustik;
using Clock = std::chrono::steady_clock;

const std::filesystem::path scenes_folder = std::string(KAUSTIK_SOURCE_DIR) + "/scenes";
constexpr double all_times[] = {10, 5, 1};

std::vector<std::string> shipped_scene_names() {
  std::set<std::string> names;
  for (const auto& folder : std::filesystem::directory_iterator(scenes_folder)) {
    const std::string name = folder.path().filename();
    if (std::filesystem::exists(folder.path() / (name + ".xml"))) names.insert(name);
  }
  return {names.begin(), names.end()};
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

struct Asked {
  std::string scene, integrator;
  double seconds = 0;
  int size = 800;
};

void measure(const Asked& asked) {
  const Clock::time_point start = Clock::now();
  const double processor_before = processor_seconds();
  const auto processor_since = [&] {
    return (processor_seconds() - processor_before) / std::thread::hardware_concurrency();
  };
  Description description =
      load_scene((scenes_folder / asked.scene / (asked.scene + ".xml")).string());
  override_integrator(description, asked.integrator);
  override_property(description, fmt::format("film.width={}", asked.size));
  override_property(description, fmt::format("film.height={}", asked.size));
  JobSettings settings;
  settings.clock_start = start;
  settings.session.seconds = asked.seconds;
  settings.previews = true;
  Job job(std::move(description), std::move(settings));
  std::atomic<bool> ended = false;
  double first_picture = 0, first_processor = 0;
  std::thread viewer([&] {
    while (!job.snapshot() && !ended) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    first_picture = seconds_since(start);
    first_processor = processor_since();
  });
  const SessionReport report = job.run().report;
  const double taken = seconds_since(start), processor = processor_since();
  ended = true;
  viewer.join();
  fmt::print(
      "{:15} {:11} {:5g} s  taken {:6.2f} s ({:6.2f})  first picture {:6.2f} s ({:6.2f})  "
      "{:3} passes of {} + {:.2f}{}\n",
      asked.scene, asked.integrator, asked.seconds, taken, processor, first_picture,
      first_processor, report.passes, report.samples_per_pass, report.part,
      report.passes == 0       ? ", a first look"
      : report.incomplete_pass ? ", not finished"
                               : "");
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::set<std::string> names;
  Asked asked;
  for (int i = 1; i < argc; ++i)
    if (std::string(argv[i]) == "--size" && i + 1 < argc)
      asked.size = std::stoi(argv[++i]);
    else
      names.insert(argv[i]);
  std::vector<std::string> scenes, integrators;
  std::vector<double> times;
  for (const std::string& name : shipped_scene_names())
    if (names.contains(name)) scenes.push_back(name);
  for (const kaustik::IntegratorType& type : kaustik::integrator_types())
    if (names.contains(type.info.name)) integrators.push_back(type.info.name);
  for (const double seconds : all_times)
    if (names.contains(fmt::format("{:g}s", seconds))) times.push_back(seconds);
  if (scenes.empty()) scenes = shipped_scene_names();
  if (integrators.empty()) integrators = {"auto", "path", "photonmap", "vcm", "ppm", "lighttracer"};
  if (times.empty()) times.assign(std::begin(all_times), std::end(all_times));
  for (const std::string& scene : scenes)
    for (const std::string& integrator : integrators)
      for (const double seconds : times) {
        asked.scene = scene;
        asked.integrator = integrator;
        asked.seconds = seconds;
        measure(asked);
      }
  return 0;
}
