#include "kaustik/vcm/gathering/indirect_cache.h"

#include <array>

#include "kaustik/base/parallel.h"
#include "kaustik/photon/photon_map.h"

namespace kaustik {
namespace {

/// Distances, in pixels, between those whose surfaces ask for records, round by round.
constexpr std::array<int, IndirectCache::most_rounds> strides{8, 4};
// In the first pass; see CacheSettings.
constexpr float first_quality = 0.35f, first_minimum_spacing = 3, first_maximum_spacing = 40;

/// How much larger an error than in filling is allowed to who asks: else slivers between records
/// would have other, coarser noise.
constexpr float allowed_error = 1.7f;
/// Delta events on the way to a vertex, and vertices of a path, that ask for records.
constexpr int most_delta_events = 16, most_vertices = 4;

CacheSettings settings_of(const Pass& pass, int gather_rays) {
  CacheSettings settings;
  const float shrinkage = pass_radius(1, pass.stage());
  settings.quality = first_quality * shrinkage;
  settings.minimum_spacing = first_minimum_spacing * shrinkage;
  settings.maximum_spacing = first_maximum_spacing * shrinkage;
  // What few rays tell of second derivatives is noisy: the least reach of all around would be too
  // small by far.
  settings.neighbor_clamping = false;
  settings.hemisphere.samples = gather_rays;
  return settings;
}

CachePoint cache_point_of(const CameraWalk& walk) {
  const Footprint& footprint = walk.footprint();
  const Vec3f normal = walk.vertex().facing_normal();
  return {walk.vertex().point(), normal, 2 * std::min(footprint.width, footprint.sharp_width), 1,
          walk.vertex().medium_toward(normal, walk.medium())};
}

/// As often as a path would.
bool go_on_by_delta_event(CameraWalk& walk) {
  const Vec2f u = walk.sampler().next_2d();
  return walk.scatter(Lobes::all, 1, walk.sampler().next_1d(), u) && walk.all_events_delta();
}

}  // namespace

IndirectCache::IndirectCache(const GatherInputs& inputs, const Pass& pass, size_t set,
                             int gather_rays, const std::stop_token& stop)
    : in_(inputs),
      pass_(pass),
      set_(set),
      light_(inputs, stop),
      cache_(settings_of(pass, gather_rays)) {}

Sampler IndirectCache::numbers(uint64_t address) const {
  const uint32_t round_of_set = uint32_t(set_) * most_rounds + round_;
  return Sampler::at(pass_.seed, pass_.index, Stream::cache, address, round_of_set);
}

void IndirectCache::fill_round(const std::stop_token& stop) {
  const std::vector<CachePoint> points = points_of_round(strides[round_], stop);
  if (stop.stop_requested()) return;
  const Sampler sampler =
      Sampler::at(pass_.seed, pass_.index, Stream::cache, 0, uint32_t(set_) * most_rounds);
  cache_.fill_round(points, light_, sampler, round_++, stop);
}

std::vector<CachePoint> IndirectCache::points_of_round(int stride,
                                                       const std::stop_token& stop) const {
  const FilmSettings& film = in_.scene.film();
  const Vec2i first = film.crop_offset / stride;
  const Vec2i end = (film.crop_offset + film.crop_size + Vec2i(stride - 1)) / stride;
  std::vector<std::vector<CachePoint>> rows(size_t(end.y - first.y));
  parallel_blocks(rows.size(), 1, [&](size_t row, size_t, size_t) {
    for (int x = first.x; x < end.x && !stop.stop_requested(); ++x) {
      const Vec2i pixel = Vec2i(x, first.y + int(row)) * stride;
      const uint64_t address = uint64_t(pixel.y) * uint64_t(film.size.x) + uint64_t(pixel.x) + 1;
      Sampler sampler = numbers(address);
      const Vec2i corner = pixel - film.crop_offset;
      const Vec2f raster =
          Vec2f(float(corner.x), float(corner.y)) + sampler.next_2d() * float(stride);
      SampleSink nowhere{ComponentSet(), pass_.wavelengths, nullptr, set_};
      CameraWalk walk(in_.scene, raster, sampler, nowhere);
      for (int i = 0; i < most_vertices && advance_to_vertex(walk, in_.maximum_events); ++i) {
        rows[row].push_back(cache_point_of(walk));
        if (!go_on_by_delta_event(walk)) break;
      }
    }
  });
  std::vector<CachePoint> points;
  for (const auto& row : rows) points.insert(points.end(), row.begin(), row.end());
  return points;
}

bool IndirectCache::advance_to_vertex(CameraWalk& walk, int maximum_events) {
  while (walk.events() < most_delta_events && walk.advance()) {
    if (is_for(walk, maximum_events)) return true;
    if (!go_on_by_delta_event(walk)) return false;
  }
  return false;
}

bool IndirectCache::reflected(const CameraWalk& walk, Spectrum& radiance) const {
  const CachePoint point = cache_point_of(walk);
  Spectrum irradiance;
  if (!cache_.serves(point, allowed_error) || !cache_.interpolate(point, irradiance)) return false;
  radiance = walk.vertex().diffuse_value() * irradiance;
  return true;
}

}  // namespace kaustik
