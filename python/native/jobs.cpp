// Renders that go on in threads of their own. No thread of theirs calls Python: what they tell is
// kept, and Python's thread asks for it.
#include <unistd.h>

#include <array>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>

#include "bind.h"
#include "films.h"
#include "jobs.h"
#include "kaustik/base/processors.h"
#include "kaustik/base/version.h"
#include "kaustik/render/job.h"
#include "kaustik/render/resume.h"

namespace kaustik::python {
namespace {

/// x, y, width, height, passes
using RegionNumbers = std::array<int, 5>;

RegionRequest request_of(const RegionNumbers& numbers) {
  const auto& [x, y, width, height, passes] = numbers;
  return {{x, y, width, height}, uint32_t(std::max(0, passes))};
}

/// What a render is asked for.
struct Wishes {
  std::string integrator;  ///< "": the scene's
  std::optional<uint32_t> passes, spp, samples_per_pass;
  std::optional<double> time, error;
  uint64_t seed = 0;
  int threads = 0;
  uint32_t first_pass = 0;
  bool keeps_passes = false;
  std::vector<RegionNumbers> regions;
  // Of the recipe, for who goes on with a file of the passes.
  std::string scene, folder;
  std::vector<std::pair<std::string, std::string>> definitions;
};

JobSettings job_settings(const Wishes& wishes, const DescribedScene& scene) {
  JobSettings settings;
  settings.session.seed = wishes.seed;
  // More threads than there are at a time only cost.
  settings.session.threads = std::min(wishes.threads, usable_processors());
  settings.session.first_pass = wishes.first_pass;
  settings.session.passes = wishes.passes;
  settings.session.samples_per_pixel = wishes.spp;
  settings.session.samples_per_pass = wishes.samples_per_pass;
  settings.session.seconds = wishes.time;
  settings.session.error = wishes.error;
  settings.session.keeps_passes = wishes.keeps_passes;
  for (const RegionNumbers& region : wishes.regions)
    settings.session.regions.push_back(request_of(region));
  settings.keeps_digest = true;
  settings.previous = scene.built;
  RenderRecord& record = settings.record;
  record.program = KAUSTIK_VERSION;
  RenderRecipe& recipe = record.recipe;
  recipe.scene = wishes.scene;
  recipe.folder = wishes.folder;
  recipe.definitions = wishes.definitions;
  recipe.is_strict = scene.description->is_strict;
  recipe.integrator = wishes.integrator;
  recipe.seed = wishes.seed;
  record.plan = {wishes.first_pass, 0, wishes.time, wishes.error};
  return settings;
}

/// A job and what it has told so far. Only waiting and looking may happen in several threads.
class PythonJob final : public LiveJob {
 public:
  PythonJob(const DescribedScene& scene, const Wishes& wishes, const KeptFilm* begun)
      : gate_(std::make_shared<Gate>()), process_(getpid()) {
    JobSettings settings = job_settings(wishes, scene);
    settings.session.gate = gate_;
    if (begun) {
      settings.begun = *begun->checkpoint;
      settings.begun_path = "the film that goes on";
    }
    settings.clock_start = std::chrono::steady_clock::now();
    const auto keep = [this](const std::string& sentence) {
      const std::lock_guard lock(mutex_);
      messages_.push_back(sentence);
    };
    JobListener listener;
    listener.messages = {keep, keep};
    listener.progress = [this](const Progress& progress) {
      const std::lock_guard lock(mutex_);
      progress_ = progress;
    };
    listener.ended = [this](const std::exception_ptr& failure) {
      {
        const std::lock_guard lock(mutex_);
        failure_ = failure;
        has_ended_ = true;
      }
      ended_.notify_all();
    };
    // A job changes its description.
    job_ = std::make_unique<Job>(copy_of(*scene.description), std::move(settings),
                                 std::move(listener));
  }
  ~PythonJob() override {
    // In a forked process the thread that is to be waited for is not there.
    if (process_ != getpid()) {
      (void)job_.release();
      return;
    }
    gate_->open();
  }

