#include "kaustik/vcm/plan/path_pilot.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "kaustik/base/parallel.h"
#include "kaustik/base/to_integer.h"
#include "kaustik/photon/coverage/merge_disk.h"

namespace kaustik {
namespace {

/// Paths of a probe: so many, but fewer where all of them would be more than they may. What is told
/// of a block then rests on more blocks around. Fewer than three tell little of a variance: where
/// there would be fewer, only some probes have paths.
constexpr uint32_t most_paths_per_probe = 8, least_paths_per_probe = 3;
constexpr double most_paths = 1 << 17;
/// Where blocks have several pixels there may be no more of them than this share of a pass's camera
/// samples, or than so many if that is more.
constexpr double share_of_pass = 1.0 / 8, fewest_paths = 1 << 13;
/// The kernel of merging weighs its vertices unevenly: they are worth so many of equal weight.
constexpr double kernel_efficiency = 0.75;
/// Light that merging finds more often than this, per camera path of a pass, says nothing about how
/// even what camera paths find is: a single path that happens upon it would.
constexpr double most_merged = 64;
/// Most of m/p.
const double most_ratio =
    std::exp2(double(ProbeStatistics::bin_count - 1 - ProbeStatistics::bin_of_one));

int bin_of(double ratio) {
  if (!(ratio > 0)) return 0;
  return to_integer(std::round(std::log2(ratio)) + ProbeStatistics::bin_of_one, 0,
                    ProbeStatistics::bin_count - 1);
}

/// Weighs light as path tracing does, and notes of each contribution what its weight would be
/// beside merging: from both follows how much more merging would find it.
class Recorder final : public LightWeights {
 public:
  Recorder(CameraPath& path, const SampleSink& sink, uint32_t paths, ProbeStatistics& result)
      : beside_merging_(path.weights()),
        alone_(path.inputs(), path.vertices(), false),
        sink_(sink),
        camera_samples_(double(path.inputs().camera_samples)),
        paths_(double(paths)),
        result_(result) {}

  float sampled(const Scatterer& vertex, const DirectLight& light) override {
    return weigh([&](CameraPathWeights& weights) { return weights.sampled(vertex, light); });
  }
  float met(int light, const SurfaceVertex& vertex) override {
    return weigh([&](CameraPathWeights& weights) { return weights.met(light, vertex); });
  }
  float met(int light, const Ray& ray) override {
    return weigh([&](CameraPathWeights& weights) { return weights.met(light, ray); });
  }
  /// What has been found since the last look belongs to the last weight.
  void note() {
    const double now = sink_.all_light(), light = now - seen_;
    seen_ = now;
    const double indirect_before = seen_indirect_;
    seen_indirect_ = indirect();
    if (light == 0) return;
    if (!goes_on_) {
      direct_ += light;
      return;
    }
    // Split between the ways as the balance heuristic does.
    const double share = camera_samples_ / (camera_samples_ + ratio_);
    const double even_share =
        most_merged * camera_samples_ / (most_merged * camera_samples_ + ratio_);
    const auto bin = size_t(bin_of(ratio_));
    beyond_ += light * share;
    even_ += light * even_share;
    const double squares = light * light * share / paths_;
    result_.squares[bin] += (1 - glossy_share_) * squares;
    result_.glossy_squares[bin] += glossy_share_ * squares;
    const double gathered = is_for_cache_ ? seen_indirect_ - indirect_before : 0.0;
    const double rest = light - gathered;
    result_.gathered += gathered;
    ungathered_even_ += rest * even_share;
    const double rest_squares = rest * rest * share / paths_;
    result_.ungathered.squares[bin] += (1 - glossy_share_) * rest_squares;
    result_.ungathered.glossy_squares[bin] += glossy_share_ * rest_squares;
  }
  /// A cache may have the diffuse indirect light of the probed vertex.
  void leave_to_cache(bool is_for_it) { is_for_cache_ = is_for_it; }
  /// Light found since the last look. It counts for nothing.
  double dropped() {
    const double now = sink_.all_light();
    return now - std::exchange(seen_, now);
  }
  /// The path has left the probed vertex, in a direction in which the glossy lobe has that share of
  /// f, and found what every path looks for there.
  void go_on(double glossy_share) {
    note();
    goes_on_ = true;
    glossy_share_ = glossy_share;
  }
  double direct() const { return direct_; }
  double beyond() const { return beyond_; }
  double even() const { return even_; }
  double ungathered_even() const { return ungathered_even_; }

