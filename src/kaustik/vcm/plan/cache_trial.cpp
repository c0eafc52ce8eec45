#include "kaustik/vcm/plan/cache_trial.h"

#include <algorithm>
#include <utility>

#include "kaustik/base/parallel.h"

namespace kaustik {
namespace {

/// Gather rays of a record.
constexpr int trial_rays = 32;
/// Records of passes have more rays. So their second derivatives tell more, and there are more
/// records: 1.03 to 1.18 times as many with 128 rays, in five scenes that ship.
constexpr double more_records = 1.1;
/// Noise of neighbouring probes that is as alike as this has a spread that probes do not tell.
constexpr double most_alike = 0.99;

/// Of a cache with numbers of its own.
Pass trial_pass(uint64_t seed) {
  Pass pass;
  pass.seed = seed;
  return pass;
}

}  // namespace

/// Of the light that the caches have at a probe.
struct TrialCaches::Difference {
  bool is_served = false;  ///< by both
  double of_light = 0;     ///< in units of lane_sum()
  double mean = 0;         ///< of both
};

TrialCaches::TrialCaches(const GatherInputs& inputs, const PixelPlans& pixels,
                         const std::stop_token& stop)
    : in_(inputs),
      pixels_(pixels),
      caches_{{inputs, trial_pass(0), 0, trial_rays, stop},
              {inputs, trial_pass(1), 0, trial_rays, stop}} {}

CacheTrial TrialCaches::next_round(const std::stop_token& stop) {
  for (IndirectCache& cache : caches_) cache.fill_round(stop);
  if (stop.stop_requested()) return {};
  const size_t probes = pixels_.seen().probes().size();
  std::vector<Difference> all(probes);
  parallel_blocks(probes, 256, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i) all[i] = difference_at(i);
  });
  const double by_rays = double(in_common(all)) * trial_rays / 2;
  const double by_light = double(noise_in_common(spread_of_all)) * relative_variance(in_.light);
  CacheTrial result;
  for (const Difference& difference : all) {
    result.served.push_back(difference.is_served);
    result.ray_variance.push_back(float(by_rays * sqr(difference.of_light)));
    result.light_variance.push_back(float(by_light * sqr(difference.mean)));
  }
  result.rays_per_ray = more_records * double(rays()) / (2 * trial_rays);
  return result;
}

TrialCaches::Difference TrialCaches::difference_at(size_t probe) const {
  Sampler numbers = Sampler::at(0, 0, Stream::pilot_path, probe, 0);
  SampleSink nowhere{ComponentSet()};
  CameraWalk walk(in_.scene, pixels_.seen().probes()[probe].raster, numbers, nowhere);
  if (!IndirectCache::advance_to_vertex(walk, in_.maximum_events)) return {};
  double light[2];
  for (size_t i = 0; i < 2; ++i) {
    Spectrum radiance;
    if (!caches_[i].reflected(walk, radiance)) return {};
    light[i] = double(lane_sum(walk.throughput() * radiance, nowhere.wavelengths()));
  }
  return {true, light[0] - light[1], (light[0] + light[1]) / 2};
}

/// noise_in_common() of the differences: told by how much of their squares, relative to the light,
/// is left of the means of four probes side by side.
float TrialCaches::in_common(const std::vector<Difference>& all) const {
  const BlockGrid& grid = pixels_.seen().grid();
  double single = 0, of_means = 0;
  for (int y = 0; y + 1 < grid.count().y; y += 2)
    for (int x = 0; x + 1 < grid.count().x; x += 2) {
      double sum = 0, squares = 0, mean = 0;
      bool are_served = true;
      for (const auto& [dx, dy] : {std::pair(0, 0), {1, 0}, {0, 1}, {1, 1}}) {
        const Difference& at = all[grid.index_of({x + dx, y + dy})];
        are_served = are_served && at.is_served;
        sum += at.of_light / 4;
        squares += sqr(at.of_light) / 4;
        mean += at.mean / 4;
      }
      if (!are_served || !(mean > 0)) continue;
      single += squares / sqr(mean);
      of_means += sqr(sum) / sqr(mean);
    }
  if (!(single > 0)) return 1;
  // Of noise that probes do not share a quarter is left, of what they share all of it.
  const double shared = std::clamp((4 * of_means / single - 1) / 3, 0.0, most_alike);
  // Over so many pixels noise is spread where that is what points one block apart share.
  const double apart = sqr(double(grid.block_size()));
  return noise_in_common(float(apart * shared / (1 - shared)));
}

double relative_variance(const LightVertices& light) {
  // Paths are known by where their vertices begin.
  std::vector<double> of_paths(light.vertices.size());
  double sum = 0, squares = 0;
  for (const LightVertexData& vertex : light.tree.tree().data())
    if (!vertex.specular)
      of_paths[vertex.path] += double(lane_sum(vertex.flux.spectrum(), light.wavelengths));
  for (const double flux : of_paths) {
    sum += flux;
    squares += flux * flux;
  }
  if (!(sum > 0)) return 0;
  return std::max(0.0, squares / sqr(sum) - 1 / double(light.path_count));
}

}  // namespace kaustik
