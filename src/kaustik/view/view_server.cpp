#include "kaustik/view/view_server.h"

#include <fmt/format.h>

#include <atomic>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>

#include "kaustik/render/prepared_scene.h"
#include "kaustik/view/access.h"
#include "kaustik/view/routes.h"
#include "kaustik/view/worker.h"

namespace kaustik::view {
namespace {

constexpr std::chrono::milliseconds tick_interval(100), watch_interval(200);

/// With what a view has in place of what a render has.
EngineSettings for_views(EngineSettings settings) {
  settings.layers_in_snapshots = false;
  if (!settings.moving) settings.moving = recipe_of_moving_views();
  // Changes are made to the description, before those of viewers; these would come after.
  settings.recipe.camera.clear();
  settings.recipe.integrator.clear();
  settings.recipe.settings.clear();
  return settings;
}

/// Which messages were told: each scene that is built tells the same again.
class ToldOnce {
 public:
  bool is_new(const std::string& text) {
    const std::lock_guard lock(mutex_);
    if (told_.size() >= most_) told_.clear();
    return told_.insert(text).second;
  }

 private:
  static constexpr size_t most_ = 1000;
  std::mutex mutex_;
  std::set<std::string> told_;
};

}  // namespace

struct ViewServer::State {
  State(std::optional<ShownSession> session, Description description, ViewSettings settings,
        const Messages& told);
  ~State();
  void watch();
  void log(const char* level, const std::string& text) {
    http.post([this, level, text] {
      if (routes) routes->log(level, text);
    });
  }

  // In this order: what comes later calls what comes before.
  std::string address;
  HttpServer http;
  Access access;
  Worker worker;
  ToldOnce told_once;
  Messages messages;
  Engine engine;
  std::shared_ptr<const Watched> shown;
  std::unique_ptr<Routes> routes;
  std::atomic<bool> ends = false;
  std::thread watcher;
};

ViewServer::State::State(std::optional<ShownSession> session, Description description,
                         ViewSettings settings, const Messages& told)
    : address(settings.address),
      http(settings.address, settings.port, settings.limits),
      access(settings.token.empty() ? random_token() : settings.token, settings.address,
             http.port()),
      messages{[this, told](const std::string& text) {
                 if (!told_once.is_new(text)) return;
                 told.tell(text);
                 log("info", text);
               },
               [this, told](const std::string& text) {
                 if (!told_once.is_new(text)) return;
                 told.warn(text);
                 log("warning", text);
               }},
      engine(for_views(settings.engine), messages),
      shown(session ? session->render : std::make_shared<const WatchedEngine>(engine)) {
  apply_changes(description, settings.engine.recipe, messages);
  Routes::Parts parts{engine,
                      *shown,
                      worker,
                      access,
                      settings.scene,
                      settings.output_folder,
                      [this](std::function<void()> action) { http.post(std::move(action)); },
                      settings.engine.session.seed,
                      settings.engine.session.threads};
  if (session) parts.session = std::move(session->controls);
  routes = std::make_unique<Routes>(std::move(parts), std::move(description));
  http.start(
      [this](HttpRequest request, std::shared_ptr<HttpReply> reply) {
        routes->handle(std::move(request), std::move(reply));
      },
      tick_interval, [this] { routes->tick(); });
  watcher = std::thread([this] { watch(); });
}

ViewServer::State::~State() {
  ends = true;
  if (watcher.joinable()) watcher.join();
  http.stop();
  worker.stop();
  if (routes) routes->clear();
}

/// Tells those who wait for pictures as soon as there is one.
void ViewServer::State::watch() {
  uint64_t last = 0;
  while (!ends) {
    std::shared_ptr<const Snapshot> snapshot;
    try {
      snapshot = shown->wait_for_snapshot(last, watch_interval);
    } catch (const std::exception&) {
      // No memory for the picture: the one before stays, and the next may find some.
      std::this_thread::sleep_for(watch_interval);
    }
    if (!snapshot) continue;
    last = snapshot->number;
    http.post([this] { routes->picture_changed(); });
  }
}

ViewServer::ViewServer(Description description, ViewSettings settings, Messages messages)
    : state_(std::make_unique<State>(std::nullopt, std::move(description), std::move(settings),
                                     messages)) {}

ViewServer::ViewServer(ShownSession session, Description description, ViewSettings settings,
                       Messages messages)
    : state_(std::make_unique<State>(std::move(session), std::move(description),
                                     std::move(settings), messages)) {}

ViewServer::~ViewServer() = default;

uint16_t ViewServer::port() const { return state_->http.port(); }
bool ViewServer::is_local() const { return state_->http.is_local(); }
const std::string& ViewServer::token() const { return state_->access.token(); }
const Engine& ViewServer::engine() const { return state_->engine; }

void ViewServer::session_renders(uint64_t revision, Description description) {
  const auto shared = std::make_shared<Description>(std::move(description));
  state_->http.post([state = state_.get(), revision, shared] {
    if (state->routes) state->routes->session_renders(revision, std::move(*shared));
  });
}

std::string ViewServer::url() const {
  std::string host = state_->address;
  if (host == "0.0.0.0") host = "127.0.0.1";
  if (host == "::") host = "::1";
  if (host.find(':') != std::string::npos) host = "[" + host + "]";
  return fmt::format("http://{}:{}/#token={}", host, port(), token());
}

}  // namespace kaustik::view
