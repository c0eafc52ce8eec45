// How well renders keep to the time that they are given, reading the scene included:
//   time_tool [--size N] [NAME ...]   scenes, integrators and times by name ("10s"); all without
// Prints the time asked for and when the render ended; when there was a first look (a preview, or
// samples of some pixels), a first picture in which each pixel has a sample, and a first whole
// pass; the passes and the share of another one. In brackets the processor time over the threads
// (what a machine takes that does nothing else, if all is parallel). "-": there was none. Looking
// takes a fifth of a thread until there is a picture, and may miss by four times what it takes.
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "kaustik/base/processors.h"
#include "kaustik/integrator/override_integrator.h"
#include "kaustik/integrator/registry.h"
#include "kaustik/loader/scene_format.h"
#include "kaustik/render/job.h"
#include "kaustik/render/part_picture.h"
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

/// Since the begin of a render, s.
struct Moment {
  double wall = 0, processor = 0;
};

class Stopwatch {
 public:
  Clock::time_point start() const { return start_; }
  Moment now() const {
    return {seconds_since(start_), (processor_seconds() - processor_before_) / processors_};
  }

 private:
  Clock::time_point start_ = Clock::now();
  double processor_before_ = processor_seconds();
  int processors_ = usable_processors();
};

std::string text_of(const std::optional<Moment>& moment) {
  return moment ? fmt::format("{:6.2f} s ({:6.2f})", moment->wall, moment->processor)
                : fmt::format("{:>17}", "-");
}

/// Looks at a job until there is a picture.
class Viewer {
 public:
  Viewer(const Job& job, const Stopwatch& stopwatch)
      : job_(job), stopwatch_(stopwatch), thread_([this](const std::stop_token& ended) {
          while (!picture_ && !ended.stop_requested()) {
            const Clock::time_point begin = Clock::now();
            look();
            std::this_thread::sleep_for(std::max<Clock::duration>(std::chrono::milliseconds(2),
                                                                  4 * (Clock::now() - begin)));
          }
        }) {}
  /// After the job's.
  void end() {
    thread_.request_stop();
    thread_.join();
    if (!picture_) look();
  }
  // After end().
  const std::optional<Moment>& first_look() const { return look_; }
  const std::optional<Moment>& first_picture() const { return picture_; }

 private:
  void look() {
    const std::optional<Image> image = job_.snapshot();
    if (image && !look_) look_ = stopwatch_.now();
    if (image && !image->find_metadata(incomplete_key)) picture_ = stopwatch_.now();
  }

  const Job& job_;
  const Stopwatch& stopwatch_;
  std::optional<Moment> look_, picture_;
  std::jthread thread_;
};

struct Asked {
  std::string scene, integrator;
  double seconds = 0;
  int size = 800;
};

void measure(const Asked& asked) {
  const Stopwatch stopwatch;
  Description description =
      load_scene((scenes_folder / asked.scene / (asked.scene + ".xml")).string());
  override_integrator(description, asked.integrator);
  override_property(description, fmt::format("film.width={}", asked.size));
  override_property(description, fmt::format("film.height={}", asked.size));
  JobSettings settings;
  settings.clock_start = stopwatch.start();
  settings.session.seconds = asked.seconds;
  settings.previews = true;
  std::optional<Moment> first_pass;
  JobListener listener;
  listener.pass_done = [&](const Film&) {
    if (!first_pass) first_pass = stopwatch.now();
  };
  Job job(std::move(description), std::move(settings), listener);
  Viewer viewer(job, stopwatch);
  const SessionReport report = job.run().report;
  const Moment end = stopwatch.now();
  viewer.end();
  fmt::print(
      "{:15} {:11} {:5g} s asked, ended {}  first look {}  picture {}  pass {}  {:3} passes of {} "
      "+ {:.2f}{}\n",
      asked.scene, asked.integrator, asked.seconds, text_of(end), text_of(viewer.first_look()),
      text_of(viewer.first_picture()), text_of(first_pass), report.passes, report.samples_per_pass,
      report.part,
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
