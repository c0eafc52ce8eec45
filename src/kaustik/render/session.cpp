#include "kaustik/render/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "kaustik/base/parallel.h"
#include "kaustik/integrator/foreign_integrators.h"
#include "kaustik/integrator/make_integrator.h"
#include "kaustik/render/pass_wavelengths.h"
#include "kaustik/render/session_monitor.h"
#include "kaustik/render/session_team.h"
#include "kaustik/scene/scene_report.h"

namespace kaustik {
namespace {

/// Fewer tell too little of the error.
constexpr uint32_t least_passes = 4;
/// A pass that takes more than the integrator's default samples takes no more than that times this,
/// and no more than so many in all: the time until the next picture, and the light paths that are
/// kept, grow with them.
constexpr uint32_t most_times_default = 4;
constexpr uint64_t most_samples_of_pass = uint64_t(1) << 22;
/// Of pictures that there is less time for passes have fewer samples in proportion: light passes
/// are shorter then.
constexpr double pixels_per_second = 1 << 16;

uint32_t divided_up(uint32_t a, uint32_t b) { return a / b + (a % b > 0 ? 1 : 0); }

}  // namespace

Session::Session(const Scene& scene, const Integrator& integrator, const SessionSettings& settings)
    : Session(scene, integrator, settings,
              Film(scene.film(),
                   FilmLayers::of(integrator, settings.layers && scene.film().layers,
                                  scene.camera().traits().are_pixels_apart()),
                   integrator.traits().splats)) {}

Session::Session(const Scene& scene, const Integrator& integrator, const SessionSettings& settings,
                 Film begun)
    : scene_(scene),
      integrator_(integrator),
      settings_(settings),
      film_(std::move(begun)),
      splats_(integrator.traits().splats ? SplatBuffer(scene.film(), integrator.traits().components)
                                         : SplatBuffer::nowhere()),
      pass_({film_.width(), film_.height()}),
      is_finished_(pass_.tiles().count()),
      tile_mutexes_(std::make_unique<std::mutex[]>(pass_.tiles().count())),
      has_picture_(film_.pass_count() > 0) {
  for (const FilmRegion& region : film_.regions())
    regions_.push_back({region.pixels, region.film.pass_count(), 0});
  plan();
  for (const RegionRequest& request : settings_.regions) ask_for(request);
}

Session::~Session() = default;

uint32_t Session::most_samples_per_pass() const {
  const uint64_t usual = integrator_.traits().default_samples_per_pass;
  return uint32_t(
      std::clamp<uint64_t>(most_samples_of_pass / std::max<uint64_t>(1, film_.pixel_count()), usual,
                           most_times_default * usual));
}

uint32_t Session::samples_by_time() const {
  const uint32_t usual = integrator_.traits().default_samples_per_pass;
  if (settings_.keeps_passes) return usual;
  // A pass that can't be taken in parts.
  if (!integrator_.traits().samples_camera) return 1;
  const double pixels = double(std::max<size_t>(1, film_.pixel_count()));
  return uint32_t(
      std::clamp(usual * *settings_.seconds * pixels_per_second / pixels, 1.0, double(usual)));
}

void Session::plan() {
  plan_picture();
  if (settings_.part) take_part(*settings_.part);
}

void Session::take_part(const PassPart& part) {
  if (pass_count_ < part.count)
    throw Error(ErrorKind::input,
                fmt::format("{} passes cannot be divided into {} parts", pass_count_, part.count),
                "ask for fewer parts, or for more passes");
  division_ = {planned(), part.count};
  const PassRange own = division_.part(part.index);
  settings_.first_pass = own.begin;
  pass_count_ = own.end - own.begin;
}

void Session::plan_picture() {
  const uint32_t by_integrator = integrator_.traits().default_samples_per_pass;
  if (settings_.is_endless) {
    samples_per_pass_ = settings_.samples_per_pass.value_or(by_integrator);
    pass_count_ = 0;
    return;
  }
  std::optional<uint32_t> samples = settings_.samples_per_pixel;
  // Else passes alone end it.
  const bool is_open = !settings_.part && (settings_.seconds || settings_.error);
  if (!samples && !is_open && scene_.film().sample_count > 0)
    samples = uint32_t(scene_.film().sample_count);
  if (settings_.samples_per_pass) {
    samples_per_pass_ = *settings_.samples_per_pass;
    if (samples) pass_count_ = divided_up(*samples, samples_per_pass_);
    if (settings_.passes) pass_count_ = *settings_.passes;
    if (pass_count_ == 0 && !is_open) pass_count_ = default_passes;
    return;
  }
  if (samples) {
    // A limit of time or error is kept to by passes that are as short as they would be without a
    // number of samples.
    const uint32_t most = is_open ? by_integrator : most_samples_per_pass();
    const uint32_t usual =
        is_open ? 1 : std::clamp(divided_up(*samples, by_integrator), least_passes, default_passes);
    pass_count_ = settings_.passes.value_or(std::max(usual, divided_up(*samples, most)));
    pass_count_ = std::min(pass_count_, *samples);
    samples_per_pass_ = divided_up(*samples, std::max(1u, pass_count_));
    if (!settings_.passes) pass_count_ = divided_up(*samples, samples_per_pass_);
  } else {
    const bool is_by_time = is_open && settings_.seconds && !settings_.passes;
    samples_per_pass_ = is_by_time ? samples_by_time() : by_integrator;
    pass_count_ = settings_.passes.value_or(is_open ? 0 : default_passes);
  }
}

PassRange Session::planned() const {
  return {settings_.first_pass, settings_.first_pass + pass_count_};
}

bool Session::is_good_enough(double error) const {
  const uint32_t passes = film_.pass_count();
  const bool looks = passes >= replicate_count && std::has_single_bit(passes);
  return settings_.error && looks && error <= *settings_.error;
}

std::optional<SessionEnd> Session::end_before(uint32_t index, const Monitor& monitor) const {
  if (is_good_enough(monitor.error())) return SessionEnd::error;
  if (pass_count_ > 0 && index >= planned().end) return SessionEnd::passes;
  // A part of it will do, with a sample of each pixel.
  if (settings_.seconds && monitor.passes_done() > 0 &&
      monitor.elapsed() + monitor.least_pass_seconds() > *settings_.seconds)
    return SessionEnd::time;
  return std::nullopt;
}

SessionEnd Session::run_alone(const std::stop_token& stop, Monitor& monitor,
                              const std::function<void()>& pass_done) {
  uint32_t next = film_.passes().first_missing(settings_.first_pass);
  std::optional<SessionEnd> end = end_before(next, monitor);
  const auto cut_short = [&] {
    return stop.stop_requested() ? SessionEnd::cancelled : SessionEnd::time;
  };
  while (true) {
    if (end != SessionEnd::time && render_regions(stop, monitor, pass_done) != PassEnd::complete)
      end = cut_short();
    if (end && close_regions(*end)) return *end;
    if (end) continue;
    const Pass pass = pass_of(next);
    if (stop.stop_requested() || render_pass({pass, {}}, stop, monitor) != PassEnd::complete)
      return cut_short();
    monitor.pass_done();
    if (pass_done) pass_done();
    next = film_.passes().first_missing(next);
    end = end_before(next, monitor);
  }
}

SessionReport Session::run(std::stop_token stop,
                           const std::function<void(const Progress&)>& progress,
                           const std::function<void()>& pass_done) {
  {
    const std::lock_guard lock(picture_mutex_);
    report_ = {};
    report_.samples_per_pass = samples_per_pass_;
  }
  const uint64_t refused_before = scene_.tracer().refused_rays();
  {
    const std::lock_guard lock(regions_mutex_);
    takes_regions_ = !settings_.team;
  }
  // What throws ends it, too.
  struct Closing {
    Session& session;
    ~Closing() { session.close_regions(SessionEnd::cancelled); }
  } const closing{*this};
  Monitor monitor(*this, progress);
  with_threads(settings_.threads, [&] {
    report_.end = settings_.team ? TeamRun(*this, monitor, stop, pass_done).run()
                                 : run_alone(stop, monitor, pass_done);
  });
  report_.passes = film_.pass_count();
  report_.regional_passes = film_.regional_pass_count();
  // What it takes to tell the error, over all pixels, would keep those waiting who abandoned it.
  if (is_follower() || (is_pass_abandoned_ && report_.cancelled())) {
    report_.mean_error = report_.picture_error = std::numeric_limits<double>::infinity();
  } else {
    with_threads(settings_.threads, [&] {
      report_.mean_error = film_.mean_error();
      // Of regions that still wait the last passes may not be in it.
      report_.picture_error = next_region() ? film_.picture_error() : monitor.error();
    });
  }
  report_.rays = monitor.rays;
  report_.photons = monitor.photons;
  report_.dropped_samples = monitor.dropped + splats_.dropped();
  report_.seconds = monitor.elapsed();
  report_.light_seconds = monitor.light_seconds;
  if (report_.dropped_samples > 0)
    report_.warnings.push_back(
        fmt::format("{} samples were not finite and were left out", report_.dropped_samples));
  if (const uint64_t refused = scene_.tracer().refused_rays() - refused_before)
    report_.warnings.push_back(refused_rays_warning(refused));
  monitor.tell(Progress::Stage::done, true);
  return report_;
}

Pass Session::pass_of(uint32_t index) const {
  return {settings_.seed, index, samples_per_pass_,
          wavelengths_of_pass(scene_.film(), integrator_.traits(), settings_.seed, index,
                              samples_per_pass_)};
}

std::string integrator_type(const Description& description, const Scene& scene) {
  if (const std::shared_ptr<Object> given = find_integrator(description))
    return native_type(*given);
  for (uint32_t i = 0; i < scene.surface_count(); ++i)
    if (scene.surface(i).illumination) return "photonmap";
  return default_integrator;
}

std::unique_ptr<Integrator> make_integrator(const Description& description, const Scene& scene,
                                            std::vector<std::string>& warnings) {
  const std::shared_ptr<Object> given = find_integrator(description);
  const Object default_object{"integrator", integrator_type(description, scene), "", {}, {}, {}};
  return make_integrator(given ? *given : default_object, scene, warnings, description.is_strict);
}

}  // namespace kaustik
