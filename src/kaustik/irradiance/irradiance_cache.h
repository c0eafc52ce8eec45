#pragma once
#include <cstdint>
#include <memory>
#include <stop_token>
#include <vector>

#include "kaustik/base/sampler.h"
#include "kaustik/irradiance/cache_record.h"
#include "kaustik/irradiance/hemisphere.h"

namespace kaustik {

/// A place where irradiance is wanted: on one side of a surface.
struct CachePoint {
  SurfacePoint point;
  Vec3f normal;  ///< unit shading normal on the side that receives the light
  /// Size of a pixel's footprint there, m, without what diffuse and glossy events on the way
  /// spread: a record also serves those who see its place sharply. 0: unknown.
  float pixel_width = 0;
  /// How much larger an error than at other points is allowed when the cache is filled; from 1 to
  /// RecordOctree::overlap.
  float tolerance = 1;
  const Medium* medium = nullptr;  ///< that the light arrives through; null: vacuum
};

/// What tells how far records serve.
enum class CacheMetric {
  split_sphere,  ///< the distance of what they see
  hessian        ///< the second derivative of the irradiance; only with gradients
};

struct CacheSettings {
  CacheMetric metric = CacheMetric::hessian;
  float quality = 0.15f;  ///< a > 0: a record serves within a·R; R see record_reach.h
  bool gradients = true;
  bool minimum_distance = false;  ///< split_sphere: R from the minimum instead of the mean
  float minimum_spacing = 3;      ///< pixels: records are valid at least this far …
  float maximum_spacing = 40;     ///< … and at most this far
  bool neighbor_clamping = true;  ///< Křivánek et al. 2006
  HemisphereSettings hemisphere;

  /// Whether distances tell how far records serve: also without gradients, since the second
  /// derivative bounds only the error that gradients leave.
  bool by_distance() const { return metric == CacheMetric::split_sphere || !gradients; }
};

/// Cached irradiance with gradients (Ward, Rubinstein and Clear 1988; Ward and Heckbert 1992;
/// Schwarzhaupt, Jensen and Jarosz 2012) over any source of radiance. Filled in rounds, each in
/// steps, then read-only: all queries of a step see the records of the steps before, and new ones
/// are inserted in the order of the points, so the cache has the same bits for any number of
/// threads.
class IrradianceCache {
 public:
  /// Throws std::invalid_argument unless quality > 0 and 0 ≤ minimum ≤ maximum spacing.
  explicit IrradianceCache(const CacheSettings& settings);
  ~IrradianceCache();
  IrradianceCache(IrradianceCache&&) noexcept;
  IrradianceCache& operator=(IrradianceCache&&) noexcept;

  /// One round: serves all points that the records so far don't serve, in steps from coarse to
  /// fine; each step computes records in parallel at points that keep their distance from one
  /// another (sampler of point i: Split::cache_record of the round), inserts them in order, and
  /// asks again for the rest. Points that are not finite are passed over. Returns how many records
  /// were inserted. After a stop request only finished steps are in the cache. Not to be called
  /// while others interpolate.
  size_t fill_round(const std::vector<CachePoint>& points, const RadianceSource& source,
                    const Sampler& sampler, uint32_t round, std::stop_token stop);

  /// Irradiance W/m² interpolated from the records, no lane negative; false where none serves.
  /// `relax` ≥ 1 widens every record's reach by that factor, for the few points that no round saw
  /// (of records that serve only so, those listed nearby). Thread-safe.
  bool interpolate(const CachePoint& at, Spectrum& irradiance, float relax = 1) const;

  /// Whether a record serves the point as the filling of the cache asks for, with an error that may
  /// be `tolerance` times as large, from 1 to RecordOctree::overlap. Thread-safe.
  bool serves(const CachePoint& at, float tolerance = 1) const;

  size_t record_count() const;
  /// For pictures of the cache.
  const std::vector<CacheRecord>& records() const;
  size_t size_in_bytes() const;
  uint64_t rays_traced() const;
  /// Rays whose radiance was not finite and was left out.
  uint64_t rays_dropped() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kaustik
