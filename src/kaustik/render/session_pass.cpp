// One pass of a session.
#include <algorithm>
#include <atomic>
#include <limits>

#include "kaustik/base/parallel.h"
#include "kaustik/render/film_parts.h"
#include "kaustik/render/part_picture.h"
#include "kaustik/render/sample_sum.h"
#include "kaustik/render/session.h"
#include "kaustik/render/session_monitor.h"
#include "kaustik/render/watch.h"

namespace kaustik {
namespace {

/// Of the first samples of a first pass one pixel in so many squared gets the first ones, so that
/// there is a picture early.
constexpr int first_stride = 8;

/// Samples, or pixels, between two looks at the clock.
constexpr int samples_per_look = 16;

/// A pass is taken in rounds, so that it may be cut, where so many like the one before would not
/// end in time.
constexpr double passes_ahead = 2;

/// A session without a picture goes on so much longer than it was asked to: a share of that time,
/// and seconds at least.
constexpr double patience = 0.05, least_patience = 0.5;

/// Samples of a pixel that are summed before their sum is added to the others: a float would lose
/// single ones in a sum of millions.
constexpr uint32_t samples_per_block = 256;

void add_scaled(const PassPixel& pixel, float scale, PassPixel& sum) {
  for (size_t c = 0; c < size_t(component_count); ++c) sum.radiance[c] += pixel.radiance[c] * scale;
  sum.bias += pixel.bias * scale;
  sum.first_hit.albedo += pixel.first_hit.albedo * scale;
  sum.first_hit.normal += pixel.first_hit.normal * scale;
  sum.first_hit.depth += pixel.first_hit.depth * scale;
  sum.first_hit.lamps += pixel.first_hit.lamps * scale;
  for (size_t k = 0; k < noise_kinds; ++k) sum.squares[k] += pixel.squares[k] * scale;
}

/// Adds those that are not there yet.
void add_new(const std::vector<std::string>& sentences, std::vector<std::string>& all) {
  for (const std::string& sentence : sentences)
    if (std::find(all.begin(), all.end(), sentence) == all.end()) all.push_back(sentence);
}

}  // namespace

Session::PassEnd Session::render_pass(const Task& task, std::stop_token stop, Monitor& monitor) {
  if (settings_.gate) settings_.gate->pass(stop);
  if (stop.stop_requested()) return PassEnd::discarded;
  monitor.start_pass(task.region);
  const Pass& pass = task.pass;
  clear_pixels(pass, monitor);
  monitor.tell(Progress::Stage::light, false);
  std::stop_source halt;
  const std::stop_callback forward(stop, [&] { halt.request_stop(); });
  const std::optional<double> last = last_second(monitor);
  const auto halt_if_late = [&] {
    if (last && monitor.elapsed() > *last) halt.request_stop();
  };
  // What fails here ends the light pass, which need not come to its end for that.
  const auto look = [&] {
    try {
      halt_if_late();
    } catch (...) {
      halt.request_stop();
      throw;
    }
  };
  const auto state = [&] {
    std::optional<Watch> watch;
    if (last) watch.emplace(look);
    auto prepared = integrator_.prepare(pass, splats_, halt.get_token(), [&](double share) {
      monitor.light_pass_at(share);
      halt_if_late();
    });
    if (watch) watch->end();
    return prepared;
  }();
  note_memory();
  // Half a light pass is of no use: what it has brought is a part of the light only.
  if (halt.stop_requested()) return PassEnd::discarded;
  monitor.light_pass_done(state->report, pass.is_regional());
  add_new(state->report.warnings, report_.warnings);
  // Later ones take the place of earlier ones: what is decided changes as passes teach.
  report_.decisions = state->report.decisions;
  const bool complete =
      !integrator_.traits().samples_camera || render_camera(task, *state, stop, monitor);
  uint32_t samples = samples_per_pass_;
  // Of a region a part is of no use: there is a picture of it.
  // Of a pass of a team, too: others' passes are left to be waited for.
  if (!complete && (task.region || settings_.team)) return PassEnd::discarded;
  if (!complete) {
    samples = pass_.fewest_samples();
    if (samples == 0 || is_pass_abandoned_) return PassEnd::discarded;
  }
  const std::lock_guard lock(picture_mutex_);
  isolated([&] {
    // Beside whole passes it is a part, by itself it is the picture.
    const bool is_part = !complete && film_.pass_count() > 0;
    if (is_part) {
      report_.part = share_taken(pass, *state);
      part_replicate_ = pass.index % replicate_count;
    }
    finish_tiles(task);
    note_memory();
    if (task.region) {
      const PassTiles of_region = pass_.cut_out(*task.region);
      film_.add_regional_pass(*task.region, of_region, pass);
      note_memory(of_region.bytes());
      forget_pass(monitor);
    } else if (!is_part) {
      film_.add_pass(pass_, pass.index, samples);
      note_memory();
      forget_pass(monitor);
    }
    report_.incomplete_pass = !complete && !is_part;
    has_picture_ = true;
  });
  return complete ? PassEnd::complete : PassEnd::incomplete;
}

void Session::clear_pixels(const Pass& next, Monitor& monitor) {
  const std::lock_guard lock(picture_mutex_);
  splat_balance_ = next.wavelengths.balance();
  has_picture_ = film_.pass_count() > 0;
  forget_pass(monitor);
}

void Session::forget_pass(Monitor& monitor) {
  monitor.dropped += splats_.dropped();
  splats_.clear();
  pass_.clear();
  std::fill(is_finished_.begin(), is_finished_.end(), uint8_t(0));
}

void Session::note_memory(size_t extra) {
  report_.film_bytes = film_.bytes();
  report_.rendering_bytes = std::max(report_.rendering_bytes,
                                     report_.film_bytes + pass_.bytes() + splats_.bytes() + extra);
}

double Session::share_taken(const Pass& pass, const PassState& state) const {
  uint64_t taken = 0, all = 0;
  std::array<uint32_t, PictureTiles::pixels> samples;
  for (size_t tile = 0; tile < pass_.tiles().count(); ++tile) {
    pass_.read_samples(tile, samples);
    pass_.tiles().for_pixels_of(tile, [&](int x, int y, size_t place) {
      taken += samples[place];
      all += integrator_.pixel_samples(state, pass, {x, y}).count;
    });
  }
  return double(taken) / double(std::max<uint64_t>(1, all));
}

bool Session::must_be_finished(const Monitor& monitor) const {
  return settings_.keeps_passes && monitor.passes_done() == 0;
}

std::optional<double> Session::last_second(const Monitor& monitor) const {
  // Who leaves out what a team has not finished in time prefers passes that take little.
  if (!settings_.seconds || settings_.team || must_be_finished(monitor)) return std::nullopt;
  if (film_.pass_count() > 0) return settings_.seconds;
  return *settings_.seconds + std::max(least_patience, patience * *settings_.seconds);
}

/// Samples that all pixels get before any gets more.
struct Session::Round {
  int stride = 1;  ///< only pixels whose coordinates are multiples of it
  uint32_t end = std::numeric_limits<uint32_t>::max();

