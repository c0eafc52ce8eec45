// One pass of a session.
#include <algorithm>
#include <atomic>
#include <limits>

#include "kaustik/base/parallel.h"
#include "kaustik/render/session.h"
#include "kaustik/render/session_monitor.h"

namespace kaustik {
namespace {

constexpr int tile_size = 16;

/// Samples of a pixel that are summed before their sum is added to the others: a float would lose
/// single ones in a sum of millions.
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

}  // namespace

Session::PassEnd Session::render_pass(uint32_t index, std::stop_token stop, Monitor& monitor) {
  monitor.start_pass();
  const Pass pass{settings_.seed, index, samples_per_pass_};
  if (integrator_.splats()) splats_.clear();
  parallel_blocks(pixels_.size(), 4096, [&](size_t begin, size_t end, size_t) {
    std::fill(pixels_.data() + begin, pixels_.data() + end, PassPixel{});
  });
  monitor.tell(Progress::Stage::light, false);
  const auto state =
      integrator_.prepare(pass, splats_, stop, [&](double share) { monitor.light_pass_at(share); });
  // Half a light pass is of no use: what it has brought is a part of the light only.
  if (stop.stop_requested()) return PassEnd::discarded;
  monitor.light_pass_done(state->report);
  add_new(state->report.warnings, report_.warnings);
  add_new(state->report.decisions, report_.decisions);
  const bool complete = !integrator_.samples_camera() || render_camera(pass, *state, stop, monitor);
  uint32_t samples = samples_per_pass_;
  if (!complete) {
    const auto fewest = std::min_element(
        pixels_.begin(), pixels_.end(),
        [](const PassPixel& a, const PassPixel& b) { return a.samples < b.samples; });
    samples = fewest->samples;
    // What is there already is the better picture.
    if (samples == 0 || film_.pass_count() > 0) return PassEnd::discarded;
  }
  finish_pixels();
  film_.add_pass(pixels_, index, samples);
  report_.incomplete_pass = !complete;
  return complete ? PassEnd::complete : PassEnd::incomplete;
}

/// What the threads of a pass share that takes camera samples.
struct Session::CameraPass {
  const Pass& pass;
  const PassState& state;
  const std::stop_token& stop;
  Monitor& monitor;
  /// Halts at this time of the session, too.
  std::optional<double> last_second = std::nullopt;
  std::atomic<bool> halted = false, more = false;  ///< pixels have samples left

  /// Whether it is to be left as it is.
  bool halts() {
    if (halted) return true;
    if (stop.stop_requested() || (last_second && monitor.elapsed() > *last_second)) halted = true;
    return halted;
  }
};

bool Session::render_camera(const Pass& pass, const PassState& state, const std::stop_token& stop,
                            Monitor& monitor) {
  CameraPass camera{pass, state, stop, monitor};
  // If there is no picture yet, all pixels get a sample, then another, two more, four more …, so
  // that there is one as soon as can be.
  const bool in_rounds = film_.pass_count() == 0;
  uint32_t end = in_rounds ? 1 : std::numeric_limits<uint32_t>::max();
  const uint32_t always = integrator_.default_samples_per_pass();
  const Vec2i tiles((film_.width() + tile_size - 1) / tile_size,
                    (film_.height() + tile_size - 1) / tile_size);
  do {
    camera.more = false;
    if (in_rounds && end > always) camera.last_second = settings_.seconds;
    parallel_blocks(size_t(tiles.x) * size_t(tiles.y), 1, [&](size_t tile, size_t, size_t) {
      render_tile(camera, {int(tile) % tiles.x, int(tile) / tiles.x}, end);
    });
    end = end > std::numeric_limits<uint32_t>::max() / 2 ? end : 2 * end;
  } while (camera.more && !camera.halted);
  return !camera.halted;
}

void Session::render_tile(CameraPass& camera, const Vec2i& tile, uint32_t end) {
  const int x0 = tile.x * tile_size, y0 = tile.y * tile_size;
  const int x1 = std::min(x0 + tile_size, film_.width());
  const int y1 = std::min(y0 + tile_size, film_.height());
  uint64_t rays = 0, samples = 0;
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1 && !camera.halted; ++x) {
      PassPixel& pixel = pixels_[size_t(y) * size_t(film_.width()) + size_t(x)];
      const uint32_t before = pixel.samples;
      rays += render_pixel(camera, x, y, end, pixel);
      samples += pixel.samples - before;
    }
  camera.monitor.samples_done(samples, rays);
}

uint64_t Session::render_pixel(CameraPass& camera, int x, int y, uint32_t end,
                               PassPixel& sum) const {
  // The address of a pixel is its place in the whole picture, so that a crop window shows the same
  // where nothing is learned from the picture.
  const FilmSettings& film = scene_.film();
  const uint64_t address =
      uint64_t(y + film.crop_offset.y) * uint64_t(film.size.x) + uint64_t(x + film.crop_offset.x);
  const Pass& pass = camera.pass;
  const uint32_t replicate = pass.index % replicate_count;
  const PixelSamples samples = integrator_.pixel_samples(camera.state, pass, {x, y});
  if (samples.count > end && !camera.more) camera.more = true;
  end = std::min(end, samples.count);
  uint64_t rays = 0;
  uint32_t done = sum.samples;
  while (done < end && !camera.halts()) {
    // The first block may have been begun before.
    PassPixel block;
    if (done < samples_per_block) std::swap(block, sum);
    const uint32_t block_end = std::min(end, (done / samples_per_block + 1) * samples_per_block);
    do {
      Sampler sampler =
          Sampler::at(pass.seed, replicate, Stream::camera, address, samples.first_index + done);
      const Vec2f offset = film.filter.sample(sampler.next_2d());
      SampleSink sink(integrator_.components());
      integrator_.sample(camera.state, {float(x) + 0.5f + offset.x, float(y) + 0.5f + offset.y},
                         sampler, sink);
      rays += sink.rays();
      // Threads would wait for one another if each sample wrote to what they share.
      if (const int dropped = add_sample(sink, block)) camera.monitor.dropped += uint64_t(dropped);
    } while (++done < block_end && !camera.halts());
    add_scaled(block, 1, sum);
  }
  sum.samples = done;
  return rays;
}

void Session::finish_pixels() {
  parallel_blocks(size_t(film_.height()), 1, [&](size_t row, size_t, size_t) {
    for (int x = 0; x < film_.width(); ++x) {
      PassPixel& pixel = pixels_[row * size_t(film_.width()) + size_t(x)];
      PassPixel mean;
      mean.samples = pixel.samples;
      if (pixel.samples > 0) add_scaled(pixel, 1.0f / float(pixel.samples), mean);
      for (int c = 0; c < component_count; ++c)
        if (integrator_.splats() && splats_.wants(Component(c)))
          mean.radiance[size_t(c)] += splats_.value(x, int(row), Component(c));
      pixel = mean;
    }
  });
}

}  // namespace kaustik