 private:
  double indirect() const {
    return double(lane_sum(sink_.radiance(Component::indirect), sink_.wavelengths()));
  }
  template <typename Weight>
  float weigh(const Weight& weight) {
    note();
    const float beside_merging = weight(beside_merging_), alone = weight(alone_);
    ratio_ = beside_merging > 0 && alone > beside_merging
                 ? kernel_efficiency * camera_samples_ *
                       std::sqrt(double(alone) / double(beside_merging) - 1)
                 : 0;
    return alone;
  }

  CameraPathWeights& beside_merging_;
  CameraPathWeights alone_;
  const SampleSink& sink_;
  double camera_samples_;
  double paths_;  ///< of the probe
  ProbeStatistics& result_;
  bool goes_on_ = false, is_for_cache_ = false;
  double seen_ = 0, seen_indirect_ = 0, ratio_ = 0, glossy_share_ = 0;
  double direct_ = 0, beyond_ = 0, even_ = 0, ungathered_even_ = 0;
};

/// Light that merges there, as what a camera path that goes on would have to find.
void add_merged(CameraPath& path, float samples, double light_share, ProbeStatistics& result) {
  const double camera_samples = double(samples);
  const auto covered = double(path.vertices().plan().covered);
  const bool is_for_cache = IndirectCache::is_for(path.walk(), path.inputs().maximum_events);
  for (const auto& [beyond, spectrum, indirect, of_glossy] : path.merged_vertices()) {
    const double glossy = double(of_glossy), diffuse = 1 - glossy;
    // As merging divides it by what is covered of the disk.
    const double light = double(spectrum.sum()) / covered;
    const double rest = is_for_cache ? light - double(indirect.sum()) / covered : light;
    if (is_for_cache) result.gathered += double(indirect.sum());
    result.merged += 1 / light_share;
    if (!is_for_cache || rest != 0) result.ungathered.merged += 1 / light_share;
    if (light == 0) continue;
    // Of each of the vertices that a real pass has in place of this one.
    const double squares = light * light * light_share;
    const double ratio =
        beyond > 0
            ? std::min(most_ratio, kernel_efficiency * camera_samples / std::sqrt(double(beyond)))
            : 0.0;
    if (!(ratio > 0)) {
      result.merged_alone += diffuse * squares;
      result.glossy_merged_alone += glossy * squares;
      result.ungathered.merged_alone += diffuse * rest * rest * light_share;
      result.ungathered.glossy_merged_alone += glossy * rest * rest * light_share;
      result.radiance += light;
      continue;
    }
    const double share = ratio / (camera_samples + ratio);
    const auto bin = size_t(bin_of(ratio));
    result.squares[bin] += diffuse * squares * ratio * share;
    result.glossy_squares[bin] += glossy * squares * ratio * share;
    const double rest_squares = rest * rest * light_share * ratio * share;
    result.ungathered.squares[bin] += diffuse * rest_squares;
    result.ungathered.glossy_squares[bin] += glossy * rest_squares;
    result.radiance += light * share;
  }
}

/// Which probes have paths: of every so many blocks in a row and in a column one, and how many.
struct PilotDensity {
  int stride = 1;
  uint32_t paths = 0;

  /// In a picture of that size, of which a crop window is planned as the whole is, for passes of so
  /// many camera samples per pixel.
  PilotDensity(const Vec2i& size, int block_size, double samples) {
    const double pixels = double(size.x) * double(size.y);
    const double most = block_size > 1
                            ? std::clamp(share_of_pass * samples * pixels, fewest_paths, most_paths)
                            : most_paths;
    const double blocks = std::max(1.0, pixels / sqr(block_size));
    const auto affordable = [&] { return most * sqr(stride) / blocks; };
    while (affordable() < least_paths_per_probe) ++stride;
    paths = uint32_t(std::min(affordable(), double(most_paths_per_probe)));
  }
};

/// Of each the mean over it and those beside it.
std::vector<ProbeStatistics> smoothed(const std::vector<ProbeStatistics>& single,
                                      const BlockGrid& grid) {
  std::vector<ProbeStatistics> result(single.size());
  parallel_blocks(single.size(), 256, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i) {
      int count = 0;
      grid.visit_around(i, [&](size_t) { ++count; });
      grid.visit_around(i, [&](size_t near) { result[i].add(single[near], 1.0 / double(count)); });
    }
  });
  return result;
}

