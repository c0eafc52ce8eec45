#include "kaustik/render/session.h"

#include <fmt/format.h>

#include <unistd.h>
#include <bit>
#include <chrono>
#include <fstream>
#include <mutex>
#include <numeric>

#include "kaustik/base/parallel.h"
#include "kaustik/integrator/make_integrator.h"
#include "kaustik/scene/scene_report.h"

namespace kaustik {
namespace {

constexpr int tile_size = 16;
constexpr uint32_t default_passes = 16;
/// Fewer tell too little of the error.
constexpr uint32_t least_passes = 4;

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Samples of a pixel that are summed before their sum is added to the others: a float would lose
/// single ones in a sum of millions. Stop requests are looked at in between.
constexpr uint32_t samples_per_block = 256;

/// Returns how many components were not finite and left out.
int add_sample(const SampleSink& sink, PassPixel& sum) {
  int dropped = 0;
  std::array<Spectrum, component_count> finite{};
  for (int c = 0; c < component_count; ++c) {
    const Spectrum& radiance = sink.radiance(Component(c));
    if (radiance.is_finite())
      sum.radiance[size_t(c)] += finite[size_t(c)] = radiance;
    else
      ++dropped;
  }
  const std::array<float, noise_kinds> values = by_noise_kind(finite);
  for (size_t k = 0; k < noise_kinds; ++k) sum.squares[k] += sqr(values[k]);
  if (sink.bias().is_finite())
    sum.bias += sink.bias();
  else
    ++dropped;
  const FirstHit& hit = sink.first_hit();
  if (!hit.albedo.is_finite() || !is_finite(hit.normal) || !std::isfinite(hit.depth))
    return dropped + 1;
  sum.first_hit.albedo += hit.albedo;
  sum.first_hit.normal += hit.normal;
  sum.first_hit.depth += hit.depth;
  return dropped;
}

void add_scaled(const PassPixel& pixel, float scale, PassPixel& sum) {
  for (size_t c = 0; c < size_t(component_count); ++c) sum.radiance[c] += pixel.radiance[c] * scale;
  sum.bias += pixel.bias * scale;
  sum.first_hit.albedo += pixel.first_hit.albedo * scale;
  sum.first_hit.normal += pixel.first_hit.normal * scale;
  sum.first_hit.depth += pixel.first_hit.depth * scale;
  for (size_t k = 0; k < noise_kinds; ++k) sum.squares[k] += pixel.squares[k] * scale;
}

/// Adds those that are not there yet.
void add_new(const std::vector<std::string>& sentences, std::vector<std::string>& all) {
  for (const std::string& sentence : sentences)
    if (std::find(all.begin(), all.end(), sentence) == all.end()) all.push_back(sentence);
}

/// Resident memory of the program, 0 where the system does not tell.
size_t resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  size_t total = 0, resident = 0;
  statm >> total >> resident;
  return resident * size_t(sysconf(_SC_PAGESIZE));
}

}  // namespace

/// Counts what is done and tells the listener now and then.
class Session::Monitor {
 public:
  Monitor(const Session& session, const std::function<void(const Progress&)>& listener)
      : session_(session),
        listener_(listener),
        start_(Clock::now()),
        passes_at_start_(session.film_.pass_count()),
        passes_to_do_(session.film_.passes().missing(session.planned())),
        light_share_(session.integrator_.samples_camera() ? 0.3 : 1),
        error_(session.film_.picture_error()) {}