  /// Nothing comes after it.
  bool is_last() const { return stride == 1 && end == std::numeric_limits<uint32_t>::max(); }
  /// As many again as there have been.
  Round next() const {
    if (stride > 1) return {stride / 2, end};
    return {1, end > std::numeric_limits<uint32_t>::max() / 2 ? end : 2 * end};
  }
};

/// What the threads of a pass share that takes camera samples.
struct Session::CameraPass {
  const Task& task;
  const PassState& state;
  const std::stop_token& stop;
  Monitor& monitor;
  /// Halts at this time of the session, too.
  std::optional<double> last_second = std::nullopt;
  std::atomic<bool> halted = false, more = false;  ///< pixels have samples left
  /// Pixels lack samples of the round, for the gate was closed.
  std::atomic<bool> rests = false;

  /// Whether it is to be left as it is.
  bool halts() {
    if (!halted && stop.stop_requested()) halted = true;
    return halted;
  }
  /// To be asked now and then only: that takes a few hundredths of a sample.
  void look_at_clock() {
    if (last_second && monitor.elapsed() > *last_second) halted = true;
  }
};

bool Session::render_camera(const Task& task, const PassState& state, const std::stop_token& stop,
                            Monitor& monitor) {
  CameraPass camera{task, state, stop, monitor};
  // If there is no picture yet, all pixels get a sample, then another, two more, four more …, so
  // that there is one as soon as can be; and if it may not be finished, so that it is one then.
  const bool is_first = film_.pass_count() == 0;
  camera.last_second = last_second(monitor);
  const bool may_be_cut =
      camera.last_second && !task.region &&
      (monitor.passes_done() == 0 ||
       monitor.elapsed() + passes_ahead * monitor.last_pass_seconds() > *settings_.seconds);
  Round round;
  if (may_be_cut) round = {1, 1};
  if (is_first) round = {first_stride, 1};
  // Those that must be there.
  const uint32_t always =
      settings_.keeps_passes ? integrator_.traits().default_samples_per_pass : 1;
  for (bool more = true; more && !camera.halted; round = round.next()) {
    camera.more = false;
    if (is_first && round.end > always) camera.last_second = settings_.seconds;
    // Who rests keeps no thread from others' work.
    do {
      if (settings_.gate) settings_.gate->pass(stop);
      camera.rests = false;
      parallel_blocks(pass_.tiles().count(), 1,
                      [&](size_t tile, size_t, size_t) { render_tile(camera, tile, round); });
    } while (camera.rests && !camera.halts());
    if (is_first && !camera.halted) {
      has_picture_ = true;
      // Who watches need not wait for it.
      if (round.stride > 1) monitor.tell(Progress::Stage::picture, true);
    }
    more = camera.more || round.stride > 1;
  }
  return !camera.halted;
}

void Session::render_tile(CameraPass& camera, size_t tile, const Round& round) {
  if (is_finished_[tile] || !camera.task.meets_tile(pass_.tiles().first_pixel(tile))) return;
  const auto pixels = std::make_unique<PassTiles::Pixels>();
  Scratch scratch;
  uint64_t rays = 0, samples = 0;
  // A snapshot may want to see them.
  std::unique_lock lock(tile_mutexes_[tile]);
  pass_.load(tile, *pixels);
  pass_.tiles().for_pixels_of(tile, [&](int x, int y, size_t place) {
    if (camera.halted || !camera.task.is_in(x, y)) return;
    if (x % round.stride != 0 || y % round.stride != 0) return;
    if (settings_.gate && settings_.gate->is_closed()) camera.rests = true;
    if (camera.rests) return;
    PassPixel& pixel = (*pixels)[place];
    const uint32_t before = pixel.samples;
    rays += render_pixel(camera, x, y, round.end, scratch, pixel);
    samples += pixel.samples - before;
  });
  // Of a first pass snapshots show the sums.
  if (round.is_last() && film_.pass_count() > 0 && !camera.rests) finish(tile, *pixels);
  pass_.store(tile, *pixels);
  lock.unlock();
  camera.monitor.samples_done(samples, rays);
}

uint64_t Session::render_pixel(CameraPass& camera, int x, int y, uint32_t end, Scratch& scratch,
                               PassPixel& sum) const {
  // The address of a pixel is its place in the whole picture, so that a crop window shows the same
  // where nothing is learned from the picture.
  const FilmSettings& film = scene_.film();
  const uint64_t address =
      uint64_t(y + film.crop_offset.y) * uint64_t(film.size.x) + uint64_t(x + film.crop_offset.x);
  const Pass& pass = camera.task.pass;
  const uint32_t sequence = pass.sequence();
  const PixelSamples samples = integrator_.pixel_samples(camera.state, pass, {x, y});
  if (samples.count > end && !camera.more) camera.more = true;
  end = std::min(end, samples.count);
  if (x % samples_per_look == 0) camera.look_at_clock();
  const auto first_set = uint32_t(hash_mix(hash_mix(pass.seed, pass.index), address) >> 32);
  uint64_t rays = 0;
  uint32_t done = sum.samples;
  while (done < end && !camera.halts()) {
    // The first block may have been begun before.
    PassPixel block;
    if (done < samples_per_block) std::swap(block, sum);
    const uint32_t block_end = std::min(end, (done / samples_per_block + 1) * samples_per_block);
    do {
      Sampler sampler =
          Sampler::at(pass.seed, sequence, Stream::camera, address, samples.first_index + done);
      const Vec2f offset = film.filter.sample(sampler.next_2d());
      const size_t set = pass.wavelengths.of_sample(first_set, done);
      SampleSink sink(integrator_.traits().components, pass.wavelengths, &scratch, set);
      integrator_.sample(camera.state, {float(x) + 0.5f + offset.x, float(y) + 0.5f + offset.y},
                         sampler, sink);
      rays += sink.rays();
      // Threads would wait for one another if each sample wrote to what they share.
      if (const int dropped = add_sample(sink, block)) camera.monitor.dropped += uint64_t(dropped);
      if (done % samples_per_look == samples_per_look - 1) camera.look_at_clock();
    } while (++done < block_end && !camera.halts());
    add_scaled(block, 1, sum);
  }
  sum.samples = done;
  return rays;
}

PassPixel Session::finished(const PassPixel& pixel, int x, int y) const {
  PassPixel mean;
  mean.samples = pixel.samples;
  if (pixel.samples > 0) add_scaled(pixel, 1.0f / float(pixel.samples), mean);
  for (int c = 0; c < component_count; ++c)
    if (integrator_.traits().splats && splats_.wants(Component(c)))
      mean.radiance[size_t(c)] += splats_.value(x, y, Component(c)) * splat_balance_;
  return mean;
}

void Session::finish(size_t tile, PassTiles::Pixels& pixels) {
  pass_.tiles().for_pixels_of(
      tile, [&](int x, int y, size_t place) { pixels[place] = finished(pixels[place], x, y); });
  if (integrator_.traits().splats) splats_.clear(tile);
  is_finished_[tile] = 1;
}

void Session::finish_tiles(const Task& task) {
  parallel_blocks(pass_.tiles().count(), 1, [&](size_t tile, size_t, size_t) {
    if (is_finished_[tile] || !task.meets_tile(pass_.tiles().first_pixel(tile))) return;
    const auto pixels = std::make_unique<PassTiles::Pixels>();
    pass_.load(tile, *pixels);
    finish(tile, *pixels);
    pass_.store(tile, *pixels);
  });
}

std::optional<Image> Session::snapshot(SnapshotFacts* facts, bool with_layers) const {
  SnapshotFacts unwanted;
  SnapshotFacts& shown = facts ? *facts : unwanted;
  std::unique_lock lock(picture_mutex_);
  if (!has_picture_) return std::nullopt;
  shown = {film_.pass_count(), film_.samples_per_pixel()};
  // Callbacks come from within parallel work, of which nothing may be taken up meanwhile.
  return isolated([&]() -> std::optional<Image> {
    if (film_.pass_count() > 0) return image(with_layers);
    return first_samples(std::move(lock), shown, with_layers);
  });
}

bool Session::look_at_film(const std::function<void(const Film&)>& look) const {
  const std::lock_guard lock(picture_mutex_);
  if (film_.pass_count() == 0) return false;
  isolated([&] { look(film_); });
  return true;
}

std::optional<Film> Session::film_so_far() const {
  std::optional<Film> copy;
  look_at_film([&](const Film& film) { copy = film; });
  return copy;
}

Image Session::image(bool with_layers) const {
  Image image = film_.image(with_layers);
  if (!(report_.part > 0)) return image;
  PartPicture picture(image, report_.part, part_replicate_);
  const FilmParts parts(film_);
  const auto passes_at = [&](int x, int y) {
    return double(parts.of_pixel(size_t(y) * size_t(film_.width()) + size_t(x)).count());
  };
  parallel_blocks(pass_.tiles().count(), 1, [&](size_t tile, size_t, size_t) {
    const auto pixels = std::make_unique<PassTiles::Pixels>();
    pass_.load(tile, *pixels);
    pass_.tiles().for_pixels_of(tile, [&](int x, int y, size_t place) {
      picture.put(x, y, (*pixels)[place], passes_at(x, y));
    });
  });
  return image;
}

Image Session::first_samples(std::unique_lock<std::mutex> lock, SnapshotFacts& facts,
                             bool with_layers) const {
  Image image = film_.image(with_layers);
  PartPicture picture(image, 1);
  std::vector<uint8_t> is_shown(film_.pixel_count());
  const auto index = [&](int x, int y) { return size_t(y) * size_t(film_.width()) + size_t(x); };
  const auto pixels = std::make_unique<PassTiles::Pixels>();
  uint64_t samples = 0;
  // One lock at a time: who holds it waits for nothing.
  for (size_t tile = 0; tile < pass_.tiles().count(); ++tile) {
    const std::lock_guard of_tile(tile_mutexes_[tile]);
    pass_.load(tile, *pixels);
    pass_.tiles().for_pixels_of(tile, [&](int x, int y, size_t place) {
      if ((*pixels)[place].samples == 0) return;
      samples += (*pixels)[place].samples;
      picture.put(x, y, finished((*pixels)[place], x, y), 0);
      is_shown[index(x, y)] = 1;
    });
  }
  lock.unlock();
  facts.samples_per_pixel = samples / film_.pixel_count();
  if (std::find(is_shown.begin(), is_shown.end(), uint8_t(0)) != is_shown.end())
    image.set_metadata(
        incomplete_key,
        std::string("samples of some pixels; the others show those of a pixel near by"));
  const auto seen = [&](int at, int stride) { return at - at % stride; };
  for (int y = 0; y < film_.height(); ++y)
    for (int x = 0; x < film_.width(); ++x) {
      int stride = 1;
      while (stride < first_stride && !is_shown[index(seen(x, stride), seen(y, stride))])
        stride *= 2;
      if (stride > 1) picture.copy(x, y, seen(x, stride), seen(y, stride));
    }
  return image;
}

}  // namespace kaustik
