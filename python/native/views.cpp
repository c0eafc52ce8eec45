// Views in browsers: the server of `kaustik view`.
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <thread>

#include "bind.h"
#include "kaustik/base/version.h"
#include "kaustik/view/view_server.h"

namespace kaustik::python {
namespace {

/// As many as nobody waits for.
constexpr uint32_t endless_passes = 1'000'000;

/// No thread of the server's calls Python.
class PythonView {
 public:
  PythonView(const DescribedScene& scene, std::string name, const std::string& integrator,
             uint16_t port, int threads, std::string output_folder)
      : process_(getpid()) {
    view::ViewSettings settings;
    settings.scene = std::move(name);
    settings.engine.recipe.integrator = integrator;
    settings.engine.recipe.is_strict = scene.description->is_strict;
    const int available = int(std::thread::hardware_concurrency());
    settings.engine.session.threads = available > 0 ? std::min(threads, available) : threads;
    settings.engine.session.passes = endless_passes;
    settings.port = port;
    settings.output_folder = std::move(output_folder);
    const auto keep = [this](const std::string& sentence) {
      const std::lock_guard lock(mutex_);
      messages_.push_back(sentence);
    };
    const py::gil_scoped_release released;
    server_ = std::make_unique<view::ViewServer>(copy_of(*scene.description), settings,
                                                 Messages{keep, keep});
    url_ = server_->url();
    port_ = server_->port();
  }
  ~PythonView() {
    // In a forked process the threads that are to be waited for are not there.
    if (process_ != getpid())
      (void)server_.release();
    else
      stop();
  }

  void stop() {
    const py::gil_scoped_release released;
    server_.reset();
  }
  bool is_running() const { return server_ != nullptr; }
  const std::string& url() const { return url_; }
  uint16_t port() const { return port_; }
  std::vector<std::string> messages() const {
    const std::lock_guard lock(mutex_);
    return messages_;
  }

 private:
  pid_t process_;
  mutable std::mutex mutex_;  ///< of what follows
  std::vector<std::string> messages_;
  std::string url_;
  uint16_t port_ = 0;
  /// Last: its threads use what is above.
  std::unique_ptr<view::ViewServer> server_;
};

}  // namespace

void bind_views(py::module_& module) {
  py::class_<PythonView>(module, "View")
      .def(py::init<const DescribedScene&, std::string, const std::string&, uint16_t, int,
                    std::string>())
      .def("stop", &PythonView::stop)
      .def_property_readonly("is_running", &PythonView::is_running)
      .def_property_readonly("url", &PythonView::url)
      .def_property_readonly("port", &PythonView::port)
      .def_property_readonly("messages", &PythonView::messages);
}

}  // namespace kaustik::python