/// Of a cell of stride × stride blocks, some of which may lie beyond the grid.
Vec2i middle_block(const BlockGrid& grid, const Vec2i& cell, int stride) {
  const auto along = [&](int number, int count) {
    return std::min(number * stride + stride / 2, count - 1);
  };
  return {along(cell.x, grid.count().x), along(cell.y, grid.count().y)};
}

/// Unbiased variance of values of this sum and these squares.
double variance_of(double sum, double squares, double count) {
  return std::max(0.0, squares - sum * sum / count) / (count - 1);
}

/// Variance of values one by one and of the means of runs of them. Numbers of the sampler stratify
/// one another within a run: its mean has less variance than that of as many independent values.
class RunVariance {
 public:
  /// Of so many values. Runs are as long as a pass has samples of a pixel, `wanted`, but no longer
  /// than half of the values: of 3 each is a run, and nothing stratifies.
  RunVariance(uint32_t values, double wanted) : values_(values) {
    while (2 * run_ <= wanted && 4 * run_ <= values) run_ *= 2;
  }
  void add(double value) {
    sum_ += value;
    squares_ += value * value;
    run_sum_ += value;
    if (++in_run_ < run_) return;
    runs_sum_ += run_sum_;
    runs_squares_ += run_sum_ * run_sum_;
    run_sum_ = 0;
    in_run_ = 0;
  }
  double of_single() const { return variance_of(sum_, squares_, values_); }
  /// Of a run's mean, times its length: the same as of_single() where nothing stratifies.
  double of_runs() const {
    const uint32_t runs = values_ / run_;
    return variance_of(runs_sum_, runs_squares_, runs) / run_;
  }

 private:
  uint32_t values_, run_ = 1, in_run_ = 0;
  double sum_ = 0, squares_ = 0, run_sum_ = 0, runs_sum_ = 0, runs_squares_ = 0;
};

/// Somewhere in the pixel that the probe looks at: the probe itself for the first path.
Vec2f raster_in_pixel(const PixelProbe& probe, const Vec2f& u, uint32_t path) {
  if (path == 0) return probe.raster;
  return Vec2f(std::floor(probe.raster.x), std::floor(probe.raster.y)) + u;
}