  void start() { job_->start(); }
  void pause() override { gate_->close(); }
  void resume() override { gate_->open(); }
  const Job& job() const override { return *job_; }
  JobCourse course() const override {
    const std::lock_guard lock(mutex_);
    return {progress_.value_or(Progress()), gate_->is_closed(), has_ended_, failure_};
  }
  void request_stop() override {
    job_->cancel();
    gate_->open();
  }
  bool is_paused() const { return gate_->is_closed(); }
  bool has_session() const { return job_->has_session(); }
  bool refine(const RegionRequest& request) override {
    return job_->has_session() && job_->refine(request);
  }
  /// Of each region: x, y, width, height, passes, passes that wait.
  std::vector<std::array<int, 6>> regions() const {
    std::vector<std::array<int, 6>> regions;
    for (const RegionProgress& region : job_->regions())
      regions.push_back({region.pixels.x, region.pixels.y, region.pixels.width,
                         region.pixels.height, int(region.passes), int(region.waiting)});
    return regions;
  }
  void cancel() {
    const py::gil_scoped_release released;
    request_stop();
  }
  bool has_ended() const {
    const std::lock_guard lock(mutex_);
    return has_ended_;
  }
  /// Until it has ended, or for so long: then false. Signals are told to Python's main thread.
  bool wait(double seconds) {
    bool is_over = false;
    {
      const py::gil_scoped_release released;
      std::unique_lock lock(mutex_);
      is_over = ended_.wait_for(lock, std::chrono::duration<double>(seconds),
                                [this] { return has_ended_; });
    }
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    return is_over;
  }
  /// After the end: throws what ended it otherwise.
  void join() {
    const py::gil_scoped_release released;
    job_->wait();
  }
  py::object progress() const {
    std::optional<Progress> now;
    {
      const std::lock_guard lock(mutex_);
      now = progress_;
    }
    if (!now) return py::none();
    static constexpr const char* stages[] = {"light", "picture", "done"};
    py::dict facts;
    facts["stage"] = stages[size_t(now->stage)];
    facts["fraction"] = now->fraction;
    facts["elapsed"] = now->elapsed_s;
    facts["remaining"] = now->remaining_s;
    facts["passes"] = now->passes_done;
    facts["passes_total"] = now->passes_total;
    facts["samples_per_pixel"] = now->samples_per_pixel;
    facts["rays_per_second"] = now->rays_per_s;
    facts["error"] = now->relative_error;
    return facts;
  }
  std::vector<std::string> messages() const {
    const std::lock_guard lock(mutex_);
    return messages_;
  }
  std::optional<Image> snapshot() const {
    const py::gil_scoped_release released;
    return job_->finished_snapshot();
  }
  // After the end:
  Image image() {
    const py::gil_scoped_release released;
    return job_->wait().report.passes > 0 ? job_->finished_image() : job_->snapshot().value();
  }
  KeptFilm film() {
    const py::gil_scoped_release released;
    return {std::make_shared<const Checkpoint>(job_->checkpoint())};
  }
  py::dict report() {
    const SessionReport& report = job_->wait().report;
    static constexpr const char* ends[] = {"passes", "time", "error", "cancelled"};
    py::dict facts;
    facts["end"] = ends[size_t(report.end)];
    facts["passes"] = report.passes;
    facts["samples_per_pass"] = report.samples_per_pass;
    facts["seconds"] = report.seconds;
    facts["light_seconds"] = report.light_seconds;
    facts["rays"] = report.rays;
    facts["photons"] = report.photons;
    facts["dropped_samples"] = report.dropped_samples;
    facts["is_incomplete"] = report.incomplete_pass || report.passes == 0;
    facts["decisions"] = report.decisions;
    facts["warnings"] = report.warnings;
    return facts;
  }

 private:
  std::shared_ptr<Gate> gate_;
  pid_t process_;
  mutable std::mutex mutex_;  ///< of what follows
  std::condition_variable ended_;
  bool has_ended_ = false;
  std::exception_ptr failure_;
  std::optional<Progress> progress_;
  std::vector<std::string> messages_;
  /// Last: its thread uses all of the above.
  std::unique_ptr<Job> job_;
};

Wishes wishes_from(const py::dict& given) {
  Wishes wishes;
  for (const auto& pair : given) {
    const auto name = pair.first.cast<std::string>();
    const auto read = [&](auto& member) {
      member = pair.second.cast<std::remove_reference_t<decltype(member)>>();
    };
    if (name == "integrator")
      read(wishes.integrator);
    else if (name == "passes")
      read(wishes.passes);
    else if (name == "spp")
      read(wishes.spp);
    else if (name == "samples_per_pass")
      read(wishes.samples_per_pass);
    else if (name == "time")
      read(wishes.time);
    else if (name == "error")
      read(wishes.error);
    else if (name == "seed")
      read(wishes.seed);
    else if (name == "threads")
      read(wishes.threads);
    else if (name == "first_pass")
      read(wishes.first_pass);
    else if (name == "keeps_passes")
      read(wishes.keeps_passes);
    else if (name == "regions")
      read(wishes.regions);
    else if (name == "scene")
      read(wishes.scene);
    else if (name == "folder")
      read(wishes.folder);
    else if (name == "definitions")
      read(wishes.definitions);
    else
      throw py::key_error(name);
  }
  return wishes;
}

}  // namespace

void bind_jobs(py::module_& module) {
  py::class_<LiveJob, std::shared_ptr<LiveJob>>(module, "LiveJob");
  py::class_<PythonJob, LiveJob, std::shared_ptr<PythonJob>>(module, "Job")
      .def(py::init([](const DescribedScene& scene, const py::dict& wishes, const KeptFilm* begun) {
             return std::make_shared<PythonJob>(scene, wishes_from(wishes), begun);
           }),
           py::arg("scene"), py::arg("wishes"), py::arg("begun").none(true) = nullptr)
      .def("start", &PythonJob::start)
      .def("pause", &PythonJob::pause)
      .def("resume", &PythonJob::resume)
      .def("cancel", &PythonJob::cancel)
      .def("has_session", &PythonJob::has_session)
      .def("refine", [](PythonJob& job,
                        const RegionNumbers& region) { return job.refine(request_of(region)); })
      .def("regions", &PythonJob::regions)
      .def("wait", &PythonJob::wait)
      .def("join", &PythonJob::join)
      .def("progress", &PythonJob::progress)
      .def("messages", &PythonJob::messages)
      .def("snapshot", &PythonJob::snapshot)
      .def("image", &PythonJob::image)
      .def("film", &PythonJob::film)
      .def("report", &PythonJob::report)
      .def_property_readonly("is_paused", &PythonJob::is_paused)
      .def_property_readonly("has_ended", &PythonJob::has_ended);
}

}  // namespace kaustik::python
