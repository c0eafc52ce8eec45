// Views in browsers: the server of `kaustik view`.
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <mutex>

#include "bind.h"
#include "jobs.h"
#include "kaustik/base/processors.h"
#include "kaustik/base/version.h"
#include "kaustik/render/prepared_scene.h"
#include "kaustik/view/view_server.h"

namespace kaustik::python {
namespace {

/// As many as nobody waits for.
constexpr uint32_t endless_passes = 1'000'000;

/// What the view is of, and how it is to be reached.
struct ViewWishes {
  std::string name, integrator;
  uint16_t port = 0;
  int threads = 0;
  std::string output_folder;
  uint64_t seed = 0;
};

view::ViewSettings settings_for(const DescribedScene& scene, const ViewWishes& wishes) {
  view::ViewSettings settings;
  settings.scene = wishes.name;
  settings.engine.recipe.integrator = wishes.integrator;
  settings.engine.recipe.is_strict = scene.description->is_strict;
  settings.engine.session.threads = std::min(wishes.threads, usable_processors());
  settings.engine.session.passes = endless_passes;
  settings.engine.session.seed = wishes.seed;
  settings.port = wishes.port;
  settings.output_folder = wishes.output_folder;
  return settings;
}

/// No thread of the server's calls Python.
class PythonView {
 public:
  /// Renders by itself, unless it `is_of_session`: then show() tells what is seen.
  PythonView(const DescribedScene& scene, const ViewWishes& wishes, bool is_of_session)
      : process_(getpid()), integrator_(wishes.integrator) {
    const view::ViewSettings settings = settings_for(scene, wishes);
    const auto keep = [this](const std::string& sentence) {
      const std::lock_guard lock(mutex_);
      messages_.push_back(sentence);
    };
    const Messages messages{keep, keep};
    const py::gil_scoped_release released;
    Description description = copy_of(*scene.description);
    if (is_of_session) {
      jobs_ = std::make_shared<WatchedJobs>();
      server_ = std::make_shared<view::ViewServer>(view::ShownSession{jobs_, controls()},
                                                   std::move(description), settings, messages);
    } else {
      server_ = std::make_shared<view::ViewServer>(std::move(description), settings, messages);
    }
    url_ = server_->url();
    port_ = server_->port();
  }

  /// Of a session: it renders that scene by this job now.
  void show(const std::shared_ptr<LiveJob>& job, const DescribedScene& scene) {
    const py::gil_scoped_release released;
    std::shared_ptr<view::ViewServer> server;
    {
      const std::lock_guard lock(mutex_);
      job_ = job;
      server = server_;
    }
    if (!jobs_ || !server) return;
    const uint64_t revision = jobs_->show(std::shared_ptr<const Job>(job, &job->job()),
                                          [live = job.get()] { return live->course(); });
    Description description = copy_of(*scene.description);
    RenderRecipe recipe;
    recipe.integrator = integrator_;
    apply_changes(description, recipe, {});
    server->session_renders(revision, std::move(description));
  }
  ~PythonView() {
    // In a forked process the threads that are to be waited for are not there.
    if (process_ != getpid())
      (void)new std::shared_ptr(std::move(server_));  // never freed
    else
      stop();
  }

  void stop() {
    const py::gil_scoped_release released;
    std::shared_ptr<view::ViewServer> server;  // ends without the lock: its threads take it
    {
      const std::lock_guard lock(mutex_);
      server.swap(server_);
    }
  }
  bool is_running() const {
    const std::lock_guard lock(mutex_);
    return server_ != nullptr;
  }
  const std::string& url() const { return url_; }
  uint16_t port() const { return port_; }
  std::vector<std::string> messages() const {
    const std::lock_guard lock(mutex_);
    return messages_;
  }

 private:
  view::SessionControls controls() {
    return {[this] { with_job([](LiveJob& job) { job.pause(); }); },
            [this] { with_job([](LiveJob& job) { job.resume(); }); },
            [this] { with_job([](LiveJob& job) { job.request_stop(); }); },
            [this](const RegionRequest& request) {
              bool is_taken = false;
              with_job([&](LiveJob& job) { is_taken = job.refine(request); });
              return is_taken;
            }};
  }
  template <typename Call>
  void with_job(const Call& call) {
    std::shared_ptr<LiveJob> job;
    {
      const std::lock_guard lock(mutex_);
      job = job_;
    }
    if (job) call(*job);
  }

  pid_t process_;
  std::string integrator_;
  std::shared_ptr<WatchedJobs> jobs_;  ///< null: it is of no session
  mutable std::mutex mutex_;           ///< of what follows
  std::vector<std::string> messages_;
  std::shared_ptr<LiveJob> job_;
  std::string url_;
  uint16_t port_ = 0;
  /// Last: its threads use what is above.
  std::shared_ptr<view::ViewServer> server_;
};

}  // namespace

void bind_views(py::module_& module) {
  py::class_<PythonView>(module, "View")
      .def(py::init([](const DescribedScene& scene, std::string name, std::string integrator,
                       uint16_t port, int threads, std::string output_folder, uint64_t seed,
                       bool is_of_session) {
        return std::make_unique<PythonView>(scene,
                                            ViewWishes{std::move(name), std::move(integrator), port,
                                                       threads, std::move(output_folder), seed},
                                            is_of_session);
      }))
      .def("show", &PythonView::show)
      .def("stop", &PythonView::stop)
      .def_property_readonly("is_running", &PythonView::is_running)
      .def_property_readonly("url", &PythonView::url)
      .def_property_readonly("port", &PythonView::port)
      .def_property_readonly("messages", &PythonView::messages);
}

}  // namespace kaustik::python
