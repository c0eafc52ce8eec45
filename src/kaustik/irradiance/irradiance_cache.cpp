#include "kaustik/irradiance/irradiance_cache.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "kaustik/base/parallel.h"
#include "kaustik/irradiance/neighbor_clamping.h"
#include "kaustik/irradiance/record_octree.h"
#include "kaustik/irradiance/spaced_subset.h"

namespace kaustik {
namespace {

constexpr size_t query_block = 1024;
/// To this share of the largest reach the spacing of new records is halved from step to step.
constexpr float minimum_step_spacing = 1.0f / 65536;

/// A record as it was computed. How far it reaches also depends on its neighbours.
struct ComputedRecord {
  Vec3f position;
  Vec3f normal;
  HemisphereEstimate estimate;
  float distance;          ///< m, to what it sees: harmonic mean or minimum; may be infinite
  float clamped_distance;  ///< m, ≤ distance: by the neighbours
  float gradient_limit;    ///< m, over which the gradients would change the irradiance by itself
  float minimum_reach, maximum_reach;  ///< m
};

/// Σ E / Σ |∇E| over the lanes; infinite without gradients.
float gradient_limit(const HemisphereEstimate& estimate) {
  float gradients = 0;
  for (const Vec3f& gradient : estimate.translation_gradient) gradients += length(gradient);
  return gradients > 0 ? std::max(0.0f, estimate.irradiance.sum()) / gradients : infinity;
}

float reach_of(const ComputedRecord& record, float quality) {
  const float distance = std::min(record.clamped_distance, record.gradient_limit);
  return std::clamp(quality * distance, record.minimum_reach, record.maximum_reach);
}

/// Puts the gradients into the form for extrapolation. A lane's translation gradient is limited to
/// E/R, where R is the distance that the reach stands for: within its reach the record changes by
/// at most the share a, also where the reach was raised to the minimum.
CacheRecord finished(const ComputedRecord& computed, const CacheSettings& settings) {
  const HemisphereEstimate& estimate = computed.estimate;
  CacheRecord record;
  record.position = computed.position;
  record.normal = computed.normal;
  record.reach = reach_of(computed, settings.quality);
  record.irradiance = estimate.irradiance;
  if (!settings.gradients) return record;
  for (int lane = 0; lane < Spectrum::lane_count; ++lane) {
    const Vec3f& along = estimate.translation_gradient[lane];
    const float limit = std::max(0.0f, estimate.irradiance[lane]) * settings.quality / record.reach;
    const float size = length(along);
    const float scale = size > limit ? limit / size : 1.0f;
    if (!std::isfinite(size) || !is_finite(estimate.rotation_gradient[lane])) continue;
    // (n × n')·g = (g × n)·n'
    const Vec3f turning = cross(estimate.rotation_gradient[lane], computed.normal);
    for (int axis = 0; axis < 3; ++axis) {
      record.per_metre[axis].set(lane, along[axis] * scale);
      record.per_normal[axis].set(lane, turning[axis]);
    }
  }
  return record;
}

/// `all` without `some`; both ascend.
std::vector<uint32_t> without(const std::vector<uint32_t>& all, const std::vector<uint32_t>& some) {
  std::vector<uint32_t> rest;
  std::set_difference(all.begin(), all.end(), some.begin(), some.end(), std::back_inserter(rest));
  return rest;
}

Bounds3f bounds_of(const std::vector<CachePoint>& points, const std::vector<uint32_t>& which) {
  Bounds3f bounds;
  for (const uint32_t i : which) bounds.extendBy(points[i].point.position);
  return bounds;
}

}  // namespace

struct IrradianceCache::Impl {
  explicit Impl(const CacheSettings& s) : settings(s) {}

  CacheSettings settings;
  std::vector<ComputedRecord> records;
  NeighborClamping clamping;
  RecordOctree octree;
  uint64_t rays = 0, dropped = 0;
  float extent = 0;  ///< m, diagonal of the points of the first round that had any

  float minimum_reach(const CachePoint& p) const {
    return std::max(settings.minimum_spacing * p.pixel_width, 1e-6f * extent);
  }
  float maximum_reach(const CachePoint& p) const {
    const float wanted =
        p.pixel_width > 0 ? settings.maximum_spacing * p.pixel_width : settings.quality * extent;
    return std::max(wanted, minimum_reach(p));
  }

  std::vector<uint32_t> finite_points(const std::vector<CachePoint>& points) const;
  std::vector<uint32_t> misses(const std::vector<CachePoint>& points,
                               const std::vector<uint32_t>& candidates) const;
  std::vector<uint32_t> pick(const std::vector<CachePoint>& points,
                             const std::vector<uint32_t>& candidates, float spacing) const;
  ComputedRecord compute(const CachePoint& at, const RadianceSource& source,
                         const Sampler& sampler) const;
  void clamp_by_neighbors(size_t first_new);
  void insert(std::vector<ComputedRecord> fresh);
};

std::vector<uint32_t> IrradianceCache::Impl::finite_points(
    const std::vector<CachePoint>& points) const {
  std::vector<uint32_t> result;
  for (size_t i = 0; i < points.size(); ++i) {
    const CachePoint& p = points[i];
    if (is_finite(p.point.position) && is_finite(p.normal) && std::isfinite(p.pixel_width))
      result.push_back(uint32_t(i));
  }
  return result;
}

/// Those of `candidates` that no record serves.
std::vector<uint32_t> IrradianceCache::Impl::misses(const std::vector<CachePoint>& points,
                                                    const std::vector<uint32_t>& candidates) const {
  std::vector<uint8_t> served(candidates.size());
  parallel_blocks(candidates.size(), query_block, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i) {
      const CachePoint& p = points[candidates[i]];
      served[i] = octree.serves(p.point.position, p.normal);
    }
  });
  std::vector<uint32_t> result;
  for (size_t i = 0; i < candidates.size(); ++i)
    if (!served[i]) result.push_back(candidates[i]);
  return result;
}

