// How soon a camera's move is seen, and how many pictures a second, through the HTTP of `kaustik
// view` on this machine, at 640 × 480.
#include <atomic>
#include <nlohmann/json.hpp>
#include <thread>

#include "benchmarks/report.h"
#include "benchmarks/shipped_scenes.h"
#include "kaustik/scene/overrides.h"
#include "kaustik/view/view_server.h"
#include "tests/view/http_client.h"

namespace {

using namespace kaustik;
using nlohmann::json;

constexpr int moves = 48;
/// s, and frames per s
constexpr double slowest_frame = 0.15, fewest_frames = 5;
constexpr double orbit_s = 6, moves_per_s = 30;

class Viewer {
 public:
  explicit Viewer(const view::ViewServer& server) : port_(server.port()), client_(port_) {
    const std::string body = json{{"token", server.token()}}.dump();
    cookie_ = ask("POST", "/session", body).header("set-cookie");
    cookie_ = cookie_.substr(0, cookie_.find(';'));
  }
  Viewer(const Viewer& other) : port_(other.port_), client_(port_), cookie_(other.cookie_) {}

  test::ClientResponse ask(const std::string& method, const std::string& target,
                           const std::string& body = "") {
    std::string text = method + " " + target + " HTTP/1.1\r\nHost: localhost\r\n";
    if (!cookie_.empty()) text += "Cookie: " + cookie_ + "\r\n";
    if (!body.empty())
      text += "Content-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) +
              "\r\n";
    client_.send(text + "\r\n" + body);
    return client_.response();
  }
  uint64_t move(const json& camera) {
    const auto response = ask("POST", "/command", json{{"camera", camera}}.dump());
    return json::parse(response.body).value("revision", uint64_t(0));
  }
  /// The next frame.
  test::ClientResponse frame(uint64_t after) {
    return ask("GET", "/frame?format=rgb9e5&after=" + std::to_string(after));
  }

 private:
  uint16_t port_;
  test::HttpClient client_;
  std::string cookie_;
};

uint64_t number_in(const test::ClientResponse& response, const char* header) {
  const std::string text = response.header(header);
  return text.empty() ? 0 : std::stoull(text);
}

/// The camera turned about the vertical axis through what it looks at.
json turned(json camera, double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  const double x = camera["origin"][0].get<double>() - camera["target"][0].get<double>();
  const double y = camera["origin"][1].get<double>() - camera["target"][1].get<double>();
  camera["origin"][0] =
      camera["target"][0].get<double>() + std::cos(angle) * x - std::sin(angle) * y;
  camera["origin"][1] =
      camera["target"][1].get<double>() + std::sin(angle) * x + std::cos(angle) * y;
  return camera;
}

view::ViewSettings settings_of(const std::string& scene) {
  view::ViewSettings settings;
  settings.scene = scene;
  settings.engine.session.is_endless = true;
  return settings;
}

Description described(const std::string& scene) {
  Description description = bench::load_shipped(scene);
  for (const char* assignment : {"film.width=640", "film.height=480"})
    override_property(description, assignment);
  return description;
}

/// From the moment that a move is sent to the whole of the picture by the scene's integrator, one
/// after the other.
void measure_moves(const std::string& scene, Viewer& viewer, const json& camera) {
  uint64_t number = 0;
  std::vector<double> seconds;
  for (int i = 0; i < moves; ++i) {
    const auto start = std::chrono::steady_clock::now();
    const uint64_t revision = viewer.move(turned(camera, 1.0 * i));
    while (true) {
      const auto frame = viewer.frame(number);
      if (frame.status != 200) continue;
      number = number_in(frame, "x-number");
      if (number_in(frame, "x-revision") == revision && frame.header("x-kind") != "preview") break;
    }
    // The first has to trace the photons.
    if (i > 0) seconds.push_back(bench::seconds_since(start));
  }
  const double worst = *std::max_element(seconds.begin(), seconds.end());
  bench::report(fmt::format("view_move/{}", scene), slowest_frame / bench::median(seconds), "x",
                fmt::format("{:g} ms over the median of {} moves, {:.3g} ms; longest {:.3g} ms",
                            1000 * slowest_frame, seconds.size(), 1000 * bench::median(seconds),
                            1000 * worst),
                {.bar = 1});
}

/// Pictures of different views that come while the camera is dragged around.
void measure_orbit(const std::string& scene, Viewer& viewer, const json& camera) {
  std::atomic<bool> ends = false;
  std::thread drag([&, mover = std::make_unique<Viewer>(viewer)] {
    auto next = std::chrono::steady_clock::now();
    for (int i = 0; !ends; ++i) {
      mover->move(turned(camera, 1.0 * i));
      next += std::chrono::microseconds(int64_t(1e6 / moves_per_s));
      std::this_thread::sleep_until(next);
    }
  });
  uint64_t number = 0, revision = 0;
  int views = 0;
  double longest = 0;
  const auto start = std::chrono::steady_clock::now();
  auto last = start;
  while (bench::seconds_since(start) < orbit_s) {
    const auto frame = viewer.frame(number);
    if (frame.status != 200) continue;
    number = number_in(frame, "x-number");
    if (number_in(frame, "x-revision") == revision || frame.header("x-kind") == "preview") continue;
    revision = number_in(frame, "x-revision");
    ++views;
    longest = std::max(longest, bench::seconds_since(last));
    last = std::chrono::steady_clock::now();
  }
  const double per_s = views / bench::seconds_since(start);
  ends = true;
  drag.join();
  bench::report(fmt::format("view_orbit/{}", scene), per_s / fewest_frames, "x",
                fmt::format("{:.3g} views a second over {:g}; longest pause {:.3g} ms", per_s,
                            fewest_frames, 1000 * longest),
                {.bar = 1});
}

}  // namespace

int main() {
  for (const std::string scene : {"metal_ring", "cornell_spheres"}) {
    const view::ViewServer server(described(scene), settings_of(scene));
    Viewer viewer(server);
    while (viewer.frame(0).status != 200) {
    }
    const json camera = json::parse(viewer.ask("GET", "/state").body)["camera"];
    measure_moves(scene, viewer, camera);
    measure_orbit(scene, viewer, camera);
  }
}