  void start_pass() {
    pass_start_ = Clock::now();
    tiles_done_ = 0;
    light_done_ = 0;
  }
  void light_pass_at(double share) {
    light_done_ = share;
    tell(Progress::Stage::light, false);
  }
  void light_pass_done(const PassReport& report) {
    light_seconds += seconds_since(pass_start_);
    light_done_ = 1;
    if (passes_done_ == 0 && light_seconds < 0.1) light_share_ = 0;
    rays += report.rays;
    photons += report.photons;
    tell(Progress::Stage::picture, false);
  }
  void tile_done(uint64_t tile_rays) {
    rays += tile_rays;
    ++tiles_done_;
    tell(Progress::Stage::picture, false);
  }
  void pass_done() {
    last_pass_seconds_ = seconds_since(pass_start_);
    ++passes_done_;
    tiles_done_ = 0;
    light_done_ = 0;
    light_share_ = std::min(1.0, light_seconds / std::max(1e-9, elapsed()));
    error_ = session_.film_.picture_error();
    tell(Progress::Stage::light, false);
  }
  uint32_t passes_done() const { return passes_done_; }
  double error() const { return error_; }
  double elapsed() const { return seconds_since(start_); }
  /// Of the last pass: the first may hold plans that are made once, the mean would too.
  double last_pass_seconds() const { return last_pass_seconds_; }

  void tell(Progress::Stage stage, bool force) {
    if (!listener_) return;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock || (!force && told_ && seconds_since(last_) < 0.2)) return;
    told_ = true;
    last_ = Clock::now();
    Progress p;
    p.stage = stage;
    p.elapsed_s = elapsed();
    p.passes_done = passes_at_start_ + passes_done_;
    p.passes_total = session_.pass_count_ == 0 ? 0 : passes_at_start_ + passes_to_do_;
    p.fraction = stage == Progress::Stage::done ? 1 : fraction(p.elapsed_s);
    p.remaining_s = p.fraction > 1e-3 ? p.elapsed_s * (1 / p.fraction - 1) : -1;
    p.rays_per_s = double(rays) / std::max(1e-9, p.elapsed_s);
    p.photons_per_s = light_seconds > 0 ? double(photons) / light_seconds : 0;
    p.memory_bytes = resident_bytes();
    p.relative_error = error_;
    listener_(p);
  }

  std::atomic<uint64_t> rays{0}, photons{0}, dropped{0};
  double light_seconds = 0;

 private:
  /// How many it will take if the error falls with the square root of their number; infinite: not
  /// known yet.
  double passes_for_error() const {
    const double passes = passes_at_start_ + passes_done_;
    const double needed = passes * std::pow(error_ / *session_.settings_.error, 2);
    return std::exp2(std::ceil(std::log2(std::max(double(replicate_count), needed))));
  }
  double fraction(double elapsed_s) const {
    const double tiles = double(session_.tiles_.x) * session_.tiles_.y;
    double f = 0;
    if (passes_to_do_ > 0)
      f = (passes_done_ + light_share_ * light_done_ +
           (1 - light_share_) * double(tiles_done_) / tiles) /
          passes_to_do_;
    if (session_.settings_.error)
      f = std::max(f, (passes_at_start_ + passes_done_) / passes_for_error());
    if (session_.settings_.seconds) f = std::max(f, elapsed_s / *session_.settings_.seconds);
    return std::min(f, 0.999);
  }

  const Session& session_;
  const std::function<void(const Progress&)>& listener_;
  Clock::time_point start_, pass_start_, last_;
  double last_pass_seconds_ = 0;
  bool told_ = false;
  std::mutex mutex_;
  uint32_t passes_at_start_;
  uint32_t passes_to_do_;  ///< 0: limited by time, or nothing is left
  std::atomic<uint32_t> passes_done_{0}, tiles_done_{0};  ///< of this session
  std::atomic<double> light_done_{0};                     ///< of this pass's light pass
  std::atomic<double> light_share_;  ///< of a pass's time; a guess before the first is done
  std::atomic<double> error_;        ///< of the picture
};

Session::Session(const Scene& scene, const Integrator& integrator, const SessionSettings& settings)
    : Session(scene, integrator, settings, Film(scene.film(), FilmLayers::of(integrator))) {}