/// Those of `candidates` that keep apart by `spacing` times their largest reach; at least one.
std::vector<uint32_t> IrradianceCache::Impl::pick(const std::vector<CachePoint>& points,
                                                  const std::vector<uint32_t>& candidates,
                                                  float spacing) const {
  SpacedSubset subset;
  std::vector<uint32_t> result;
  for (const uint32_t i : candidates) {
    const CachePoint& p = points[i];
    const float apart = std::max(spacing * maximum_reach(p), minimum_reach(p));
    if (subset.pick(p.point.position, p.normal, apart)) result.push_back(i);
  }
  return result;
}

ComputedRecord IrradianceCache::Impl::compute(const CachePoint& at, const RadianceSource& source,
                                              const Sampler& sampler) const {
  ComputedRecord record;
  record.position = at.point.position;
  record.normal = at.normal;
  record.estimate = sample_hemisphere(source, at.point, at.normal, settings.hemisphere, sampler);
  record.distance = settings.minimum_distance ? record.estimate.minimum_distance
                                              : record.estimate.harmonic_distance;
  record.clamped_distance = record.distance;
  record.gradient_limit = settings.gradients ? gradient_limit(record.estimate) : infinity;
  record.minimum_reach = minimum_reach(at);
  record.maximum_reach = maximum_reach(at);
  return record;
}

/// New records by all others, old records by the new ones.
void IrradianceCache::Impl::clamp_by_neighbors(size_t first_new) {
  parallel_blocks(records.size(), 64, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i) {
      ComputedRecord& r = records[i];
      r.clamped_distance =
          clamping.clamped(r.position, r.normal, r.clamped_distance, i < first_new ? first_new : 0);
    }
  });
}

void IrradianceCache::Impl::insert(std::vector<ComputedRecord> fresh) {
  const size_t first_new = records.size();
  for (ComputedRecord& record : fresh) {
    rays += record.estimate.rays;
    dropped += record.estimate.dropped;
    if (!record.estimate.irradiance.is_finite()) continue;  // overflow
    clamping.add(record.position, record.normal, record.distance);
    records.push_back(std::move(record));
  }
  if (settings.neighbor_clamping) clamp_by_neighbors(first_new);
  std::vector<CacheRecord> listed;
  listed.reserve(records.size());
  for (const ComputedRecord& record : records) listed.push_back(finished(record, settings));
  octree = RecordOctree(std::move(listed), settings.quality);
}

IrradianceCache::IrradianceCache(const CacheSettings& settings)
    : impl_(std::make_unique<Impl>(settings)) {
  if (!(settings.quality > 0) || !(settings.minimum_spacing >= 0) ||
      !(settings.maximum_spacing >= settings.minimum_spacing))
    throw std::invalid_argument("irradiance cache: quality or spacing out of range");
}

IrradianceCache::~IrradianceCache() = default;
IrradianceCache::IrradianceCache(IrradianceCache&&) noexcept = default;
IrradianceCache& IrradianceCache::operator=(IrradianceCache&&) noexcept = default;

size_t IrradianceCache::fill_round(const std::vector<CachePoint>& points,
                                   const RadianceSource& source, const Sampler& sampler,
                                   uint32_t round, std::stop_token stop) {
  const size_t count_before = impl_->records.size();
  std::vector<uint32_t> candidates = impl_->finite_points(points);
  if (candidates.empty()) return 0;
  if (impl_->extent <= 0) {
    const Bounds3f bounds = bounds_of(points, candidates);
    impl_->extent = std::max(2 * bounding_radius(bounds), 1e-6f + 1e-6f * max_abs(bounds.max));
  }
  float spacing = 1;
  // Again from the start until all are served: a late record may have clamped one that served.
  std::vector<uint32_t> open = impl_->misses(points, candidates);
  while (!open.empty() && !stop.stop_requested()) {
    const std::vector<uint32_t> picked = impl_->pick(points, open, spacing);
    std::vector<ComputedRecord> fresh(picked.size());
    parallel_blocks(picked.size(), 1, [&](size_t begin, size_t, size_t) {
      if (stop.stop_requested()) return;
      const uint32_t i = picked[begin];
      fresh[begin] = impl_->compute(points[i], source, sampler.split(round, i));
    });
    if (stop.stop_requested()) break;
    impl_->insert(std::move(fresh));
    candidates = without(candidates, picked);
    open = impl_->misses(points, without(open, picked));
    if (open.empty()) open = impl_->misses(points, candidates);
    spacing = std::max(0.5f * spacing, minimum_step_spacing);
  }
  return impl_->records.size() - count_before;
}

bool IrradianceCache::interpolate(const CachePoint& at, Spectrum& irradiance, float relax) const {
  return impl_->octree.interpolate(at.point.position, at.normal, relax, irradiance);
}

size_t IrradianceCache::record_count() const { return impl_->records.size(); }
size_t IrradianceCache::size_in_bytes() const {
  return impl_->records.capacity() * sizeof(ComputedRecord) + impl_->clamping.size_in_bytes() +
         impl_->octree.size_in_bytes();
}
uint64_t IrradianceCache::rays_traced() const { return impl_->rays; }
uint64_t IrradianceCache::rays_dropped() const { return impl_->dropped; }

}  // namespace kaustik