ProbeStatistics statistics_at(const CameraPathInputs& in, const PixelProbe& probe, PixelPlan plan,
                              size_t index, uint32_t paths, const PilotLimits& limits,
                              Scratch& scratch) {
  ProbeStatistics result;
  plan.survival = plan.glossy_survival = plan.evenness = 1;
  plan.light_samples = 1;
  const double count = paths;
  RunVariance direct_variance(paths, double(in.camera_samples));
  double direct = 0, beyond = 0, even = 0, even_squares = 0, rays_beyond = 0,
         glossy_rays_beyond = 0;
  double light_differences = 0, light_sample_rays = 0;
  double ungathered = 0, ungathered_squares = 0;
  // Else the sink would drop what is mirrored under its own name.
  const bool wants_all_reflected = limits.components.has(Component::direct) &&
                                   limits.components.has(Component::caustic) &&
                                   limits.components.has(Component::indirect);
  for (uint32_t i = 0; i < paths; ++i) {
    Sampler sampler = Sampler::at(0, 0, Stream::pilot_path, index, i);
    SampleSink sink(limits.components, {}, &scratch);
    CameraPath path(in, plan, raster_in_pixel(probe, sampler.next_2d(), i), sampler, sink);
    CameraWalk& walk = path.walk();
    Recorder recorder(path, sink, paths, result);
    uint64_t rays_before = 0;
    bool is_behind = false;
    const auto go_beyond = [&] {
      recorder.go_on(double(path.vertices().glossy_share()));
      rays_before = walk.rays();
      is_behind = false;
    };
    while (path.go_on(false, &recorder) != CameraWalk::Arrival::nothing) {
      if (is_behind) go_beyond();
      if (walk.events() >= in.maximum_events) break;
      recorder.note();
      const double direct_before = recorder.direct();
      path.add_direct_light(&recorder);
      const bool was_before = path.vertices().is_at_first();
      if (was_before) {
        if (wants_all_reflected) walk.show_as_seen();
        recorder.leave_to_cache(IndirectCache::is_for(walk, in.maximum_events));
        // Another sample from the same place.
        recorder.note();
        const uint64_t rays_of_path = walk.rays();
        path.add_direct_light(&recorder);
        light_sample_rays += double(walk.rays() - rays_of_path) / count;
        walk.rays() = rays_of_path;
        light_differences += sqr(recorder.direct() - direct_before - recorder.dropped());
      }
      // Of the first path alone: which vertex paths come to may be up to chance.
      if (was_before && i == 0 && any(walk.vertex().lobes() & (Lobes::diffuse | Lobes::glossy)))
        add_merged(path, in.camera_samples, limits.light_share, result);
      const Vec2f u = sampler.next_2d(), u_choice = sampler.next_2d();
      if (!walk.scatter(Lobes::all, 1, u_choice.x, u)) break;
      path.leave();
      if (path.vertices().has_left_first()) {
        is_behind = path.may_end_at_lamp();
        if (!is_behind) go_beyond();
      }
      if (!walk.may_find_more()) break;
      if (walk.events() > in.roulette_depth && !walk.survive(u_choice.y)) break;
    }
    recorder.note();
    if (rays_before == 0) rays_before = walk.rays();
    result.rays += double(rays_before) / count;
    const double glossy_share = double(path.vertices().glossy_share());
    rays_beyond += (1 - glossy_share) * double(walk.rays() - rays_before) / count;
    glossy_rays_beyond += glossy_share * double(walk.rays() - rays_before) / count;
    direct += recorder.direct();
    direct_variance.add(recorder.direct());
    beyond += recorder.beyond();
    even += recorder.even();
    even_squares += recorder.even() * recorder.even();
    ungathered += recorder.ungathered_even();
    ungathered_squares += sqr(recorder.ungathered_even());
  }
  result.rays_beyond = rays_beyond;
  result.glossy_rays_beyond = glossy_rays_beyond;
  result.path_mean_square = even_squares / count;
  result.path_variance = variance_of(even, even_squares, count);
  result.ungathered.path_mean_square = ungathered_squares / count;
  result.ungathered.path_variance = variance_of(ungathered, ungathered_squares, count);
  result.direct_variance = direct_variance.of_runs();
  result.single_direct_variance = direct_variance.of_single();
  result.light_sample_variance = light_differences / (2 * count);
  result.light_sample_rays = light_sample_rays;
  result.radiance += (direct + beyond) / count;
  return result;
}

}  // namespace

std::vector<ProbeStatistics> probe_statistics(const CameraPathInputs& inputs,
                                              const PixelPlans& plans, const PilotLimits& limits,
                                              uint64_t& rays, const std::stop_token& stop) {
  const std::vector<PixelProbe>& probes = plans.seen().probes();
  const BlockGrid& grid = plans.seen().grid();
  const PilotDensity density(inputs.scene.film().size, grid.block_size(),
                             double(inputs.camera_samples));
  // Of so many blocks each, whose middle one's probe has paths.
  const BlockGrid cells(grid.window(), grid.block_size() * density.stride);
  std::vector<ProbeStatistics> single(cells.size());
  parallel_blocks(single.size(), 16, [&](size_t begin, size_t end, size_t) {
    Scratch scratch;
    for (size_t cell = begin; cell < end && !stop.stop_requested(); ++cell) {
      const size_t i = grid.index_of(middle_block(grid, cells.block(cell), density.stride));
      single[cell] =
          statistics_at(inputs, probes[i], plans.plans()[i], i, density.paths, limits, scratch);
    }
  });
  double counted = 0;
  for (const ProbeStatistics& s : single)
    counted +=
        density.paths * (s.rays + s.rays_beyond + s.glossy_rays_beyond + s.light_sample_rays);
  rays += to_integer(std::round(counted), uint64_t(0), uint64_t(1) << 53);
  std::vector<ProbeStatistics> of_cells = smoothed(single, cells);
  if (density.paths < most_paths_per_probe) of_cells = smoothed(of_cells, cells);
  if (density.stride == 1) return of_cells;
  std::vector<ProbeStatistics> result(probes.size());
  for (size_t i = 0; i < result.size(); ++i)
    result[i] = of_cells[cells.index_of(grid.block(i) / density.stride)];
  return result;
}

}  // namespace kaustik
