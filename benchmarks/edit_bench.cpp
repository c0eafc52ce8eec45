// How soon a render lets go when its scene is edited, and how soon there is something to be seen of
// the new scene, at 640 × 480.
#include <thread>

#include "benchmarks/report.h"
#include "benchmarks/shipped_scenes.h"
#include "kaustik/integrator/override_integrator.h"
#include "kaustik/live/engine.h"
#include "kaustik/scene/overrides.h"

namespace {

using namespace kaustik;

constexpr int moments = 16;
/// s
constexpr double slowest = 0.05, longest_wait = 2.5, slowest_frame = 0.15;

Description described(const std::string& scene, const std::string& integrator) {
  Description description = bench::load_shipped(scene);
  for (const char* assignment : {"film.width=640", "film.height=480"})
    override_property(description, assignment);
  override_integrator(description, integrator);
  return description;
}

/// From the moment that a render is abandoned, as edits do, to the return of its last thread, at
/// moments from its begin on.
void measure_cancelling(const std::string& scene, const std::string& integrator) {
  std::vector<double> seconds;
  for (int i = 0; i < moments; ++i) {
    JobSettings settings;
    settings.session.is_endless = true;
    settings.previews = true;
    Job job(described(scene, integrator), std::move(settings));
    job.prepare();
    job.start();
    std::this_thread::sleep_for(std::chrono::duration<double>(longest_wait * (i + 0.5) / moments));
    seconds.push_back(bench::seconds_of([&] {
      job.abandon();
      job.wait();
    }));
  }
  const double worst = *std::max_element(seconds.begin(), seconds.end());
  bench::report(fmt::format("cancel/{}/{}", scene, integrator), slowest / worst, "x",
                fmt::format("{:g} ms over the longest of {} waits, {:.3g} ms; median {:.3g} ms",
                            1000 * slowest, moments, 1000 * worst, 1000 * bench::median(seconds)),
                {.bar = 1});
}

/// From an edit to the first picture of the new scene.
void measure_first_picture(const std::string& scene, const std::string& integrator) {
  EngineSettings settings;
  settings.session.is_endless = true;
  settings.session.layers = false;
  Engine engine(settings);
  engine.edit(described(scene, integrator));
  engine.start();
  uint64_t number = 0;
  std::vector<double> previews, samples;
  for (int i = 0; i < moments; ++i) {
    Description next = described(scene, integrator);
    const auto start = std::chrono::steady_clock::now();
    const uint64_t revision = engine.edit(std::move(next));
    bool has_preview = false;
    while (const auto snapshot = engine.wait_for_snapshot(number, std::chrono::minutes(1))) {
      number = snapshot->number;
      if (snapshot->revision != revision) continue;
      if (!has_preview) previews.push_back(bench::seconds_since(start));
      has_preview = true;
      if (snapshot->kind == Snapshot::Kind::preview) continue;
      samples.push_back(bench::seconds_since(start));
      break;
    }
  }
  bench::report(fmt::format("first_picture/{}/{}", scene, integrator), bench::median(previews), "s",
                fmt::format("the first samples after {:.3g} s", bench::median(samples)));
}

/// The scene with its camera turned about the vertical axis through what it looks at.
Description turned(const Description& description, double degrees) {
  Description next = copy_of(description);
  for (const Child& child : next.scene->children) {
    if (child.object->family != "sensor") continue;
    for (Property& property : child.object->properties)
      if (property.name == "to_world")
        property.value =
            Transform::rotate({0, 0, 1}, degrees) * std::get<Transform>(property.value);
  }
  return next;
}

/// While the camera goes around, with the photons kept: from each move to the picture by photons,
/// the next move after that.
void measure_orbit(const std::string& scene) {
  EngineSettings settings;
  settings.session.is_endless = true;
  settings.session.layers = false;
  settings.snapshot_interval_s = 0;
  settings.moving = recipe_of_moving_views();
  Engine engine(settings);
  const Description description = described(scene, "auto");
  engine.edit(description);
  engine.start();
  uint64_t number = 0;
  std::vector<double> seconds;
  for (int i = 0; i < 3 * moments; ++i) {
    const auto start = std::chrono::steady_clock::now();
    const uint64_t revision = engine.edit(turned(description, 1.0 * i));
    while (const auto snapshot = engine.wait_for_snapshot(number, std::chrono::minutes(1))) {
      number = snapshot->number;
      if (snapshot->revision != revision || snapshot->kind == Snapshot::Kind::preview) continue;
      // The first has to trace them.
      if (i > 0) seconds.push_back(bench::seconds_since(start));
      break;
    }
  }
  const double worst = *std::max_element(seconds.begin(), seconds.end());
  bench::report(fmt::format("orbit/{}", scene), slowest_frame / bench::median(seconds), "x",
                fmt::format("{:g} ms over the median of {} moves, {:.3g} ms; longest {:.3g} ms",
                            1000 * slowest_frame, seconds.size(), 1000 * bench::median(seconds),
                            1000 * worst),
                {.bar = 1});
}

}  // namespace

int main() {
  for (const std::string scene : {"metal_ring", "cornell_spheres"}) measure_orbit(scene);

  for (const std::string scene : {"metal_ring", "cornell_spheres", "museum"})
    for (const std::string integrator : {"path", "photonmap", "auto"}) {
      measure_cancelling(scene, integrator);
      measure_first_picture(scene, integrator);
    }
}
