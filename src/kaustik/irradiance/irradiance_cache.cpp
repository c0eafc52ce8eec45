#include "kaustik/irradiance/irradiance_cache.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "kaustik/base/parallel.h"
#include "kaustik/irradiance/neighbor_clamping.h"
#include "kaustik/irradiance/record_octree.h"
#include "kaustik/irradiance/record_reach.h"
#include "kaustik/irradiance/spaced_subset.h"

namespace kaustik {
namespace {

constexpr size_t query_block = 1024;
/// To this share of the largest reach the spacing of new records is halved from step to step.
constexpr float minimum_step_spacing = 1.0f / 65536;
/// Where the width of pixels isn't known, the points are taken to be so many of them across.
constexpr float unknown_pixels = 500;

/// A record whose reach was raised to the minimum by up to this factor counts as much as others:
/// they are many, and averaging them keeps their noise from showing as stains. Beyond, it counts by
/// the square of what is missing. With half the factor cache_bench finds more noise.
constexpr float trusted_raise = 4;
/// Not zero, for at some points there are no others.
constexpr float least_confidence = 1e-4f;

/// A record as it was computed. How far it reaches also depends on its neighbours.
struct ComputedRecord {
  Vec3f position;
  Vec3f normal;
  HemisphereEstimate estimate;
  Validity validity;
  float clamped_radius;                ///< m, ≤ the validity's: by the neighbours
  float gradient_radius;               ///< m, another limit, which neighbours don't share
  float minimum_reach, maximum_reach;  ///< m
  float pixel_width;                   ///< m, of the point that it was made for
};

void set_reach(const ComputedRecord& computed, float quality, CacheRecord& record) {
  const float radius = std::min(computed.clamped_radius, computed.gradient_radius);
  const auto within = [&](float reach) {
    return std::clamp(reach, computed.minimum_reach, computed.maximum_reach);
  };
  const float minor = within(quality * radius);
  record.confidence =
      std::clamp(sqr(trusted_raise * quality * radius / minor), least_confidence, 1.0f);
  record.reach = within(quality * radius * computed.validity.aspect);
  record.squeeze = computed.validity.axis * safe_sqrt(1 / sqr(minor) - record.inverse_reach_sq());
}

/// Puts the gradients into the form for extrapolation. A lane's translation gradient is limited to
/// E/R, where R is the radius that the shorter reach stands for: within it the record changes by at
/// most the share a, also where the reach was raised to the minimum.
CacheRecord finished(const ComputedRecord& computed, const CacheSettings& settings) {
  const HemisphereEstimate& estimate = computed.estimate;
  CacheRecord record;
  record.position = computed.position;
  record.normal = computed.normal;
  record.pixel_width = computed.pixel_width;
  record.turning = turning_factor(estimate);
  set_reach(computed, settings.quality, record);
  record.irradiance = estimate.irradiance;
  if (!settings.gradients) return record;
  const float limit_by_irradiance = settings.quality * std::sqrt(record.inverse_minor_sq());
  for (int lane = 0; lane < Spectrum::lane_count; ++lane) {
    const Vec3f& along = estimate.translation_gradient[lane];
    const float limit = std::max(0.0f, estimate.irradiance[lane]) * limit_by_irradiance;
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
  explicit Impl(const CacheSettings& s) : settings(s) {
    settings.hemisphere.hessian = !s.by_distance();
  }

  CacheSettings settings;
  std::vector<ComputedRecord> records;
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
  bool serves(const CachePoint& p, float tolerance) const {
    return octree.serves(p.point.position, p.normal, tolerance, p.pixel_width);
  }

  std::vector<uint32_t> finite_points(const std::vector<CachePoint>& points) const;
  std::vector<uint32_t> misses(const std::vector<CachePoint>& points,
                               const std::vector<uint32_t>& candidates,
                               const std::stop_token& stop) const;
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

/// Those of `candidates` that no record serves. Worth nothing if it was stopped.
std::vector<uint32_t> IrradianceCache::Impl::misses(const std::vector<CachePoint>& points,
                                                    const std::vector<uint32_t>& candidates,
                                                    const std::stop_token& stop) const {
  std::vector<uint8_t> served(candidates.size());
  parallel_blocks(candidates.size(), query_block, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end && !stop.stop_requested(); ++i) {
      const CachePoint& p = points[candidates[i]];
      const float tolerance = std::clamp(p.tolerance, 1.0f, RecordOctree::overlap);
      served[i] = serves(p, tolerance);
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
  record.estimate =
      sample_hemisphere(source, at.point, at.normal, settings.hemisphere, sampler, at.medium);
  record.gradient_radius = infinity;
  if (settings.by_distance()) {
    record.validity.radius = split_sphere_radius(record.estimate, settings.minimum_distance);
    if (settings.gradients) record.gradient_radius = gradient_radius(record.estimate);
  } else {
    const float width = at.pixel_width > 0 ? at.pixel_width : extent / unknown_pixels;
    record.validity = hessian_validity(record.estimate, at.normal, width);
  }
  record.clamped_radius = record.validity.radius;
  record.minimum_reach = minimum_reach(at);
  record.maximum_reach = maximum_reach(at);
  record.pixel_width = at.pixel_width;
  return record;
}

/// New records by all others, old records by the new ones.
void IrradianceCache::Impl::clamp_by_neighbors(size_t first_new) {
  std::vector<NeighborClamping::Site> sites;
  for (const ComputedRecord& r : records)
    sites.push_back({r.position, r.normal, r.validity.radius});
  const NeighborClamping fresh({sites.begin() + std::ptrdiff_t(first_new), sites.end()});
  const NeighborClamping all(std::move(sites));
  parallel_blocks(records.size(), 64, [&](size_t begin, size_t end, size_t) {
    for (size_t i = begin; i < end; ++i) {
      ComputedRecord& r = records[i];
      r.clamped_radius =
          (i < first_new ? fresh : all).clamped(r.position, r.normal, r.clamped_radius);
    }
  });
}

void IrradianceCache::Impl::insert(std::vector<ComputedRecord> fresh) {
  const size_t first_new = records.size();
  for (ComputedRecord& record : fresh) {
    rays += record.estimate.rays;
    dropped += record.estimate.dropped;
    if (!record.estimate.irradiance.is_finite()) continue;  // overflow
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
  std::vector<uint32_t> open = impl_->misses(points, candidates, stop);
  while (!open.empty() && !stop.stop_requested()) {
    const std::vector<uint32_t> picked = impl_->pick(points, open, spacing);
    std::vector<ComputedRecord> fresh(picked.size());
    parallel_blocks(picked.size(), 1, [&](size_t begin, size_t, size_t) {
      if (stop.stop_requested()) return;
      const uint32_t i = picked[begin];
      fresh[begin] =
          impl_->compute(points[i], source, sampler.split(Split::cache_record, i, round));
    });
    if (stop.stop_requested()) break;
    impl_->insert(std::move(fresh));
    candidates = without(candidates, picked);
    open = impl_->misses(points, without(open, picked), stop);
    if (open.empty()) open = impl_->misses(points, candidates, stop);
    spacing = std::max(0.5f * spacing, minimum_step_spacing);
  }
  return impl_->records.size() - count_before;
}

bool IrradianceCache::interpolate(const CachePoint& at, Spectrum& irradiance, float relax) const {
  return impl_->octree.interpolate(at.point.position, at.normal, relax, irradiance, at.pixel_width);
}

bool IrradianceCache::serves(const CachePoint& at, float tolerance) const {
  return impl_->serves(at, tolerance);
}

size_t IrradianceCache::record_count() const { return impl_->records.size(); }
const std::vector<CacheRecord>& IrradianceCache::records() const { return impl_->octree.records(); }
size_t IrradianceCache::size_in_bytes() const {
  return impl_->records.capacity() * sizeof(ComputedRecord) + impl_->octree.size_in_bytes();
}
uint64_t IrradianceCache::rays_traced() const { return impl_->rays; }
uint64_t IrradianceCache::rays_dropped() const { return impl_->dropped; }

}  // namespace kaustik