Session::Session(const Scene& scene, const Integrator& integrator, const SessionSettings& settings,
                 Film begun)
    : scene_(scene),
      integrator_(integrator),
      settings_(settings),
      film_(std::move(begun)),
      splats_(integrator.splats() ? scene.film() : FilmSettings{{1, 1}, {0, 0}, {1, 1}, {}, 0},
              integrator.components()),
      pixels_(size_t(film_.width()) * size_t(film_.height())),
      tiles_((film_.width() + tile_size - 1) / tile_size,
             (film_.height() + tile_size - 1) / tile_size) {
  plan();
}

Session::~Session() = default;

void Session::plan() {
  const uint32_t by_integrator = integrator_.default_samples_per_pass();
  std::optional<uint32_t> samples = settings_.samples_per_pixel;
  const bool is_open = settings_.seconds || settings_.error;  // else passes alone end it
  if (settings_.samples_per_pass) {
    samples_per_pass_ = *settings_.samples_per_pass;
    if (samples) pass_count_ = (*samples + samples_per_pass_ - 1) / samples_per_pass_;
    if (settings_.passes) pass_count_ = *settings_.passes;
    if (pass_count_ == 0 && !is_open) pass_count_ = default_passes;
    return;
  }
  if (!samples && !is_open && scene_.film().sample_count > 0)
    samples = uint32_t(scene_.film().sample_count);
  if (samples) {
    pass_count_ = settings_.passes.value_or(
        std::clamp((*samples + by_integrator - 1) / by_integrator, least_passes, default_passes));
    pass_count_ = std::min(pass_count_, *samples);
    samples_per_pass_ = (*samples + pass_count_ - 1) / std::max(1u, pass_count_);
  } else {
    samples_per_pass_ = by_integrator;
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

bool Session::goes_on(uint32_t index, const std::stop_token& stop, const Monitor& monitor) const {
  if (pass_count_ > 0 && index >= planned().end) return false;
  if (stop.stop_requested() && film_.pass_count() > 0) return false;
  if (is_good_enough(monitor.error())) return false;
  return !settings_.seconds || monitor.passes_done() == 0 ||
         monitor.elapsed() + monitor.last_pass_seconds() <= *settings_.seconds;
}

SessionReport Session::run(std::stop_token stop,
                           const std::function<void(const Progress&)>& progress,
                           const std::function<void()>& pass_done) {
  report_ = {};
  report_.samples_per_pass = samples_per_pass_;
  const uint64_t refused_before = scene_.tracer().refused_rays();
  Monitor monitor(*this, progress);
  with_threads(settings_.threads, [&] {
    for (uint32_t next = film_.passes().first_missing(settings_.first_pass);
         goes_on(next, stop, monitor); next = film_.passes().first_missing(next)) {
      if (!render_pass(next, stop, monitor)) break;
      monitor.pass_done();
      if (pass_done) pass_done();
    }
  });
  report_.cancelled = stop.stop_requested();
  report_.passes = film_.pass_count();
  report_.mean_error = film_.mean_error();
  report_.picture_error = monitor.error();
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

bool Session::render_pass(uint32_t index, std::stop_token stop, Monitor& monitor) {
  monitor.start_pass();
  const Pass pass{settings_.seed, index, samples_per_pass_};
  const bool first = film_.pass_count() == 0;
  if (integrator_.splats()) splats_.clear();
  parallel_blocks(pixels_.size(), 4096, [&](size_t begin, size_t end, size_t) {
    std::fill(pixels_.data() + begin, pixels_.data() + end, PassPixel{});
  });
  monitor.tell(Progress::Stage::light, false);
  const auto state =
      integrator_.prepare(pass, splats_, stop, [&](double share) { monitor.light_pass_at(share); });
  monitor.light_pass_done(state->report);
  add_new(state->report.warnings, report_.warnings);
  add_new(state->report.decisions, report_.decisions);
  if (integrator_.samples_camera() && !stop.stop_requested())
    parallel_blocks(size_t(tiles_.x) * size_t(tiles_.y), 1, [&](size_t tile, size_t, size_t) {
      if (stop.stop_requested()) return;
      render_tile(pass, *state, int(tile), stop, monitor);
    });
  const bool complete = !stop.stop_requested();
  if (!complete && !first) return false;
  if (integrator_.splats()) add_splats();
  film_.add_pass(pixels_, index, samples_per_pass_);
  report_.incomplete_pass = !complete;
  return complete;
}

void Session::render_tile(const Pass& pass, const PassState& state, int tile,
                          const std::stop_token& stop, Monitor& monitor) {
  const int x0 = tile % tiles_.x * tile_size, y0 = tile / tiles_.x * tile_size;
  const int x1 = std::min(x0 + tile_size, film_.width());
  const int y1 = std::min(y0 + tile_size, film_.height());
  uint64_t rays = 0;
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1 && !stop.stop_requested(); ++x)
      rays += render_pixel(pass, state, x, y, stop, monitor);
  monitor.tile_done(rays);
}

uint64_t Session::render_pixel(const Pass& pass, const PassState& state, int x, int y,
                               const std::stop_token& stop, Monitor& monitor) {
  // The address of a pixel is its place in the whole picture, so that a crop window shows the same
  // where nothing is learned from the picture.
  const FilmSettings& film = scene_.film();
  const uint64_t address =
      uint64_t(y + film.crop_offset.y) * uint64_t(film.size.x) + uint64_t(x + film.crop_offset.x);
  const uint32_t replicate = pass.index % replicate_count;
  const PixelSamples samples = integrator_.pixel_samples(state, pass, {x, y});
  uint64_t rays = 0;
  uint32_t done = 0;
  PassPixel sum;
  while (done < samples.count && !(done > 0 && stop.stop_requested())) {
    PassPixel block;
    const uint32_t end = std::min(samples.count, done + samples_per_block);
    for (; done < end; ++done) {
      Sampler sampler =
          Sampler::at(pass.seed, replicate, Stream::camera, address, samples.first_index + done);
      const Vec2f offset = film.filter.sample(sampler.next_2d());
      SampleSink sink(integrator_.components());
      integrator_.sample(state, {float(x) + 0.5f + offset.x, float(y) + 0.5f + offset.y}, sampler,
                         sink);
      rays += sink.rays();
      // Threads would wait for one another if each sample wrote to what they share.
      if (const int dropped = add_sample(sink, block)) monitor.dropped += uint64_t(dropped);
    }
    add_scaled(block, 1, sum);
  }
  PassPixel& pixel = pixels_[size_t(y) * size_t(film_.width()) + size_t(x)];
  add_scaled(sum, 1.0f / float(done), pixel);
  pixel.samples = done;
  return rays;
}

void Session::add_splats() {
  for (int y = 0; y < film_.height(); ++y)
    for (int x = 0; x < film_.width(); ++x) {
      PassPixel& pixel = pixels_[size_t(y) * size_t(film_.width()) + size_t(x)];
      for (int c = 0; c < component_count; ++c)
        if (splats_.wants(Component(c)))
          pixel.radiance[size_t(c)] += splats_.value(x, y, Component(c));
    }
}

std::string integrator_type(const Description& description, const Scene& scene) {
  if (const std::shared_ptr<Object> given = find_integrator(description)) return given->type;
  for (uint32_t i = 0; i < scene.surface_count(); ++i)
    if (scene.surface(i).illumination) return "photonmap";
  return default_integrator;
}

std::unique_ptr<Integrator> make_integrator(const Description& description, const Scene& scene,
                                            std::vector<std::string>& warnings) {
  const std::shared_ptr<Object> given = find_integrator(description);
  const Object default_object{"integrator", integrator_type(description, scene), "", {}, {}, {}};
  return make_integrator(given ? *given : default_object, scene, warnings);
}

}  // namespace kaustik
